// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/diagnosis/design/proposal.hpp"
#include "components/diagnosis/inference/fitter.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::diagnosis {

/// An experiment that went on with every proposal, one recording each, after those of `experiment`
/// (`observed`), of which no samples are left: what is compared are the proposals' samples, each a
/// single sample with as many frames as its window would have. The proposals are made long after
/// the experiment and each other, so that the body has forgotten; what drifts with time is as it
/// was at the end. The camera stands where it stood in the last plain recording, and depth frames
/// show what they showed there of the surface.
ObservedExperiment ObserveProposals(const experiment::Experiment& experiment,
                                    const ObservedExperiment& observed,
                                    const robot::RobotBody& body,
                                    const std::vector<Proposal>& proposals);

/// The proposals as they look from where `fit` is, one simulation of all of them: columns of the
/// faults `of`, the others 0. Recordings have the indices of `planned`; one that the robot did not
/// get through has no rows.
LinearModel PredictProposals(const ObservedExperiment& planned, const robot::RobotBody& body,
                             const HypothesisSet& hypotheses, const Fit& fit,
                             const std::vector<int>& of, const NoiseModel& noise, int threads);

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "components/palpate/compare/force_comparison.hpp"
#include "components/palpate/compare/truth_timeline.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::command {

/// The true forces of an experiment, and what counts as detected.
struct KnownTruth {
  std::map<std::string, TruthTimeline> of_recording;  ///< by name
  ComparisonRules rules;
};

/// How far from a true force an estimate may be to belong to it, of a robot of that size: a tenth.
double SamePlace_m(double body_diagonal_m);

/// Reads EXP.answer.json of `palpate simulate`. The rules follow from robot and truth: an estimate
/// belongs to a true force within a tenth of `body_diagonal_m`; forces of a tenth of the largest or
/// more must be detected, while they are steady. Throws InputError where it cannot be read, or
/// where answer_sha256 of the experiment says that it belongs to another one.
KnownTruth ReadKnownTruth(const std::filesystem::path& answer,
                          const experiment::Experiment& experiment, double body_diagonal_m);

}  // namespace palpate::command

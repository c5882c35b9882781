// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/palpate/compare/truth_timeline.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::command {

/// The demonstration as a node. Throws RunError where DDS refuses.
dds::Participant JoinDomain(int domain_id);

/// A /forces message; t_s is its stamp, s since the epoch.
force_estimation::ForceEstimate ToEstimate(const idl::palpate_msgs::ForceArray& message);

/// A /truth/forces message.
std::vector<TrueContact> ToTruth(const idl::palpate_msgs::ForceArray& message);

/// [3n] nodes, m; nullopt where the state is not usable.
std::optional<Eigen::VectorXd> ToNodes(const idl::palpate_msgs::MeshState& message);

}  // namespace palpate::command

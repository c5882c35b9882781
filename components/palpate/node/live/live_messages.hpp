// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/palpate/compare/truth_timeline.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::command {

/// A node with the built-in topic table; in a secured domain an observer. `remap`: rules as
/// TopicNames takes them. Throws InputError for a rule that is none, RunError where DDS refuses.
dds::Participant JoinDomain(const std::string& node_name, int domain_id,
                            const std::vector<std::string>& remap = {});

/// The status of a word of forces.csv; an unknown word is an invalid input.
Status ParseStatus(std::string_view word, std::string_view reason);

/// A /forces message; t_s is its stamp, s since the epoch.
force_estimation::ForceEstimate ToEstimate(const idl::palpate_msgs::ForceArray& message);

/// A /truth/forces message.
std::vector<TrueContact> ToTruth(const idl::palpate_msgs::ForceArray& message);

/// [3n] nodes, m; nullopt where the state is not usable.
std::optional<Eigen::VectorXd> ToNodes(const idl::palpate_msgs::MeshState& message);

}  // namespace palpate::command

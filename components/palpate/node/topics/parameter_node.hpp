// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "components/palpate/node/topics/graph_options.hpp"
#include "libs/dds/domain_graph.hpp"
#include "libs/dds/parameter_client.hpp"

namespace palpate::command {

/// Of each question; nodes answer between two frames.
inline constexpr auto kParameterPatience = std::chrono::seconds(3);

/// Whether a node answers questions about its parameters.
bool HasParameters(const dds::DomainGraph& graph, const dds::RosNode& node);

/// One node that has parameters.
class ParameterNode {
 public:
  /// Throws RunError where there is no node `name` (with "did you mean"), or it has no parameters.
  ParameterNode(const GraphOptions& options, const std::string& name);

  std::string name() const { return node_.FullName(); }
  const dds::ParameterClient& client() const { return client_; }

  /// Throws RunError with "did you mean" for a name that the node does not have.
  void Require(const std::vector<std::string>& names) const;

 private:
  dds::DomainGraph graph_;
  dds::RosNode node_;
  dds::ParameterClient client_;
};

}  // namespace palpate::command

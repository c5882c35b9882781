// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/parameter_node.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

#include "components/palpate/node/topics/node_verbs.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/service.hpp"

namespace palpate::command {

bool HasParameters(const dds::DomainGraph& graph, const dds::RosNode& node) {
  const std::string topic = dds::RequestTopicOf(node.FullName() + "/list_parameters");
  return std::any_of(node.readers.begin(), node.readers.end(), [&](const dds::Guid& guid) {
    const auto found = graph.endpoints().find(guid);
    return found != graph.endpoints().end() && found->second.dds_topic == topic;
  });
}

ParameterNode::ParameterNode(const GraphOptions& options, const std::string& name)
    : graph_(static_cast<std::uint32_t>(options.domain_id), {}, GraphSecurity()),
      node_(WaitForNode(graph_, GraphNames(options), options, name)),
      client_(graph_.participant(), node_.FullName(), kParameterPatience) {
  if (HasParameters(graph_, node_)) return;
  throw RunError(
      fmt::format("node '{}' has no services for parameters{}", node_.FullName(),
                  GraphSecurity().enabled() ? ": components of a secured domain have none" : ""));
}

void ParameterNode::Require(const std::vector<std::string>& names) const {
  const std::vector<std::string> known = client_.List();
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw RunError(fmt::format("node '{}' has no parameter '{}'{}", node_.FullName(), name,
                               DidYouMean(name, known)));
  }
}

}  // namespace palpate::command

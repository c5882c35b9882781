// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "components/palpate/node/topics/graph_options.hpp"
#include "libs/dds/domain_graph.hpp"

namespace palpate::command {

/// One topic with its endpoints, which belong to the graph.
struct TopicSummary {
  std::string name;             ///< "/forces"; of DDS topics without ROS 2 their DDS name
  std::set<std::string> types;  ///< "palpate_msgs/msg/ForceArray"
  std::vector<const dds::DomainEndpoint*> writers;
  std::vector<const dds::DomainEndpoint*> readers;

  bool IsEmpty() const { return writers.empty() && readers.empty(); }
};

/// Whether ROS 2 shows a topic on demand only: services, its own discovery, names with a leading
/// underscore.
bool IsHiddenTopic(const std::string& dds_topic);

/// All topics of the namespace, by name.
std::map<std::string, TopicSummary> TopicsOf(const dds::DomainGraph& graph, const GraphNames& names,
                                             bool include_hidden);

/// The topic of that name; an empty one where there is none. A DDS topic without ROS 2 is found by
/// its DDS name.
TopicSummary FindTopic(const dds::DomainGraph& graph, const GraphNames& names,
                       const std::string& name);

/// " (did you mean '/forces'?)", or "".
std::string DidYouMeanTopic(const dds::DomainGraph& graph, const GraphNames& names,
                            const std::string& name);

/// "a, b"
std::string TypesText(const TopicSummary& topic);

}  // namespace palpate::command

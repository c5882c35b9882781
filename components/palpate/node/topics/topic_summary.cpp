// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/topic_summary.hpp"

#include "libs/core/text.hpp"
#include "libs/recording/ros_names.hpp"
#include "libs/recording/topic_choice.hpp"

namespace palpate::command {

namespace {

void Add(const dds::DomainEndpoint& endpoint, TopicSummary* topic) {
  topic->types.insert(recording::RosTypeName(endpoint.dds_type));
  (endpoint.is_writer ? topic->writers : topic->readers).push_back(&endpoint);
}

}  // namespace

bool IsHiddenTopic(const std::string& dds_topic) {
  return recording::IsRosInternal(dds_topic) ||
         recording::RosTopicName(dds_topic).find("/_") != std::string::npos;
}

std::map<std::string, TopicSummary> TopicsOf(const dds::DomainGraph& graph, const GraphNames& names,
                                             bool include_hidden) {
  std::map<std::string, TopicSummary> topics;
  for (const auto& [guid, endpoint] : graph.endpoints()) {
    if (!include_hidden && IsHiddenTopic(endpoint.dds_topic)) continue;
    const std::string name = recording::RosTopicName(endpoint.dds_topic);
    if (!names.IsOfNamespace(name)) continue;
    TopicSummary& topic = topics[name];
    topic.name = name;
    Add(endpoint, &topic);
  }
  return topics;
}

TopicSummary FindTopic(const dds::DomainGraph& graph, const GraphNames& names,
                       const std::string& name) {
  TopicSummary topic;
  topic.name = names.Topic(name);
  TopicSummary plain;
  plain.name = name;
  for (const auto& [guid, endpoint] : graph.endpoints()) {
    if (recording::RosTopicName(endpoint.dds_topic) == topic.name) Add(endpoint, &topic);
    if (endpoint.dds_topic == name) Add(endpoint, &plain);
  }
  return topic.IsEmpty() && !plain.IsEmpty() ? plain : topic;
}

std::string DidYouMeanTopic(const dds::DomainGraph& graph, const GraphNames& names,
                            const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [topic, summary] : TopicsOf(graph, names, true)) known.push_back(topic);
  return DidYouMean(name, known);
}

std::string TypesText(const TopicSummary& topic) {
  return Listed({topic.types.begin(), topic.types.end()});
}

}  // namespace palpate::command

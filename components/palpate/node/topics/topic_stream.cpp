// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/topic_stream.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "components/recorder/node/describe_topic.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/endpoint.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::command {

namespace {

using Endpoints = std::vector<const dds::DomainEndpoint*>;

/// Whether the structure of an endpoint's type must be asked for: nothing here knows it.
auto NeedsIdl(const StreamOptions& options) {
  return [&options, names = GraphNames(options)](const dds::DomainEndpoint& endpoint) {
    const bool is_topic = endpoint.dds_topic == options.topic ||
                          recording::RosTopicName(endpoint.dds_topic) == names.Topic(options.topic);
    return options.decodes && options.type.empty() && is_topic &&
           !recorder::FindRos2msg(recording::RosTypeName(endpoint.dds_type));
  };
}

[[noreturn]] void RefuseMissing(const dds::DomainGraph& graph, const GraphNames& names,
                                const TopicSummary& topic) {
  if (topic.IsEmpty()) {
    throw RunError(fmt::format("no topic '{}' in domain {}{}; palpate topic list shows all",
                               topic.name, graph.domain_id(),
                               DidYouMeanTopic(graph, names, topic.name)));
  }
  throw RunError(fmt::format("'{}' has no publisher in domain {}, but {} subscription(s)",
                             topic.name, graph.domain_id(), topic.readers.size()));
}

/// Finds the topic once it has a publisher, and those of its publishers that are there by then.
TopicSummary WaitForPublisher(dds::DomainGraph& graph, const GraphNames& names,
                              const StreamOptions& options) {
  const auto end = SpinEnd(options);
  const auto is_there = [&] { return !FindTopic(graph, names, options.topic).writers.empty(); };
  if (!graph.WatchUntil(is_there, end)) {
    RefuseMissing(graph, names, FindTopic(graph, names, options.topic));
  }
  graph.WatchUntilComplete(end);
  TopicSummary topic = FindTopic(graph, names, options.topic);
  if (topic.writers.empty()) RefuseMissing(graph, names, topic);
  return topic;
}

/// The one type of the publishers.
const dds::DomainEndpoint& TypedWriter(const TopicSummary& topic) {
  for (const dds::DomainEndpoint* writer : topic.writers) {
    if (writer->dds_type != topic.writers.front()->dds_type) {
      throw RunError(fmt::format("'{}' has more than one type: {}", topic.name, TypesText(topic)));
    }
  }
  return *topic.writers.front();
}

/// `asked`, or what all of `writers` have; where they differ, what fits all of them, and a warning.
template <typename Policy>
Policy Choose(const std::string& asked, const std::string& better_name, Policy better, Policy worse,
              const Endpoints& writers, Policy dds::DomainEndpoint::*policy) {
  if (asked != "auto") return asked == better_name ? better : worse;
  const auto count = std::count_if(writers.begin(), writers.end(),
                                   [&](const auto* writer) { return writer->*policy == better; });
  if (count == 0) return worse;
  if (static_cast<std::size_t>(count) == writers.size()) return better;
  fmt::print(stderr,
             "palpate: warning: some, but not all, publishers are {}: reading what fits all\n",
             better_name);
  return worse;
}

recording::Definitions DefinitionsOf(const TopicSummary& topic, const std::string& type,
                                     const Endpoints& writers) {
  if (const auto text = recorder::FindRos2msg(type)) return recording::ParseRos2msg(type, *text);
  std::string reason = "its publisher does not tell its structure";
  for (const dds::DomainEndpoint* writer : writers) {
    if (writer->omg_idl.empty()) continue;
    try {
      recording::Definitions definitions = recording::ParseOmgIdl(writer->omg_idl);
      if (definitions.contains(writer->dds_type)) return definitions;
    } catch (const InputError& error) {
      reason = error.what();
    }
  }
  throw RunError(fmt::format(
      "the type {} of '{}' is unknown: {}, and neither palpate nor an installation of ROS 2 "
      "(AMENT_PREFIX_PATH) has it; palpate topic hz and bw need no type",
      type, topic.name, reason));
}

ReadableTopic Describe(const TopicSummary& topic, const StreamOptions& options) {
  const dds::DomainEndpoint& writer = TypedWriter(topic);
  ReadableTopic readable;
  readable.name = topic.name;
  readable.type = options.type.empty() ? recording::RosTypeName(writer.dds_type) : options.type;
  readable.topic.dds_topic = writer.dds_topic;
  readable.topic.dds_type = writer.dds_type;
  readable.topic.has_key = writer.has_key;
  readable.topic.reliability =
      Choose(options.reliability, "reliable", dds::Reliability::kReliable,
             dds::Reliability::kBestEffort, topic.writers, &dds::DomainEndpoint::reliability);
  readable.topic.durability =
      Choose(options.durability, "transient_local", dds::Durability::kTransientLocal,
             dds::Durability::kVolatile, topic.writers, &dds::DomainEndpoint::durability);
  if (options.decodes) readable.definitions = DefinitionsOf(topic, readable.type, topic.writers);
  return readable;
}

}  // namespace

TopicStream::TopicStream(const StreamOptions& options)
    : options_(options),
      graph_(static_cast<std::uint32_t>(options.domain_id), NeedsIdl(options_), GraphSecurity()) {
  const GraphNames names(options_);
  topic_ = Describe(WaitForPublisher(graph_, names, options_), options_);
}

std::unique_ptr<dds::RawReader> TopicStream::Start(OnMessage on_message) const {
  return std::make_unique<dds::RawReader>(
      graph_.participant(), topic_.topic,
      [on_message = std::move(on_message)](dds::RawMessage message) { on_message(message); });
}

std::string TopicStream::TakeMismatch(const dds::RawReader& reader) {
  if (mismatch_told_ || !reader.has_incompatible_writer()) return {};
  mismatch_told_ = true;
  return fmt::format(
      "a publisher of '{}' offers incompatible QoS ({}): its messages do not come; palpate topic "
      "info -v {} shows it",
      topic_.name, dds::PolicyName(reader.last_incompatible_policy()), topic_.name);
}

}  // namespace palpate::command

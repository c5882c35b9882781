// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/topic_views.hpp"

#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "components/palpate/node/topics/topic_summary.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

struct TopicListOptions : GraphOptions {
  bool types = false;
  bool count = false;
  bool verbose = false;
  bool hidden = false;
};

struct TopicInfoOptions : GraphOptions {
  std::string topic;
  bool verbose = false;
};

/// "2 publishers"
std::string Counted(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void PrintVerboseList(const std::map<std::string, TopicSummary>& topics) {
  for (const bool published : {true, false}) {
    fmt::print("{} topics:\n", published ? "Published" : "Subscribed");
    for (const auto& [name, topic] : topics) {
      const std::size_t count = (published ? topic.writers : topic.readers).size();
      if (count == 0) continue;
      fmt::print(" * {} [{}] {}\n", name, TypesText(topic),
                 Counted(count, published ? "publisher" : "subscriber"));
    }
    fmt::print("\n");
  }
}

Json ListJson(const dds::DomainGraph& graph, const std::map<std::string, TopicSummary>& topics) {
  Json list = Json::array();
  for (const auto& [name, topic] : topics) {
    list.push_back({{"name", name},
                    {"types", topic.types},
                    {"publisher_count", topic.writers.size()},
                    {"subscription_count", topic.readers.size()}});
  }
  return {{"domain", graph.domain_id()}, {"topics", list}};
}

int List(const TopicListOptions& options) {
  const GraphNames names(options);
  dds::DomainGraph graph(static_cast<std::uint32_t>(options.domain_id), {}, GraphSecurity());
  graph.WatchUntilComplete(SpinEnd(options));
  const auto topics = TopicsOf(graph, names, options.hidden);
  if (options.json) {
    fmt::print("{}\n", ListJson(graph, topics).dump());
  } else if (options.count) {
    fmt::print("{}\n", topics.size());
  } else if (options.verbose) {
    PrintVerboseList(topics);
  } else {
    for (const auto& [name, topic] : topics) {
      fmt::print("{}{}\n", name, options.types ? " [" + TypesText(topic) + "]" : "");
    }
  }
  return app::kExitDone;
}

std::string Duration(std::int64_t time_ns) {
  return time_ns == DDS_INFINITY ? "Infinite" : std::to_string(time_ns) + " nanoseconds";
}

/// The QoS of an endpoint in the words of ROS 2.
struct QosWords {
  explicit QosWords(const dds::DomainEndpoint& endpoint)
      : reliability(endpoint.reliability == dds::Reliability::kReliable ? "RELIABLE"
                                                                        : "BEST_EFFORT"),
        history(endpoint.depth == 0 ? "KEEP_ALL" : "KEEP_LAST"),
        durability(endpoint.durability == dds::Durability::kVolatile ? "VOLATILE"
                                                                     : "TRANSIENT_LOCAL"),
        liveliness(endpoint.liveliness_by_hand ? "MANUAL_BY_TOPIC" : "AUTOMATIC") {}

  std::string reliability;
  std::string history;
  std::string durability;
  std::string liveliness;
};

/// A process without nodes of ROS 2 has no name there.
const char* NodeName(const dds::RosNode* node) {
  return node == nullptr ? "_NODE_NAME_UNKNOWN_" : node->name.c_str();
}
const char* NodeNamespace(const dds::RosNode* node) {
  return node == nullptr ? "_NODE_NAMESPACE_UNKNOWN_" : node->node_namespace.c_str();
}

void PrintEndpoint(const dds::DomainGraph& graph, const dds::DomainEndpoint& endpoint,
                   const std::string& type) {
  const dds::RosNode* node = graph.NodeOf(endpoint.guid);
  const QosWords qos(endpoint);
  fmt::print("Node name: {}\nNode namespace: {}\nTopic type: {}\nEndpoint type: {}\nGID: {}\n",
             NodeName(node), NodeNamespace(node), type,
             endpoint.is_writer ? "PUBLISHER" : "SUBSCRIPTION", dds::GuidText(endpoint.guid));
  const auto process = graph.participants().find(endpoint.participant);
  if (node == nullptr && process != graph.participants().end()) {
    fmt::print("Process: {} (pid {}, host {})\n", process->second.process, process->second.pid,
               process->second.host);
  }
  const std::string depth = endpoint.depth == 0 ? "" : fmt::format(" ({})", endpoint.depth);
  fmt::print(
      "QoS profile:\n  Reliability: {}\n  History (Depth): {}{}\n  Durability: {}\n"
      "  Lifespan: {}\n  Deadline: {}\n  Liveliness: {}\n  Liveliness lease duration: {}\n\n",
      qos.reliability, qos.history, depth, qos.durability, Duration(endpoint.lifespan_ns),
      Duration(endpoint.deadline_ns), qos.liveliness, Duration(endpoint.lease_ns));
}

Json DurationJson(std::int64_t time_ns) {
  return time_ns == DDS_INFINITY ? Json(nullptr) : Json(1e-9 * static_cast<double>(time_ns));
}

Json EndpointsJson(const dds::DomainGraph& graph,
                   const std::vector<const dds::DomainEndpoint*>& endpoints) {
  Json list = Json::array();
  for (const dds::DomainEndpoint* endpoint : endpoints) {
    const dds::RosNode* node = graph.NodeOf(endpoint->guid);
    const QosWords qos(*endpoint);
    list.push_back({{"node", node == nullptr ? Json(nullptr) : Json(node->FullName())},
                    {"gid", dds::GuidText(endpoint->guid)},
                    {"qos",
                     {{"reliability", qos.reliability},
                      {"history", qos.history},
                      {"depth", endpoint->depth},
                      {"durability", qos.durability},
                      {"lifespan_s", DurationJson(endpoint->lifespan_ns)},
                      {"deadline_s", DurationJson(endpoint->deadline_ns)},
                      {"liveliness", qos.liveliness},
                      {"liveliness_lease_s", DurationJson(endpoint->lease_ns)}}}});
  }
  return list;
}

void PrintInfo(const dds::DomainGraph& graph, const TopicSummary& topic, bool verbose) {
  const std::string types = TypesText(topic);
  const char* gap = verbose ? "\n" : "";
  fmt::print("Type: {}\n{}Publisher count: {}\n{}", types, gap, topic.writers.size(), gap);
  for (const dds::DomainEndpoint* writer : topic.writers) {
    if (verbose) PrintEndpoint(graph, *writer, types);
  }
  fmt::print("Subscription count: {}\n{}", topic.readers.size(), gap);
  for (const dds::DomainEndpoint* reader : topic.readers) {
    if (verbose) PrintEndpoint(graph, *reader, types);
  }
}

int Info(const TopicInfoOptions& options) {
  const GraphNames names(options);
  dds::DomainGraph graph(static_cast<std::uint32_t>(options.domain_id), {}, GraphSecurity());
  const auto end = SpinEnd(options);
  const auto is_there = [&] { return !FindTopic(graph, names, options.topic).IsEmpty(); };
  graph.WatchUntilComplete(end);
  if (!graph.WatchUntil(is_there, end)) {
    throw RunError(fmt::format("no topic '{}' in domain {}{}", names.Topic(options.topic),
                               options.domain_id,
                               DidYouMeanTopic(graph, names, names.Topic(options.topic))));
  }
  const TopicSummary topic = FindTopic(graph, names, options.topic);
  if (options.json) {
    const Json json = {{"topic", topic.name},
                       {"types", topic.types},
                       {"publisher_count", topic.writers.size()},
                       {"subscription_count", topic.readers.size()},
                       {"publishers", EndpointsJson(graph, topic.writers)},
                       {"subscriptions", EndpointsJson(graph, topic.readers)}};
    fmt::print("{}\n", json.dump());
  } else {
    PrintInfo(graph, topic, options.verbose);
  }
  return app::kExitDone;
}

}  // namespace

app::Verb TopicListVerb() {
  return {"list", "List the topics of a domain",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<TopicListOptions>();
            DeclareGraph(arguments, options.get());
            arguments.Flag("--show-types,-t", &options->types, "Show the types, too");
            arguments.Flag("--count-topics,-c", &options->count, "Print only how many there are");
            arguments.Flag("--verbose,-v", &options->verbose,
                           "List published and subscribed topics with types and counts");
            arguments.Flag("--include-hidden-topics", &options->hidden,
                           "Show services and hidden topics, too");
            return [options] {
              SettleGraph(options.get());
              return List(*options);
            };
          }};
}

app::Verb TopicInfoVerb() {
  return {"info", "Show type, publishers and subscriptions of a topic",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<TopicInfoOptions>();
            arguments.Positional("TOPIC", &options->topic, "Name of the topic, like /forces");
            DeclareGraph(arguments, options.get());
            arguments.Flag("--verbose,-v", &options->verbose,
                           "Show node, identifier and QoS of each endpoint");
            return [options] {
              SettleGraph(options.get());
              return Info(*options);
            };
          }};
}

}  // namespace palpate::command

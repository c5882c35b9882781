// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/node_verbs.hpp"

#include <fmt/core.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;
/// Name and type.
using Interfaces = std::map<std::string, std::string>;

struct NodeListOptions : GraphOptions {
  bool all = false;
  bool count = false;
};

struct NodeInfoOptions : GraphOptions {
  std::string node;
  bool hidden = false;
};

/// What a node offers and uses, as `ros2 node info` groups it.
struct NodeInterfaces {
  Interfaces subscribers;
  Interfaces publishers;
  Interfaces service_servers;
  Interfaces service_clients;
  Interfaces action_servers;
  Interfaces action_clients;
};

bool TakeEnd(std::string* text, std::string_view end) {
  if (!text->ends_with(end)) return false;
  text->resize(text->size() - end.size());
  return true;
}

/// "rcl_interfaces::srv::dds_::GetParameters_Request_" -> "rcl_interfaces/srv/GetParameters".
std::string ServiceType(const std::string& dds_type) {
  std::string type = recording::RosTypeName(dds_type);
  if (!TakeEnd(&type, "_Request")) TakeEnd(&type, "_Response");
  return type;
}

/// Sorts a request's endpoint in: its reader is that of a server.
void AddService(const dds::DomainEndpoint& endpoint, bool hidden, NodeInterfaces* interfaces) {
  constexpr std::string_view kAction = "/_action/send_goal";
  std::string name = endpoint.dds_topic.substr(2);
  if (!TakeEnd(&name, "Request")) return;
  std::string type = ServiceType(endpoint.dds_type);
  if (TakeEnd(&name, kAction)) {
    TakeEnd(&type, "_SendGoal");
    (endpoint.is_writer ? interfaces->action_clients : interfaces->action_servers)[name] = type;
  } else if (hidden || name.find("/_") == name.npos) {
    (endpoint.is_writer ? interfaces->service_clients : interfaces->service_servers)[name] = type;
  }
}

NodeInterfaces InterfacesOf(const dds::DomainGraph& graph, const dds::RosNode& node, bool hidden) {
  NodeInterfaces interfaces;
  for (const auto* guids : {&node.writers, &node.readers}) {
    for (const dds::Guid& guid : *guids) {
      const auto found = graph.endpoints().find(guid);
      if (found == graph.endpoints().end()) continue;
      const dds::DomainEndpoint& endpoint = found->second;
      if (endpoint.dds_topic.starts_with("rq/")) {
        AddService(endpoint, hidden, &interfaces);
      } else if (!endpoint.dds_topic.starts_with("rr/")) {
        const std::string name = recording::RosTopicName(endpoint.dds_topic);
        if (!hidden && name.find("/_") != name.npos) continue;
        (endpoint.is_writer ? interfaces.publishers : interfaces.subscribers)[name] =
            recording::RosTypeName(endpoint.dds_type);
      }
    }
  }
  return interfaces;
}

std::vector<std::string> NodeNames(const dds::DomainGraph& graph, const GraphNames& names,
                                   bool all) {
  std::vector<std::string> shown;
  for (const dds::RosNode& node : graph.Nodes()) {
    const std::string name = node.FullName();
    if (names.IsOfNamespace(name) && (all || !node.name.starts_with('_'))) shown.push_back(name);
  }
  return shown;
}

/// Those that announce no node of ROS 2.
std::vector<dds::DomainParticipant> PlainParticipants(const dds::DomainGraph& graph) {
  std::set<dds::Guid> with_nodes;
  for (const dds::RosNode& node : graph.Nodes()) with_nodes.insert(node.participant);
  std::vector<dds::DomainParticipant> plain;
  for (const auto& [guid, participant] : graph.participants()) {
    if (!with_nodes.contains(guid)) plain.push_back(participant);
  }
  return plain;
}

Json ListJson(const dds::DomainGraph& graph, const std::vector<std::string>& names) {
  Json participants = Json::array();
  for (const dds::DomainParticipant& participant : PlainParticipants(graph)) {
    participants.push_back({{"gid", dds::GuidText(participant.guid)},
                            {"process", participant.process},
                            {"pid", participant.pid},
                            {"host", participant.host}});
  }
  return {{"domain", graph.domain_id()}, {"nodes", names}, {"other_participants", participants}};
}

int List(const NodeListOptions& options) {
  const GraphNames names(options);
  dds::DomainGraph graph(static_cast<std::uint32_t>(options.domain_id), {}, GraphSecurity());
  graph.WatchUntilComplete(SpinEnd(options));
  const std::vector<std::string> nodes = NodeNames(graph, names, options.all);
  if (options.json) {
    fmt::print("{}\n", ListJson(graph, nodes).dump());
    return app::kExitDone;
  }
  if (options.count) {
    fmt::print("{}\n", nodes.size());
    return app::kExitDone;
  }
  std::map<std::string, int> times;
  for (const std::string& node : nodes) ++times[node];
  for (const std::string& node : nodes) fmt::print("{}\n", node);
  for (const auto& [node, count] : times) {
    if (count == 1) continue;
    fmt::print(stderr, "palpate: warning: {} nodes have the name {}\n", count, node);
  }
  if (!options.all) return app::kExitDone;
  for (const dds::DomainParticipant& participant : PlainParticipants(graph)) {
    fmt::print("(DDS participant) {} (pid {}, host {}) {}\n", participant.process, participant.pid,
               participant.host, dds::GuidText(participant.guid));
  }
  return app::kExitDone;
}

void PrintGroup(const char* title, const Interfaces& interfaces) {
  fmt::print("  {}:\n", title);
  for (const auto& [name, type] : interfaces) fmt::print("    {}: {}\n", name, type);
}

Json GroupJson(const Interfaces& interfaces) {
  Json list = Json::array();
  for (const auto& [name, type] : interfaces) list.push_back({{"name", name}, {"type", type}});
  return list;
}

void PrintInterfaces(const std::string& node, const NodeInterfaces& interfaces) {
  fmt::print("{}\n", node);
  PrintGroup("Subscribers", interfaces.subscribers);
  PrintGroup("Publishers", interfaces.publishers);
  PrintGroup("Service Servers", interfaces.service_servers);
  PrintGroup("Service Clients", interfaces.service_clients);
  PrintGroup("Action Servers", interfaces.action_servers);
  PrintGroup("Action Clients", interfaces.action_clients);
}

Json InterfacesJson(const std::string& node, const dds::DomainParticipant* participant,
                    const NodeInterfaces& interfaces) {
  Json process = nullptr;
  if (participant != nullptr) {
    process = {
        {"name", participant->process}, {"pid", participant->pid}, {"host", participant->host}};
  }
  return {{"node", node},
          {"process", process},
          {"subscribers", GroupJson(interfaces.subscribers)},
          {"publishers", GroupJson(interfaces.publishers)},
          {"service_servers", GroupJson(interfaces.service_servers)},
          {"service_clients", GroupJson(interfaces.service_clients)},
          {"action_servers", GroupJson(interfaces.action_servers)},
          {"action_clients", GroupJson(interfaces.action_clients)}};
}

int Info(const NodeInfoOptions& options) {
  const GraphNames names(options);
  dds::DomainGraph graph(static_cast<std::uint32_t>(options.domain_id), {}, GraphSecurity());
  const dds::RosNode node = WaitForNode(graph, names, options, options.node);
  const NodeInterfaces interfaces = InterfacesOf(graph, node, options.hidden);
  if (!options.json) {
    PrintInterfaces(node.FullName(), interfaces);
    return app::kExitDone;
  }
  const auto participant = graph.participants().find(node.participant);
  fmt::print("{}\n", InterfacesJson(
                         node.FullName(),
                         participant == graph.participants().end() ? nullptr : &participant->second,
                         interfaces)
                         .dump());
  return app::kExitDone;
}

app::Verb NodeListVerb() {
  return {"list", "List the nodes of a domain", [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<NodeListOptions>();
            DeclareGraph(arguments, options.get());
            arguments.Flag("--all,-a", &options->all,
                           "List hidden nodes and DDS participants without nodes, too");
            arguments.Flag("--count-nodes,-c", &options->count, "Print only how many there are");
            return [options] {
              SettleGraph(options.get());
              return List(*options);
            };
          }};
}

app::Verb NodeInfoVerb() {
  return {"info", "Show the topics and services of a node",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<NodeInfoOptions>();
            arguments.Positional("NODE", &options->node, "Name of the node, like /palpate_player");
            DeclareGraph(arguments, options.get());
            arguments.Flag("--include-hidden", &options->hidden, "Show hidden ones, too");
            return [options] {
              SettleGraph(options.get());
              return Info(*options);
            };
          }};
}

}  // namespace

dds::RosNode WaitForNode(dds::DomainGraph& graph, const GraphNames& names,
                         const GraphOptions& options, const std::string& name) {
  const std::string full_name = names.Node(name);
  std::optional<dds::RosNode> found;
  const auto is_there = [&] {
    for (const dds::RosNode& node : graph.Nodes()) {
      if (node.FullName() == full_name) found = node;
    }
    return found.has_value();
  };
  const auto end = SpinEnd(options);
  if (!graph.WatchUntil(is_there, end)) {
    throw RunError(fmt::format("no node '{}' in domain {}{}; palpate node list shows all",
                               full_name, options.domain_id,
                               DidYouMean(full_name, NodeNames(graph, names, true))));
  }
  graph.WatchUntilComplete(end);
  (void)is_there();
  return *found;
}

app::Verb NodeVerb() {
  return {.name = "node",
          .purpose = "List nodes and show what they publish and subscribe, as ros2 node does",
          .verbs = {NodeListVerb(), NodeInfoVerb()}};
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/param_verbs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/palpate/node/topics/graph_options.hpp"
#include "components/palpate/node/topics/parameter_node.hpp"
#include "components/palpate/node/topics/parameter_text.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/domain_graph.hpp"
#include "libs/dds/parameter_client.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

struct ParamOptions : GraphOptions {
  std::string node;
  std::string name;
  std::string value;
  std::vector<std::string> names;
  std::vector<std::string> prefixes;
  bool types = false;
  bool hide_type = false;
};

std::vector<std::string> WithPrefix(std::vector<std::string> names,
                                    const std::vector<std::string>& prefixes) {
  std::erase_if(names, [&](const std::string& name) {
    return !prefixes.empty() &&
           std::none_of(prefixes.begin(), prefixes.end(), [&](const std::string& prefix) {
             return name == prefix || name.starts_with(prefix + ".");
           });
  });
  std::sort(names.begin(), names.end());
  return names;
}

/// Lists the parameters of one node.
Json ListNode(const dds::ParameterClient& client, const ParamOptions& options) {
  const std::vector<std::string> names = WithPrefix(client.List(), options.prefixes);
  const std::vector<Parameter> described =
      options.types || options.json ? client.Describe(names) : std::vector<Parameter>();
  Json json = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string type =
        i < described.size() ? ParameterTypeName(described[i].value) : "not set";
    if (options.json) {
      json.push_back({{"name", names[i]}, {"type", type}});
    } else {
      fmt::print("  {}{}\n", names[i], options.types ? " (type: " + type + ")" : "");
    }
  }
  return json;
}

int ListAll(const ParamOptions& options) {
  const GraphNames names(options);
  dds::DomainGraph graph(static_cast<std::uint32_t>(options.domain_id), {}, GraphSecurity());
  graph.WatchUntilComplete(SpinEnd(options));
  Json all = Json::object();
  bool all_answered = true;
  for (const dds::RosNode& node : graph.Nodes()) {
    if (!names.IsOfNamespace(node.FullName()) || !HasParameters(graph, node)) continue;
    if (!options.json) fmt::print("{}:\n", node.FullName());
    try {
      const dds::ParameterClient client(graph.participant(), node.FullName(), kParameterPatience);
      all[node.FullName()] = ListNode(client, options);
    } catch (const RunError& error) {
      fmt::print(stderr, "palpate: error: {}\n", error.what());
      all_answered = false;
    }
  }
  if (options.json) fmt::print("{}\n", all.dump());
  return all_answered ? app::kExitDone : app::kExitFailed;
}

int List(const ParamOptions& options) {
  if (options.node.empty()) return ListAll(options);
  const ParameterNode node(options, options.node);
  const Json list = ListNode(node.client(), options);
  if (options.json) fmt::print("{}\n", Json({{node.name(), list}}).dump());
  return app::kExitDone;
}

int Get(const ParamOptions& options) {
  const ParameterNode node(options, options.node);
  node.Require({options.name});
  const ParameterValue value = node.client().Get({options.name}).front();
  if (options.json) {
    const Json json = {{"node", node.name()},
                       {"name", options.name},
                       {"type", ParameterTypeName(value)},
                       {"value", Json::parse(ParameterJson(value))}};
    fmt::print("{}\n", json.dump());
  } else {
    fmt::print("{}\n", ParameterLine(value, options.hide_type));
  }
  return app::kExitDone;
}

int Set(const ParamOptions& options) {
  const ParameterNode node(options, options.node);
  node.Require({options.name});
  const std::vector<Parameter> described = node.client().Describe({options.name});
  const ParameterValue like = described.empty() ? ParameterValue() : described.front().value;
  const std::string refusal = node.client().Set(options.name, ParseParameter(options.value, like));
  if (options.json) {
    const Json json = {{"node", node.name()},
                       {"name", options.name},
                       {"successful", refusal.empty()},
                       {"reason", refusal}};
    fmt::print("{}\n", json.dump());
  } else if (refusal.empty()) {
    fmt::print("Set parameter successful\n");
  } else {
    fmt::print(stderr, "Setting parameter failed: {}\n", refusal);
  }
  return refusal.empty() ? app::kExitDone : app::kExitFailed;
}

Json DescriptionJson(const Parameter& parameter) {
  Json range = nullptr;
  if (parameter.range) range = {parameter.range->first, parameter.range->second};
  return {{"name", parameter.name},
          {"type", ParameterTypeName(parameter.value)},
          {"description", parameter.description},
          {"read_only", !parameter.fixed_because.empty()},
          {"range", range},
          {"constraints", parameter.constraints}};
}

int Describe(const ParamOptions& options) {
  const ParameterNode node(options, options.node);
  node.Require(options.names);
  Json all = Json::array();
  for (const Parameter& parameter : node.client().Describe(options.names)) {
    if (options.json) {
      all.push_back(DescriptionJson(parameter));
    } else {
      fmt::print("{}", ParameterDescription(parameter));
    }
  }
  if (options.json) fmt::print("{}\n", all.dump());
  return app::kExitDone;
}

using Declare = void (*)(app::Arguments&, ParamOptions*);

app::Verb VerbOf(const char* name, const char* purpose, app::Need node, Declare declare,
                 int (*run)(const ParamOptions&)) {
  return {name, purpose, [=](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<ParamOptions>();
            arguments.Positional("NODE", &options->node,
                                 node == app::Need::kRequired
                                     ? "Name of the node, like /palpate_player"
                                     : "Name of the node; without it all",
                                 node);
            declare(arguments, options.get());
            DeclareGraph(arguments, options.get());
            return [options, run] {
              SettleGraph(options.get());
              return run(*options);
            };
          }};
}

}  // namespace

app::Verb ParamVerb() {
  constexpr app::Need kRequired = app::Need::kRequired;
  return {
      .name = "param",
      .purpose = "List, read, change and describe the settings of nodes, as ros2 param does",
      .verbs = {VerbOf(
                    "list", "List the parameters of one node or all", app::Need::kOptional,
                    [](app::Arguments& arguments, ParamOptions* options) {
                      arguments.Repeated("--param-prefixes PREFIX", &options->prefixes,
                                         "List those below this prefix only");
                      arguments.Flag("--param-type", &options->types, "Show the types, too");
                    },
                    List),
                VerbOf(
                    "get", "Print the value of a parameter", kRequired,
                    [](app::Arguments& arguments, ParamOptions* options) {
                      arguments.Positional("PARAMETER", &options->name, "Name of the parameter");
                      arguments.Flag("--hide-type", &options->hide_type, "Print the value alone");
                    },
                    Get),
                VerbOf(
                    "set", "Change a parameter of a running node; exit code 1 where it refuses",
                    kRequired,
                    [](app::Arguments& arguments, ParamOptions* options) {
                      arguments.Positional("PARAMETER", &options->name, "Name of the parameter");
                      arguments.Positional("VALUE", &options->value, "As in a settings file");
                    },
                    Set),
                VerbOf(
                    "describe", "Show type, meaning and range of parameters", kRequired,
                    [](app::Arguments& arguments, ParamOptions* options) {
                      arguments.Positionals("PARAMETER", &options->names, "Names of parameters");
                    },
                    Describe)}};
}

}  // namespace palpate::command

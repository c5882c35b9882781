// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/fail_verb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "components/palpate/node/topics/graph_options.hpp"
#include "components/palpate/node/topics/parameter_node.hpp"
#include "components/palpate/system/system_file_keys.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/commanded_fault.hpp"

namespace palpate::command {

namespace {

struct FailOptions : GraphOptions {
  std::string component;
  std::string kind;
  double delay_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not given
};

/// "force_estimation", "force-estimation" -> "palpate_force_estimation"; other names are nodes.
/// Throws InputError where the name is nearly that of a component.
std::string NodeOfComponent(const std::string& name) {
  std::string component = name;
  std::replace(component.begin(), component.end(), '-', '_');
  if (IndexOf(component, ComponentNames())) return "palpate_" + component;
  const std::string meant = DidYouMean(component, ComponentNames());
  if (meant.empty() || name.starts_with('/')) return name;
  throw InputError(Unknown("component", name, ComponentNames()) +
                   "; a node of another name is written as /" + name);
}

/// The reason of a refusal, or "".
std::string Command(const ParameterNode& node, const FailOptions& options) {
  node.Require({dds::kFaultParameter});
  if (!std::isnan(options.delay_s)) {
    std::string refusal = node.client().Set(dds::kFaultDelayParameter, options.delay_s);
    if (!refusal.empty()) return refusal;
  }
  return node.client().Set(dds::kFaultParameter, options.kind);
}

int Fail(const FailOptions& options) {
  if (!IndexOf(options.kind, dds::FaultWords())) {
    throw InputError(Unknown("fault", options.kind, dds::FaultWords()) + ": take one of " +
                     Listed(dds::FaultWords()));
  }
  if (!std::isnan(options.delay_s) && options.kind != "slow") {
    throw InputError("--delay goes with KIND slow, not " + options.kind);
  }
  const ParameterNode node(options, NodeOfComponent(options.component));
  const std::string refusal = Command(node, options);
  if (options.json) {
    const nlohmann::ordered_json json = {{"node", node.name()},
                                         {"fault", options.kind},
                                         {"successful", refusal.empty()},
                                         {"reason", refusal}};
    fmt::print("{}\n", json.dump());
  } else if (refusal.empty()) {
    fmt::print("{}: fault {}\n", node.name(), options.kind);
  } else {
    fmt::print(stderr, "palpate: error: {}: {}\n", node.name(), refusal);
  }
  return refusal.empty() ? app::kExitDone : app::kExitFailed;
}

}  // namespace

app::Verb FailVerb() {
  return {"fail", "Make the data of a running component faulty, where its settings allow it",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<FailOptions>();
            arguments.Positional("COMPONENT", &options->component,
                                 "Component, like force_estimation, or node, like /left_capture");
            arguments.Positional(
                "KIND", &options->kind,
                "off: nothing is sent; stuck: the same data again and again; slow: later; garbage: "
                "random numbers and pixels; wrong: plausible but not true; none: the fault ends");
            arguments.Suggest("COMPONENT", ComponentNames());
            arguments.Suggest("KIND", dds::FaultWords());
            arguments.Option(
                "--delay S", &options->delay_s,
                "With slow: how much later, s; without it what was set last, else 0.5");
            DeclareGraph(arguments, options.get());
            return [options] {
              SettleGraph(options.get());
              return Fail(*options);
            };
          }};
}

}  // namespace palpate::command

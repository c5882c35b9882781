// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/topics/graph_options.hpp"

#include <algorithm>

#include "libs/app/node_options.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/node_settings.hpp"

namespace palpate::command {

namespace {

constexpr double kLongestSpin_s = 86400.0;

std::string WithSlash(const std::string& name) { return name.starts_with('/') ? name : "/" + name; }

}  // namespace

void DeclareGraph(app::Arguments& arguments, GraphOptions* options) {
  app::DeclareDomain(arguments, &options->domain_id);
  arguments.Repeated("--remap FROM:=TO", &options->remap,
                     "Another name for a topic, or __ns:=/left for all of a namespace");
  arguments.Option("--spin-time S", &options->spin_time_s,
                   "Longest search of the domain, s; it ends earlier when all is found");
  arguments.Flag("--json", &options->json, "Print JSON");
}

void SettleGraph(GraphOptions* options) {
  app::SettleDomain(&options->domain_id);
  if (options->spin_time_s <= 0.0 || options->spin_time_s > kLongestSpin_s) {
    throw InputError("--spin-time must be above 0 s and at most a day, not " +
                     FormatNumber(options->spin_time_s));
  }
}

GraphNames::GraphNames(const GraphOptions& options)
    : table_(dds::LoadTopicTable({}, app::LoadYaml, app::ParseYaml)),
      names_("palpate", "/", options.remap, table_) {}

std::string GraphNames::Topic(const std::string& name) const {
  dds::TopicSettings topic;
  topic.name = WithSlash(name);
  for (const dds::TopicSettings& row : table_.topics()) {
    if (row.name == topic.name) topic.global = row.global;
  }
  return names_.Resolve(topic);
}

std::string GraphNames::Node(const std::string& name) const {
  const std::string absolute = WithSlash(name);
  return IsOfNamespace(absolute) ? absolute : names_.node_namespace() + absolute;
}

bool GraphNames::IsOfNamespace(const std::string& name) const {
  const std::string& space = names_.node_namespace();
  if (space == "/" || name.starts_with(space + "/")) return true;
  return std::any_of(table_.topics().begin(), table_.topics().end(),
                     [&](const dds::TopicSettings& row) { return row.global && row.name == name; });
}

dds::SecuritySettings GraphSecurity(const std::string& identity) {
  return dds::SecurityOf(dds::NodeSettings(), identity);
}

dds::DomainGraph::Clock::time_point SpinEnd(const GraphOptions& options) {
  return dds::DomainGraph::Clock::now() + FromSeconds(options.spin_time_s);
}

}  // namespace palpate::command

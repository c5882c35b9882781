// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "libs/app/arguments.hpp"
#include "libs/dds/access_rights.hpp"
#include "libs/dds/domain_graph.hpp"
#include "libs/dds/security_qos.hpp"
#include "libs/dds/topic_names.hpp"

namespace palpate::command {

/// What all verbs have that look at a domain.
struct GraphOptions {
  int domain_id = 0;
  std::vector<std::string> remap;
  double spin_time_s = 1.0;
  bool json = false;
};

/// Declares --domain, --remap, --spin-time and --json.
void DeclareGraph(app::Arguments& arguments, GraphOptions* options);

/// After parsing. Throws InputError.
void SettleGraph(GraphOptions* options);

/// Names of topics and nodes as the processes of a namespace use them.
class GraphNames {
 public:
  /// Throws InputError for a rule that is none.
  explicit GraphNames(const GraphOptions& options);

  /// "forces" and "/forces" -> "/left/forces" with __ns:=/left.
  std::string Topic(const std::string& name) const;
  std::string Node(const std::string& name) const;
  /// Whether a topic or node is one of the namespace; all are without one.
  bool IsOfNamespace(const std::string& name) const;

 private:
  dds::TopicTable table_;
  dds::TopicNames names_;
};

/// As which the verbs join a domain that is secured (dds::SecurityOf).
dds::SecuritySettings GraphSecurity(const std::string& identity = dds::kObserver);

/// The latest time to which the options let a search go.
dds::DomainGraph::Clock::time_point SpinEnd(const GraphOptions& options);

}  // namespace palpate::command

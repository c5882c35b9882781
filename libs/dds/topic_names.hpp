// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "libs/dds/topic_table.hpp"

namespace palpate::dds {

/// Name and namespace of a node and the names of its topics, as ROS 2 resolves them: a topic that
/// is not `global` is below the namespace, then the first rule for it holds.
class TopicNames {
 public:
  /// Rules are those of `ros2 run ... --remap`: "/a:=/b", "__node:=NAME", "__ns:=/NAMESPACE". The
  /// left side is a topic of `table`, with or without the namespace; "NODE:" before a rule limits
  /// it to one node. A right side without a leading '/' is below the namespace. Throws InputError
  /// for a rule that is none, a topic that the table lacks (with "did you mean"), a name that is
  /// none.
  TopicNames(const std::string& node_name, const std::string& node_namespace,
             const std::vector<std::string>& rules, const TopicTable& table);

  const std::string& node_name() const { return node_name_; }
  const std::string& node_namespace() const { return node_namespace_; }  ///< "/", "/left"

  /// The name under which the node uses `topic`. `name` replaces "<name>" in the topic's name and
  /// is empty where there is none.
  std::string Resolve(const TopicSettings& topic, const std::string& name = {}) const;

 private:
  struct Rule {
    std::string from;
    std::string to;
  };

  std::string BelowNamespace(const std::string& ros_name) const;
  /// Takes "__node" and "__ns"; keeps the others in rules_.
  void Take(const std::string& rule);
  void Check(const Rule& rule, const TopicTable& table) const;

  std::string node_name_;
  std::string node_namespace_;
  std::vector<Rule> rules_;
};

}  // namespace palpate::dds

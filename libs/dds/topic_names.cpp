// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/topic_names.hpp"

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/ros_names.hpp"

namespace palpate::dds {

namespace {

constexpr std::string_view kPlaceholder = "<name>";
constexpr std::string_view kAssign = ":=";

[[noreturn]] void RefuseRule(const std::string& rule, const std::string& reason) {
  throw InputError("remapping '" + rule + "': " + reason);
}

std::string CheckedNamespace(std::string name) {
  if (!name.starts_with('/')) name.insert(name.begin(), '/');
  if (name != "/" && !IsRosTopicName(name)) {
    throw InputError("'" + name + "' is no ROS namespace (like /left/robot: letters, digits, _)");
  }
  return name;
}

std::string CheckedNodeName(const std::string& name) {
  if (name.find('/') == name.npos && IsRosTopicName("/" + name)) return name;
  throw InputError("'" + name + "' is no name of a ROS node (letters, digits, _)");
}

/// Whether `name` is that of the row, "<name>" standing for any part.
bool IsOfRow(const std::string& row, const std::string& name) {
  const std::size_t at = row.find(kPlaceholder);
  if (at == row.npos) return name == row;
  const std::string before = row.substr(0, at);
  const std::string after = row.substr(at + kPlaceholder.size());
  return name.size() > before.size() + after.size() && name.starts_with(before) &&
         name.ends_with(after);
}

std::string Filled(const std::string& row, const std::string& name) {
  const std::size_t at = row.find(kPlaceholder);
  PALPATE_CHECK((at == row.npos) == name.empty(), row, name);
  std::string filled = row;
  return at == row.npos ? filled : filled.replace(at, kPlaceholder.size(), name);
}

}  // namespace

TopicNames::TopicNames(const std::string& node_name, const std::string& node_namespace,
                       const std::vector<std::string>& rules, const TopicTable& table)
    : node_name_(CheckedNodeName(node_name)), node_namespace_(CheckedNamespace(node_namespace)) {
  for (const std::string& rule : rules) Take(rule);
  for (const Rule& rule : rules_) Check(rule, table);
}

void TopicNames::Take(const std::string& rule) {
  const std::size_t assign = rule.find(kAssign);
  if (assign == rule.npos || assign == 0 || assign + kAssign.size() == rule.size()) {
    RefuseRule(rule, "must be written as FROM:=TO");
  }
  std::string from = rule.substr(0, assign);
  const std::string to = rule.substr(assign + kAssign.size());
  if (const std::size_t colon = from.find(':'); colon != from.npos) {
    if (from.substr(0, colon) != node_name_) return;
    from = from.substr(colon + 1);
  }
  if (from == "__node" || from == "__name") {
    node_name_ = CheckedNodeName(to);
  } else if (from == "__ns") {
    node_namespace_ = CheckedNamespace(to);
  } else {
    rules_.push_back({from, to});
  }
}

void TopicNames::Check(const Rule& rule, const TopicTable& table) const {
  const std::string text = rule.from + std::string(kAssign) + rule.to;
  if (!IsRosTopicName(BelowNamespace(rule.to))) {
    RefuseRule(text, "'" + rule.to + "' is no ROS topic name (like /left/forces)");
  }
  std::vector<std::string> names;
  for (const TopicSettings& topic : table.topics()) {
    if (IsOfRow(topic.name, rule.from) || IsOfRow(topic.name, "/" + rule.from) ||
        IsOfRow(BelowNamespace(topic.name.substr(1)), rule.from)) {
      return;
    }
    names.push_back(topic.name);
  }
  RefuseRule(text,
             "topic '" + rule.from + "' is not in the topic table" + DidYouMean(rule.from, names));
}

std::string TopicNames::BelowNamespace(const std::string& ros_name) const {
  if (ros_name.starts_with('/')) return ros_name;
  return (node_namespace_ == "/" ? "" : node_namespace_) + "/" + ros_name;
}

std::string TopicNames::Resolve(const TopicSettings& topic, const std::string& name) const {
  const std::string filled = Filled(topic.name, name);
  const std::string resolved = topic.global ? filled : BelowNamespace(filled.substr(1));
  for (const Rule& rule : rules_) {
    const std::string from = rule.from.starts_with('/') ? rule.from : "/" + rule.from;
    if (from == filled || from == resolved) return BelowNamespace(rule.to);
  }
  return resolved;
}

}  // namespace palpate::dds

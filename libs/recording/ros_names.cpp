// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/ros_names.hpp"

namespace palpate::recording {

namespace {

bool IsReplaced(std::string* text, std::string_view from, std::string_view to) {
  const std::size_t at = text->find(from);
  if (at == text->npos) return false;
  text->replace(at, from.size(), to);
  return true;
}

}  // namespace

std::string RosTopicName(std::string_view dds_topic) {
  return std::string(dds_topic.starts_with("rt/") ? dds_topic.substr(2) : dds_topic);
}

std::string RosTypeName(std::string_view dds_type) {
  std::string name(dds_type);
  if (!name.ends_with('_') || !IsReplaced(&name, "::dds_::", "::")) return name;
  name.pop_back();
  while (IsReplaced(&name, "::", "/")) {
  }
  return name;
}

}  // namespace palpate::recording

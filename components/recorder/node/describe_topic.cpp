// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/describe_topic.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::recorder {

namespace {

namespace fs = std::filesystem;

/// The .msg file of a type in the ROS 2 installations of the environment; empty: none.
fs::path MsgFile(const std::string& name) {
  const char* prefixes = std::getenv("AMENT_PREFIX_PATH");
  std::istringstream list(prefixes == nullptr ? "" : prefixes);
  const std::size_t slash = name.find('/');
  std::string prefix;
  while (slash != name.npos && std::getline(list, prefix, ':')) {
    const fs::path file = fs::path(prefix) / "share" / name.substr(0, slash) / "msg" /
                          (name.substr(slash + 1) + ".msg");
    std::error_code error;
    if (fs::is_regular_file(file, error)) return file;
  }
  return {};
}

/// Adds a type and those that it uses; false where one of them is nowhere.
bool AddInstalled(const std::string& name, recording::Definitions* definitions) {
  if (definitions->contains(name)) return true;
  const fs::path file = MsgFile(name);
  if (file.empty()) return false;
  recording::Definitions parsed = recording::ParseRos2msg(name, ReadFile(file));
  const recording::MessageDefinition definition = parsed[name];
  (*definitions)[name] = definition;
  for (const recording::Field& field : definition.fields) {
    if (field.type.find('/') != field.type.npos && !AddInstalled(field.type, definitions)) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::string QosYaml(const dds::Publication& publication) {
  constexpr std::string_view kForever = "\n    sec: 9223372036\n    nsec: 854775807";
  const bool keeps_all = publication.depth == 0;
  return fmt::format(
      "- history: {}\n  depth: {}\n  reliability: {}\n  durability: {}\n  deadline:{}\n"
      "  lifespan:{}\n  liveliness: 1\n  liveliness_lease_duration:{}\n"
      "  avoid_ros_namespace_conventions: {}",
      keeps_all ? 2 : 1, publication.depth,
      publication.reliability == dds::Reliability::kReliable ? 1 : 2,
      publication.durability == dds::Durability::kTransientLocal ? 1 : 2, kForever, kForever,
      kForever, !publication.dds_topic.starts_with("rt/"));
}

std::optional<std::string> FindRos2msg(const std::string& ros_type) {
  const recording::Definitions& built_in = recording::BuiltInDefinitions();
  if (const auto text = recording::FormatRos2msg(ros_type, built_in)) return text;
  try {
    recording::Definitions definitions = built_in;
    if (!AddInstalled(recording::ShortTypeName(ros_type), &definitions)) return std::nullopt;
    return recording::FormatRos2msg(ros_type, definitions);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

TopicDescription Describe(const dds::Publication& publication) {
  TopicDescription topic;
  topic.topic = recording::RosTopicName(publication.dds_topic);
  topic.type = recording::RosTypeName(publication.dds_type);
  topic.qos = QosYaml(publication);
  topic.has_key = publication.has_key;
  topic.latched = publication.durability == dds::Durability::kTransientLocal;
  if (std::optional<std::string> text = FindRos2msg(topic.type)) {
    topic.schema_encoding = "ros2msg";
    topic.schema = std::move(*text);
  } else if (!publication.omg_idl.empty()) {
    topic.type = publication.dds_type;  // as the IDL names it
    topic.schema_encoding = "omgidl";
    topic.schema = publication.omg_idl;
  }
  return topic;
}

}  // namespace palpate::recorder

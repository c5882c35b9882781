// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/topic_table.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "libs/core/config_reader.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/dds/ros_names.hpp"

namespace palpate::dds {

namespace {

constexpr int kMaxDepth = 10000;

std::string WithoutPlaceholder(std::string name) {
  const size_t at = name.find("<name>");
  return at == name.npos ? name : name.replace(at, 6, "name");
}

std::string ReadName(const ConfigNode& node) {
  const std::string name = ReadText(node);
  if (!IsRosTopicName(WithoutPlaceholder(name))) {
    Refuse(node, "'" + name + "' is no ROS topic name (like /robot/mesh_state)");
  }
  return name;
}

std::string ReadType(const ConfigNode& node) {
  const std::string type = ReadText(node);
  try {
    DdsTypeName(type);
  } catch (const InputError& error) {
    Refuse(node, error.what());
  }
  return type;
}

std::optional<double> OptionalPositive(MapReader& map, const std::string& key) {
  const ConfigNode* node = map.Optional(key);
  return node ? std::optional<double>(ReadNumber(*node, kPositive)) : std::nullopt;
}

std::vector<std::string> OptionalNames(MapReader& map, const std::string& key) {
  const ConfigNode* list = map.Optional(key);
  if (list == nullptr) return {};
  if (list->kind != ConfigNode::Kind::kList) Refuse(*list, "must be a list of components");
  std::vector<std::string> names;
  for (const ConfigNode& item : list->items) names.push_back(ReadText(item));
  return names;
}

TopicSettings ReadTopic(const ConfigNode& node) {
  MapReader map(node);
  TopicSettings topic;
  topic.name = ReadName(map.Require("name"));
  topic.type = ReadType(map.Require("type"));
  topic.reliability =
      ReadChoice(map.Require("reliability"), {"reliable", "best_effort"}) == "reliable"
          ? Reliability::kReliable
          : Reliability::kBestEffort;
  topic.durability =
      ReadChoice(map.Require("durability"), {"volatile", "transient_local"}) == "transient_local"
          ? Durability::kTransientLocal
          : Durability::kVolatile;
  topic.depth = ReadInteger(map.Require("depth"), 1, kMaxDepth);
  topic.rate_hz = OptionalPositive(map, "rate_hz");
  topic.deadline_s = OptionalPositive(map, "deadline_s");
  topic.recorded = ReadBool(map.Require("recorded"));
  if (const ConfigNode* global = map.Optional("global")) topic.global = ReadBool(*global);
  topic.writers = OptionalNames(map, "writers");
  topic.readers = OptionalNames(map, "readers");
  map.Finish();
  return topic;
}

/// Sets a mark in the rows that a list of names holds.
void ReadMarks(const ConfigNode* list, bool TopicSettings::*mark,
               std::vector<TopicSettings>* topics) {
  if (list == nullptr) return;
  if (list->kind != ConfigNode::Kind::kList) Refuse(*list, "must be a list of names of topics");
  for (const ConfigNode& item : list->items) {
    const std::string name = ReadText(item);
    std::vector<std::string> names;
    bool found = false;
    for (TopicSettings& topic : *topics) {
      names.push_back(topic.name);
      if (topic.name != name) continue;
      topic.*mark = true;
      found = true;
    }
    if (!found) Refuse(item, "topic '" + name + "' is not in the table" + DidYouMean(name, names));
  }
}

}  // namespace

TopicTable::TopicTable(std::vector<TopicSettings> topics) : topics_(std::move(topics)) {
  std::set<std::string> names;
  for (const TopicSettings& topic : topics_) {
    if (!names.insert(topic.name).second) {
      throw InputError("topic '" + topic.name + "' is given twice in the topic table");
    }
  }
}

const TopicSettings& TopicTable::At(std::string_view name) const {
  const auto found = std::find_if(topics_.begin(), topics_.end(),
                                  [&](const TopicSettings& topic) { return topic.name == name; });
  if (found != topics_.end()) return *found;
  std::vector<std::string> names;
  for (const TopicSettings& topic : topics_) names.push_back(topic.name);
  throw InputError("topic '" + std::string(name) + "' is not in the topic table" +
                   DidYouMean(name, names));
}

TopicTable ReadTopicTable(const ConfigNode& node) {
  MapReader map(node);
  const ConfigNode& list = map.Require("topics");
  const ConfigNode* sole_writer = map.Optional("sole_writer");
  const ConfigNode* raw = map.Optional("raw");
  map.Finish();
  if (list.kind != ConfigNode::Kind::kList) Refuse(list, "must be a list of topics");
  std::vector<TopicSettings> topics;
  for (const ConfigNode& item : list.items) topics.push_back(ReadTopic(item));
  ReadMarks(sole_writer, &TopicSettings::sole_writer, &topics);
  ReadMarks(raw, &TopicSettings::raw, &topics);
  return TopicTable(std::move(topics));
}

}  // namespace palpate::dds

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/topic_roles.hpp"

#include <algorithm>

#include "components/offline/messages/ros_image.hpp"
#include "libs/core/error.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/ros_names.hpp"

namespace palpate::offline {

namespace {

/// A topic with all its channels. Packed variants of an image have the name of the image.
struct FoundTopic {
  std::string name;
  std::string base;  ///< without /compressed and /compressedDepth
  std::string role;  ///< what --remap calls it; else its base
  bool remapped = false;
  std::string type;
  ChannelSet channels;
  std::string what;  ///< of images: "16UC1, 848 x 480"
  bool depth = false;
  bool color = false;
  int rank = 0;  ///< of the variants of an image: a raw one comes first
};

struct RoleRule {
  const char* name;
  std::vector<std::string> types;
  bool (*fits)(const FoundTopic&);
  bool by_type;  ///< whether another name may stand for it
};

bool Any(const FoundTopic&) { return true; }
bool IsNoEstimate(const FoundTopic& topic) {
  return topic.base.find("/forces/") == std::string::npos;
}
bool IsNoCommand(const FoundTopic& topic) { return !topic.base.ends_with("command"); }
bool IsNoResult(const FoundTopic& topic) {
  return topic.base.find("/perception/") == std::string::npos;
}
bool IsDepthTopic(const FoundTopic& topic) { return topic.depth; }
bool IsColorTopic(const FoundTopic& topic) { return topic.color; }

const std::vector<RoleRule>& RoleRules() {
  static const std::vector<RoleRule> rules = {
      {kDepthTopic, {kImageType, kCompressedImageType}, IsDepthTopic, true},
      {kColorTopic, {kImageType, kCompressedImageType}, IsColorTopic, true},
      {kDepthInfoTopic, {"sensor_msgs/msg/CameraInfo"}, Any, false},
      {kColorInfoTopic, {"sensor_msgs/msg/CameraInfo"}, Any, false},
      {kCameraSetupTopic, {"palpate_msgs/msg/CameraSetup"}, Any, true},
      {kFrameInfoTopic, {"palpate_msgs/msg/FrameInfo"}, Any, true},
      {kPointsTopic, {"sensor_msgs/msg/PointCloud2"}, IsNoResult, true},
      {kMarkersTopic, {"palpate_msgs/msg/MarkerArray3"}, Any, true},
      {kJointStatesTopic, {"sensor_msgs/msg/JointState"}, IsNoCommand, true},
      {kLoadTopic, {"geometry_msgs/msg/WrenchStamped"}, IsNoEstimate, true},
      {kPhaseTopic, {"std_msgs/msg/String"}, Any, false},
      {kCalibrationTopic, {"palpate_msgs/msg/Calibration"}, Any, true}};
  return rules;
}

std::string BaseOf(const std::string& topic) {
  for (const char* suffix : {"/compressedDepth", "/compressed"}) {
    if (topic.ends_with(suffix)) return topic.substr(0, topic.size() - std::string(suffix).size());
  }
  return topic;
}

bool IsImageType(const std::string& type) {
  return type == kImageType || type == kCompressedImageType;
}

/// Looks at the first image of each topic that is whole.
void LookAtImages(const recording::RecordedMessages& recorded, std::vector<FoundTopic>* topics) {
  std::map<std::uint16_t, FoundTopic*> wanted;
  for (FoundTopic& topic : *topics) {
    if (!IsImageType(topic.type)) continue;
    for (const std::uint16_t channel : topic.channels) wanted[channel] = &topic;
  }
  recording::MessageFilter filter;
  filter.wanted = [&](const recording::Channel& channel) { return wanted.contains(channel.id); };
  recording::RecordedStream stream = recorded.Messages(filter);
  while (!wanted.empty()) {
    const recording::Message* message = stream.Next();
    if (message == nullptr) return;
    const auto found = wanted.find(message->channel_id);
    if (found == wanted.end()) continue;
    const auto type = TypeOf(recorded.SchemaOf(recorded.contents().channels.at(found->first)));
    RosImage image;
    if (!type || !ReadImage(message->data, *type, &image).empty()) continue;
    if (!image.compressed() && image.height == 0) continue;
    FoundTopic& topic = *found->second;
    topic.depth = image.IsDepth();
    topic.color = image.IsColor();
    topic.rank = image.compressed() ? (topic.name.ends_with("/compressedDepth") ? 1 : 2) : 0;
    topic.what = image.compressed() ? image.format
                                    : image.encoding + ", " + std::to_string(image.width) + " x " +
                                          std::to_string(image.height);
    wanted.erase(found);
  }
}

std::vector<FoundTopic> ListTopics(const recording::RecordedMessages& recorded) {
  std::map<std::pair<std::string, std::string>, FoundTopic> topics;
  const auto& counts = recorded.contents().statistics.channel_message_counts;
  for (const auto& [id, channel] : recorded.contents().channels) {
    const auto count = counts.find(id);
    if (count == counts.end() || count->second == 0) continue;
    const std::string name = recording::RosTopicName(channel.topic);
    const std::string type = recording::RosTypeName(recorded.SchemaOf(channel).name);
    FoundTopic& topic = topics[{name, type}];
    topic.name = name;
    topic.base = topic.role = IsImageType(type) ? BaseOf(name) : name;
    topic.type = type;
    topic.channels.insert(id);
  }
  std::vector<FoundTopic> list;
  for (auto& [key, topic] : topics) list.push_back(std::move(topic));
  LookAtImages(recorded, &list);
  return list;
}

void Remap(const std::vector<std::string>& rules, std::vector<FoundTopic>* topics) {
  std::vector<std::string> names;
  std::vector<std::string> roles;
  for (const FoundTopic& topic : *topics) {
    names.push_back(topic.name);
    names.push_back(topic.base);
  }
  for (const RoleRule& rule : RoleRules()) roles.push_back(rule.name);
  for (const std::string& rule : rules) {
    const std::size_t middle = rule.find(":=");
    if (middle == std::string::npos || middle == 0 || middle + 2 == rule.size()) {
      throw InputError("--remap " + rule +
                       ": must be FROM:=TO, for instance /depth/image:=" + kDepthTopic);
    }
    const std::string from = recording::RosTopicName(rule.substr(0, middle));
    const std::string to = rule.substr(middle + 2);
    if (!IndexOf(from, names)) {
      throw InputError("--remap " + rule +
                       ": the recording has no such topic: " + Unknown("topic", from, names));
    }
    const std::string near = IndexOf(to, roles) ? "" : DidYouMean(to, roles);
    if (!near.empty()) throw InputError("--remap " + rule + ": unknown topic '" + to + "'" + near);
    for (FoundTopic& topic : *topics) {
      if (topic.name != from && topic.base != from) continue;
      topic.role = to;
      topic.remapped = true;
    }
  }
}

/// Of the packed variants of one image the best alone.
void KeepBestVariants(std::vector<const FoundTopic*>* found) {
  std::stable_sort(found->begin(), found->end(), [](const FoundTopic* a, const FoundTopic* b) {
    return std::pair(a->base, a->rank) < std::pair(b->base, b->rank);
  });
  const auto same = [](const FoundTopic* a, const FoundTopic* b) {
    return a->base == b->base && IsImageType(a->type) && IsImageType(b->type);
  };
  found->erase(std::unique(found->begin(), found->end(), same), found->end());
}

[[noreturn]] void RefuseAmbiguous(const RoleRule& rule,
                                  const std::vector<const FoundTopic*>& found) {
  std::string names;
  for (const FoundTopic* topic : found) {
    names += (names.empty() ? "" : ", ") + topic->name;
    if (!topic->what.empty()) names += " (" + topic->what + ")";
  }
  throw InputError("more than one topic could be " + std::string(rule.name) + ": " + names +
                   "; name one with --remap " + found.front()->base + ":=" + rule.name +
                   ", or leave one out with --remap " + found.back()->base + ":=/unused");
}

const FoundTopic* Choose(const RoleRule& rule, const std::vector<FoundTopic>& topics) {
  std::vector<const FoundTopic*> exact;
  std::vector<const FoundTopic*> ends_so;
  std::vector<const FoundTopic*> fits;
  for (const FoundTopic& topic : topics) {
    if (!IndexOf(topic.type, rule.types)) continue;
    if (topic.role == rule.name) exact.push_back(&topic);
    if (topic.remapped) continue;
    if (topic.role.ends_with(rule.name)) ends_so.push_back(&topic);
    if (rule.by_type && rule.fits(topic)) fits.push_back(&topic);
  }
  const bool renamed = std::any_of(exact.begin(), exact.end(),
                                   [](const FoundTopic* topic) { return topic->remapped; });
  if (renamed) std::erase_if(exact, [](const FoundTopic* topic) { return !topic->remapped; });
  for (std::vector<const FoundTopic*>* found : {&exact, &ends_so, &fits}) {
    KeepBestVariants(found);
    if (found->size() == 1) return found->front();
    if (found->size() > 1) RefuseAmbiguous(rule, *found);
  }
  return nullptr;
}

}  // namespace

TopicRoles FindTopics(const recording::RecordedMessages& recorded,
                      const std::vector<std::string>& remap) {
  std::vector<FoundTopic> topics = ListTopics(recorded);
  Remap(remap, &topics);
  TopicRoles roles;
  for (const FoundTopic& topic : topics) {
    roles.listed.push_back(topic.name + " (" + topic.type +
                           (topic.what.empty() ? "" : ", " + topic.what) + ")");
    if (topic.remapped) roles.remapped[topic.base] = topic.role;
    const bool tf = topic.role.ends_with("/tf") || topic.role.ends_with("/tf_static");
    if (tf && topic.type == "tf2_msgs/msg/TFMessage") {
      roles.transforms.insert(topic.channels.begin(), topic.channels.end());
    }
  }
  for (const RoleRule& rule : RoleRules()) {
    // Depth images win: a driver's cloud is made of them.
    if (rule.name == std::string(kPointsTopic) && roles.Has(kDepthTopic)) continue;
    const FoundTopic* topic = Choose(rule, topics);
    if (topic == nullptr) continue;
    roles.channels[rule.name] = topic->channels;
    roles.names[rule.name] = topic->name;
  }
  return roles;
}

}  // namespace palpate::offline

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/further_cameras.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "components/offline/messages/experiment_clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/recording/ros_names.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::offline {

namespace {

constexpr std::string_view kFirst = "/camera";
constexpr std::array<const char*, 6> kCameraRoles = {
    kDepthTopic, kDepthInfoTopic, kColorTopic, kColorInfoTopic, kCameraSetupTopic, kFrameInfoTopic};

std::set<std::string> NamesOfTopics(const recording::RecordedMessages& recorded) {
  std::set<std::string> names;
  const auto& counts = recorded.contents().statistics.channel_message_counts;
  for (const auto& [id, channel] : recorded.contents().channels) {
    const auto count = counts.find(id);
    if (count == counts.end() || count->second == 0) continue;
    names.insert(recording::RosTopicName(channel.topic));
  }
  return names;
}

/// A topic of the first camera as that of the camera `name`.
std::string TopicOf(const std::string& name, const std::string& role) {
  return std::string(kFirst) + "_" + name + role.substr(kFirst.size());
}

/// Names of cameras whose depth images are there.
std::vector<std::string> CamerasOf(const std::set<std::string>& topics) {
  const std::string begin = std::string(kFirst) + "_";
  const std::string end = std::string(kDepthTopic).substr(kFirst.size());
  std::vector<std::string> cameras;
  for (const std::string& topic : topics) {
    if (!topic.starts_with(begin) || !topic.ends_with(end)) continue;
    if (topic.size() <= begin.size() + end.size()) continue;
    const std::string name = topic.substr(begin.size(), topic.size() - begin.size() - end.size());
    if (experiment::IsCameraName(name)) cameras.push_back(name);
  }
  return cameras;
}

/// The rules of the user that are not of a camera, and those that put this one in the first's
/// place.
std::vector<std::string> RulesFor(const std::string& name, const std::set<std::string>& topics,
                                  const std::vector<std::string>& remap) {
  std::vector<std::string> rules;
  for (const std::string& rule : remap) {
    const std::size_t middle = rule.find(":=");
    const std::string to = middle == rule.npos ? rule : rule.substr(middle + 2);
    const bool is_of_camera =
        std::find(kCameraRoles.begin(), kCameraRoles.end(), to) != kCameraRoles.end();
    if (!is_of_camera) rules.push_back(rule);
  }
  for (const char* role : kCameraRoles) {
    const std::string topic = TopicOf(name, role);
    if (topics.contains(topic)) rules.push_back(topic + ":=" + role);
  }
  return rules;
}

void Shift(std::int64_t by_ns, std::vector<CollectedImage>* images) {
  for (CollectedImage& image : *images) image.time.t_ns += by_ns;
}

FurtherRecordedCamera Read(const recording::RecordedMessages& recorded, const std::string& name,
                           const std::vector<std::string>& rules, const std::string& robot_frame,
                           const ChosenClock& clock) {
  FurtherRecordedCamera camera;
  camera.name = name;
  camera.roles = FindTopics(recorded, rules);
  camera.topics = CollectTopics(recorded, camera.roles);
  std::vector<std::string> unused;  // they are those of the first camera again
  const std::int64_t origin_ns = ChooseClock(&camera.topics, &unused);
  if (camera.topics.depth.empty()) throw InputError("none of its depth images can be read");
  if (ClockOf(camera.topics, origin_ns).is_of_stamps != clock.is_of_stamps) {
    throw InputError("its stamps are of another clock than those of the other topics");
  }
  Shift(origin_ns - clock.origin_ns, &camera.topics.depth);
  Shift(origin_ns - clock.origin_ns, &camera.topics.color);
  const CollectedImage& image = camera.topics.depth.front();
  const auto T_robot_camera =
      camera.topics.transforms.Find(robot_frame, image.frame_id, image.time.log_ns);
  camera.camera = FindCamera(recorded, camera.roles, camera.topics, robot_frame, &unused);
  // The pose that was found is that of the first camera.
  camera.camera.T_robot_camera = T_robot_camera;
  camera.camera.T_robot_camera_error.reset();
  return camera;
}

}  // namespace

ChosenClock ClockOf(const CollectedTopics& topics, std::int64_t origin_ns) {
  if (topics.depth.empty()) return {origin_ns, true};
  const MessageTime& time = topics.depth.front().time;
  return {origin_ns, time.t_ns + origin_ns == time.stamp_ns};
}

std::vector<FurtherRecordedCamera> FindFurtherCameras(const recording::RecordedMessages& recorded,
                                                      const std::vector<std::string>& remap,
                                                      const std::string& robot_frame,
                                                      const ChosenClock& clock,
                                                      std::vector<std::string>* notes) {
  std::vector<FurtherRecordedCamera> cameras;
  const std::set<std::string> topics = NamesOfTopics(recorded);
  for (const std::string& name : CamerasOf(topics)) {
    try {
      cameras.push_back(Read(recorded, name, RulesFor(name, topics, remap), robot_frame, clock));
    } catch (const InputError& error) {
      notes->push_back("camera '" + name + "' is left out: " + error.what());
      continue;
    }
    const FurtherRecordedCamera& camera = cameras.back();
    notes->push_back(
        "camera '" + name + "': " + std::to_string(camera.topics.depth.size()) + " depth images" +
        (camera.camera.T_robot_camera
             ? ", its pose is that of /tf and /tf_static"
             : ", no pose: /tf and /tf_static do not join its frame with '" + robot_frame + "'"));
  }
  return cameras;
}

void WriteFurtherCamera(const recording::RecordedMessages& recorded,
                        const FurtherRecordedCamera& camera, std::vector<Stretch> stretches,
                        std::vector<std::string>* notes) {
  for (Stretch& stretch : stretches) stretch.folder = stretch.folder / "cameras" / camera.name;
  WriteImages(recorded, camera.roles, camera.topics, camera.camera, stretches, notes);
  for (const Stretch& stretch : stretches) {
    if (!std::filesystem::exists(stretch.folder / "depth")) continue;
    WriteFile(stretch.folder / "camera.yaml", rgbd::FormatCameraFile(camera.camera.camera));
  }
}

}  // namespace palpate::offline

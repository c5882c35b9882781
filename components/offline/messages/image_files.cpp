// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/image_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "components/offline/messages/ros_cloud.hpp"
#include "components/offline/messages/ros_image.hpp"
#include "libs/core/error.hpp"
#include "libs/core/statistics.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/recording/ros_names.hpp"
#include "libs/rgbd/png.hpp"

namespace palpate::offline {

namespace {

namespace fs = std::filesystem;

/// A message by what does not change: stamp and log time.
using MessageKey = std::pair<std::int64_t, std::int64_t>;
/// By message: the time that names its file.
using FileTimes = std::map<MessageKey, MessageTime>;

FileTimes NamedByOwnTime(const std::vector<CollectedImage>& images) {
  FileTimes times;
  for (const CollectedImage& image : images) {
    times[{image.time.stamp_ns, image.time.log_ns}] = image.time;
  }
  return times;
}

std::int64_t MedianStep(const std::vector<CollectedImage>& images) {
  std::vector<std::int64_t> steps_ns;
  for (std::size_t i = 1; i < images.size(); ++i) {
    steps_ns.push_back(images[i].time.t_ns - images[i - 1].time.t_ns);
  }
  if (steps_ns.empty()) return 0;
  return UpperMedian(steps_ns);
}

/// Colour images under the time of the depth image that each goes with; none is used twice.
FileTimes PairColor(const CollectedTopics& topics) {
  const std::int64_t most_ns = MedianStep(topics.depth) / 2;
  FileTimes times;
  auto color = topics.color.begin();
  for (const CollectedImage& depth : topics.depth) {
    const auto distance = [&](const CollectedImage& image) {
      return image.time.segment == depth.time.segment
                 ? std::llabs(image.time.t_ns - depth.time.t_ns)
                 : std::numeric_limits<long long>::max();
    };
    while (color != topics.color.end() && color->time.segment < depth.time.segment) ++color;
    while (color != topics.color.end() && color + 1 != topics.color.end() &&
           (color + 1)->time.segment == color->time.segment &&
           distance(*(color + 1)) <= distance(*color)) {
      ++color;
    }
    if (color == topics.color.end()) break;
    if (distance(*color) > most_ns) continue;
    times[{color->time.stamp_ns, color->time.log_ns}] = depth.time;
    ++color;
  }
  return times;
}

class ImageWriter {
 public:
  ImageWriter(const recording::RecordedMessages& recorded, const TopicRoles& roles,
              const CollectedTopics& topics, const RecordedCamera& camera,
              const std::vector<Stretch>& stretches)
      : recorded_(recorded), roles_(roles), camera_(camera), stretches_(stretches) {
    depth_ = NamedByOwnTime(topics.depth);
    points_ = NamedByOwnTime(topics.points);
    if (camera.use_color) color_ = PairColor(topics);
    unpaired_ = camera.use_color ? topics.color.size() - color_.size() : 0;
  }

  void Run(std::vector<std::string>* notes) {
    recording::MessageFilter filter;
    filter.wanted = [this](const recording::Channel& channel) {
      return roles_.Is(kDepthTopic, channel.id) || roles_.Is(kPointsTopic, channel.id) ||
             (camera_.use_color && roles_.Is(kColorTopic, channel.id));
    };
    if (stretches_.empty()) return;
    recording::RecordedStream stream = recorded_.Messages(filter);
    while (const recording::Message* message = stream.Next()) Take(*message);
    if (unpaired_ > 0) {
      notes->push_back(std::to_string(unpaired_) + " colour image(s) without a depth image near");
    }
    for (const auto& [what, count] : left_out_) {
      notes->push_back("left out: " + std::to_string(count) + " message(s) of " + what);
    }
  }

 private:
  /// The file of a message; empty: it is not used.
  fs::path FileOf(const recording::Message& message, const MessageType& type, FileTimes* times,
                  const char* folder, const char* extension) {
    const auto found = times->find({StampOf(message, type), message.log_time_ns});
    if (found == times->end()) return {};
    const std::int64_t t_ns = found->second.t_ns;
    const int segment = found->second.segment;
    times->erase(found);  // a message that is there twice is written once
    for (const Stretch& stretch : stretches_) {
      if (t_ns < stretch.begin_ns || t_ns > stretch.end_ns) continue;
      if (stretch.segment >= 0 && stretch.segment != segment) continue;
      experiment::CreateFolder(stretch.folder / folder);
      return stretch.folder / folder / (std::to_string(t_ns) + extension);
    }
    return {};
  }

  void Take(const recording::Message& message) {
    const std::uint16_t id = message.channel_id;
    const auto& channel = recorded_.contents().channels.at(id);
    auto& type = types_[id];
    if (!type) type = TypeOf(recorded_.SchemaOf(channel));
    if (!type) return;
    std::string cause;
    if (roles_.Is(kDepthTopic, id)) cause = TakeDepth(message, *type);
    if (roles_.Is(kColorTopic, id)) cause = TakeColor(message, *type);
    if (roles_.Is(kPointsTopic, id)) cause = TakePoints(message, *type);
    if (!cause.empty()) ++left_out_[recording::RosTopicName(channel.topic) + ": " + cause];
  }

  void CheckSize(const std::string& role, int width_px, int height_px,
                 const rgbd::CameraModel& model) const {
    if (width_px == model.width_px && height_px == model.height_px) return;
    const auto text = [](int width, int height) {
      return std::to_string(width) + " x " + std::to_string(height);
    };
    throw InputError(roles_.names.at(role) + ": images are " + text(width_px, height_px) +
                     " pixels, and its camera_info says " + text(model.width_px, model.height_px) +
                     ": name another camera_info with --remap");
  }

  std::string TakeDepth(const recording::Message& message, const MessageType& type) {
    const fs::path file = FileOf(message, type, &depth_, "depth", ".png");
    if (file.empty()) return {};
    RosImage image;
    RosDepth depth;
    if (std::string cause = ReadImage(message.data, type, &image); !cause.empty()) return cause;
    if (std::string cause = DecodeRosDepth(image, &depth); !cause.empty()) return cause;
    CheckSize(kDepthTopic, depth.width_px, depth.height_px, camera_.camera.depth);
    if (!depth.range_m.empty()) StepsOf(&depth);
    rgbd::WriteDepthPng(file, depth.steps);
    return {};
  }

  void StepsOf(RosDepth* depth) const {
    depth->steps = rgbd::DepthImage(depth->width_px, depth->height_px);
    for (std::size_t i = 0; i < depth->range_m.size(); ++i) {
      const float z_m = depth->range_m[i];
      if (!(z_m <= kFarthest_m)) continue;
      depth->steps.values[i] =
          static_cast<std::uint16_t>(std::lround(double{z_m} / camera_.camera.depth_unit_m));
    }
  }

  std::string TakeColor(const recording::Message& message, const MessageType& type) {
    const fs::path file = FileOf(message, type, &color_, "color", ".png");
    if (file.empty()) return {};
    RosImage image;
    rgbd::ColorImage color;
    if (std::string cause = ReadImage(message.data, type, &image); !cause.empty()) return cause;
    if (std::string cause = DecodeRosColor(image, &color); !cause.empty()) return cause;
    CheckSize(kColorTopic, color.width_px, color.height_px, camera_.camera.color);
    rgbd::WriteColorPng(file, color);
    return {};
  }

  std::string TakePoints(const recording::Message& message, const MessageType& type) {
    const fs::path file = FileOf(message, type, &points_, "clouds", ".pcd");
    if (file.empty()) return {};
    std::string frame_id;
    experiment::PointCloud cloud;
    if (!ReadCloud(message.data, type, &frame_id, &cloud)) {
      return "is no cloud with x, y, z as FLOAT32 or FLOAT64";
    }
    if (cloud.points_m.cols() == 0) return "is empty";
    experiment::WritePcd(cloud, file);
    return {};
  }

  const recording::RecordedMessages& recorded_;
  const TopicRoles& roles_;
  const RecordedCamera& camera_;
  const std::vector<Stretch>& stretches_;
  std::map<std::uint16_t, std::unique_ptr<MessageType>> types_;
  FileTimes depth_;
  FileTimes color_;
  FileTimes points_;
  std::size_t unpaired_ = 0;  ///< colour images
  std::map<std::string, std::size_t> left_out_;
};

}  // namespace

void WriteImages(const recording::RecordedMessages& recorded, const TopicRoles& roles,
                 const CollectedTopics& topics, const RecordedCamera& camera,
                 const std::vector<Stretch>& stretches, std::vector<std::string>* notes) {
  ImageWriter(recorded, roles, topics, camera, stretches).Run(notes);
}

}  // namespace palpate::offline

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/collected_topics.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "components/offline/messages/ros_image.hpp"
#include "libs/recording/ros_names.hpp"
#include "libs/rgbd/ros_formats.hpp"

namespace palpate::offline {

namespace {

using recording::CdrReader;

double Real(CdrReader* reader) { return std::bit_cast<double>(reader->Bits(8)); }

Eigen::Vector3d Vector(CdrReader* reader) {
  Eigen::Vector3d vector;
  for (double& value : vector) value = Real(reader);
  return vector;
}

Eigen::Isometry3d Pose(CdrReader* reader) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector(reader);
  Eigen::Quaterniond rotation;
  for (double& value : rotation.coeffs()) value = Real(reader);
  if (rotation.norm() > 0.0) pose.linear() = rotation.normalized().toRotationMatrix();
  return pose;
}

struct MessageHeader {
  std::int64_t stamp_ns = 0;
  std::string frame_id;
};

MessageHeader ReadHeader(CdrReader* reader) {
  MessageHeader header;
  header.stamp_ns = reader->Stamp_ns();
  header.frame_id = reader->String();
  return header;
}

std::vector<double> Reals(CdrReader* reader) {
  std::vector<double> values;
  const std::uint32_t count = reader->Length();
  for (std::uint32_t i = 0; i < count && reader->ok(); ++i) values.push_back(Real(reader));
  return values;
}

std::vector<std::string> Texts(CdrReader* reader) {
  std::vector<std::string> texts;
  const std::uint32_t count = reader->Length();
  for (std::uint32_t i = 0; i < count && reader->ok(); ++i) texts.emplace_back(reader->String());
  return texts;
}

/// Empty: the lens is one that a camera file can have.
std::string SetDistortion(const std::string& name, const std::vector<double>& d,
                          rgbd::CameraModel* model) {
  const auto distortion = rgbd::DistortionOf(name, d);
  if (!distortion) {
    return "distortion model '" + name + "' with " + std::to_string(d.size()) +
           " numbers instead of plumb_bob with 5 finite ones or rational_polynomial with 8: record "
           "the rectified image (image_rect)";
  }
  model->distortion = *distortion;
  return {};
}

std::string SetIntrinsics(double fx_px, double fy_px, double cx_px, double cy_px,
                          rgbd::CameraModel* model) {
  model->fx_px = fx_px;
  model->fy_px = fy_px;
  model->cx_px = cx_px;
  model->cy_px = cy_px;
  const bool sound = fx_px > 0.0 && fy_px > 0.0 && std::isfinite(fx_px) && std::isfinite(fy_px) &&
                     std::isfinite(cx_px) && std::isfinite(cy_px);
  return sound ? "" : "has no intrinsics: its focal lengths are 0; calibrate the camera";
}

bool ReadInfo(CdrReader reader, CollectedInfo* info) {
  const MessageHeader header = ReadHeader(&reader);
  info->time.stamp_ns = header.stamp_ns;
  info->frame_id = header.frame_id;
  info->model.height_px = static_cast<int>(reader.Length());
  info->model.width_px = static_cast<int>(reader.Length());
  const std::string lens(reader.String());
  const std::vector<double> d = Reals(&reader);
  std::array<double, 9> k{};
  std::array<double, 12> p{};
  for (double& value : k) value = Real(&reader);
  for (int i = 0; i < 9; ++i) Real(&reader);
  for (double& value : p) value = Real(&reader);
  info->rectified = info->model;
  info->fault = SetIntrinsics(k[0], k[4], k[2], k[5], &info->model);
  info->rectified_fault = SetIntrinsics(p[0], p[5], p[2], p[6], &info->rectified);
  if (info->fault.empty()) info->fault = SetDistortion(lens, d, &info->model);
  return reader.ok();
}

/// `list`: at the markers. What stands between is of later versions of the message only.
bool ReadMarkers(CdrReader reader, CdrReader list, CollectedMarkers* set) {
  const MessageHeader header = ReadHeader(&reader);
  set->time.stamp_ns = header.stamp_ns;
  set->frame_id = header.frame_id;
  reader.Bits(8);  // counter
  set->recording = reader.String();
  set->reference_shape = static_cast<int>(reader.Bits(1));
  const std::uint32_t count = list.Length();
  for (std::uint32_t i = 0; i < count && list.ok(); ++i) {
    CollectedMarker marker;
    marker.name = list.String();
    const Eigen::Vector3d position_m = Vector(&list);
    marker.sigma_m = Vector(&list);
    std::array<double, 9> covariance_m2{};
    for (double& value : covariance_m2) value = Real(&list);
    for (const int axis : {0, 1, 2}) {
      const double variance_m2 = covariance_m2[static_cast<std::size_t>(4 * axis)];
      if (variance_m2 > 0.0) marker.sigma_m[axis] = std::sqrt(variance_m2);
    }
    const bool valid = list.Bits(1) != 0 && position_m.allFinite();
    if (valid) marker.position_m = position_m;
    set->markers.push_back(std::move(marker));
  }
  return reader.ok() && list.ok();
}

bool ReadJoints(CdrReader reader, CollectedJoints* set) {
  set->time.stamp_ns = ReadHeader(&reader).stamp_ns;
  const std::vector<std::string> names = Texts(&reader);
  const std::vector<double> positions = Reals(&reader);
  Reals(&reader);  // velocities
  const std::vector<double> efforts = Reals(&reader);
  const auto value = [](const std::vector<double>& values, std::size_t i) -> std::optional<double> {
    if (i >= values.size() || !std::isfinite(values[i])) return std::nullopt;
    return values[i];
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    set->joints.push_back({names[i], value(positions, i), value(efforts, i)});
  }
  return reader.ok();
}

bool ReadSetup(CdrReader reader, CollectedSetup* setup) {
  setup->time.stamp_ns = ReadHeader(&reader).stamp_ns;
  reader.Bits(4);   // epoch
  reader.String();  // device
  reader.String();  // model
  setup->depth_unit_m = Real(&reader);
  setup->invalid_value = static_cast<int>(reader.Length());
  setup->baseline_m = Real(&reader);
  const double subpixel_px = Real(&reader);
  setup->subpixel_px = subpixel_px > 0.0 ? subpixel_px : 0.0;
  setup->color_registered = reader.Bits(1) != 0;
  setup->T_depth_color = Pose(&reader);
  setup->knows_color = true;
  return reader.ok() && setup->depth_unit_m > 0.0;
}

bool ReadWrench(CdrReader reader, CollectedWrench* wrench) {
  const MessageHeader header = ReadHeader(&reader);
  wrench->time.stamp_ns = header.stamp_ns;
  wrench->frame_id = header.frame_id;
  wrench->force_N = Vector(&reader);
  wrench->torque_Nm = Vector(&reader);
  return reader.ok() && wrench->force_N.allFinite();
}

/// Takes one message of each kind after the other.
class Collector {
 public:
  Collector(const recording::RecordedMessages& recorded, const TopicRoles& roles)
      : recorded_(recorded), roles_(roles) {}

  CollectedTopics Run() {
    recording::MessageFilter filter;
    filter.wanted = [this](const recording::Channel& channel) { return IsWanted(channel); };
    recording::RecordedStream stream = recorded_.Messages(filter);
    while (const recording::Message* message = stream.Next()) Take(*message);
    for (const std::string& problem : stream.Problems()) ++topics_.left_out[problem];
    FindSegments();
    if (topics_.setups.empty()) topics_.setups = std::move(frame_infos_);
    return std::move(topics_);
  }

 private:
  void Extend(const std::string& name, bool is_new, const MessageTime& time) {
    if (is_new || topics_.segments.empty()) topics_.segments.push_back({name, time, time});
    topics_.segments.back().last = time;
  }

  /// By the names of played recordings; without, where the stamps of frames jump back.
  void FindSegments() {
    for (const CollectedMarkers& frame : topics_.markers) {
      const bool is_new =
          !topics_.segments.empty() && topics_.segments.back().name != frame.recording;
      Extend(frame.recording, is_new, frame.time);
    }
    if (topics_.segments.empty()) {
      for (const CollectedSetup& frame : frame_infos_) {
        const bool is_new = !topics_.segments.empty() &&
                            frame.time.stamp_ns < topics_.segments.back().last.stamp_ns;
        Extend("", is_new, frame.time);
      }
    }
    const bool all_is_one = topics_.segments.size() == 1 && topics_.segments.front().name.empty();
    if (all_is_one) topics_.segments.clear();
  }

  bool IsInfo(const recording::Channel& channel) const {
    return recording::RosTypeName(recorded_.SchemaOf(channel).name) == "sensor_msgs/msg/CameraInfo";
  }

  bool IsWanted(const recording::Channel& channel) const {
    if (roles_.transforms.contains(channel.id) || IsInfo(channel)) return true;
    return std::any_of(roles_.channels.begin(), roles_.channels.end(),
                       [&](const auto& role) { return role.second.contains(channel.id); });
  }

  const MessageType* Type(std::uint16_t channel) {
    auto found = types_.find(channel);
    if (found == types_.end()) {
      const auto& schema = recorded_.SchemaOf(recorded_.contents().channels.at(channel));
      found = types_.emplace(channel, TypeOf(schema)).first;
    }
    return found->second.get();
  }

  void LeaveOut(const recording::Message& message, const std::string& why) {
    const auto& channel = recorded_.contents().channels.at(message.channel_id);
    ++topics_.left_out[recording::RosTopicName(channel.topic) + ": " + why];
  }

  template <typename Item, typename Read>
  void Keep(const recording::Message& message, const MessageType& type, const char* field,
            const Read& read, std::vector<Item>* items) {
    Item item;
    if (!read(type.At(field, message.data), &item)) {
      LeaveOut(message, "does not fit the definition of its type");
      return;
    }
    item.time.log_ns = message.log_time_ns;
    items->push_back(std::move(item));
  }

  void TakeImage(const recording::Message& message, const MessageType& type, bool is_depth,
                 std::vector<CollectedImage>* images) {
    RosImage image;
    std::string cause = ReadImage(message.data, type, &image);
    if (cause.empty() && !image.compressed() && (image.width == 0 || image.height == 0)) {
      cause = "is empty";
    }
    if (cause.empty() && is_depth && image.encoding == "32FC1") cause = Survey(image);
    if (!cause.empty()) return LeaveOut(message, cause);
    images->push_back({{StampOf(message, type), message.log_time_ns, 0, 0}, image.frame_id});
  }

  std::string Survey(const RosImage& image) {
    RosDepth depth;
    if (std::string cause = DecodeRosDepth(image, &depth); !cause.empty()) return cause;
    topics_.has_ranges = true;
    for (const float z_m : depth.range_m) {
      if (!(z_m <= kFarthest_m)) continue;
      topics_.largest_range_m = std::max(topics_.largest_range_m, z_m);
      const float steps = z_m * 1000.0f;
      constexpr float kRounding = 1e-3f;  // of 32-bit numbers up to 6.5 m, in mm
      if (std::abs(steps - std::round(steps)) > kRounding) topics_.ranges_are_millimetres = false;
    }
    return {};
  }

  void TakePoints(const recording::Message& message, const MessageType& type) {
    CdrReader reader = type.At("header", message.data);
    const MessageHeader header = ReadHeader(&reader);
    if (!reader.ok()) return LeaveOut(message, "does not fit the definition of its type");
    topics_.points.push_back({{header.stamp_ns, message.log_time_ns, 0, 0}, header.frame_id});
  }

  void TakeMarkers(const recording::Message& message, const MessageType& type) {
    CollectedMarkers set;
    if (!ReadMarkers(type.At("header", message.data), type.At("markers", message.data), &set)) {
      return LeaveOut(message, "does not fit the definition of its type");
    }
    set.time.log_ns = message.log_time_ns;
    topics_.markers.push_back(std::move(set));
  }

  void TakeTransforms(const recording::Message& message, const MessageType& type) {
    CdrReader reader = type.At("transforms", message.data);
    const std::uint32_t count = reader.Length();
    for (std::uint32_t i = 0; i < count && reader.ok(); ++i) {
      const std::string parent = ReadHeader(&reader).frame_id;
      const std::string child(reader.String());
      const Eigen::Isometry3d T_parent_child = Pose(&reader);
      if (!reader.ok() || !T_parent_child.matrix().allFinite()) return;
      topics_.transforms.Add(parent, child, message.log_time_ns, T_parent_child);
    }
  }

  void TakeCalibration(const recording::Message& message, const MessageType& type) {
    CdrReader reader = type.At("has_camera", message.data);
    if (reader.Bits(1) == 0 || !reader.ok()) return;
    const Eigen::Isometry3d pose = Pose(&reader);
    std::array<double, 36> covariance{};
    for (double& value : covariance) value = Real(&reader);
    if (!reader.ok()) return;
    topics_.T_robot_camera = pose;
    const auto largest = [&](std::size_t first) {
      double variance = 0.0;
      for (std::size_t i = first; i < first + 3; ++i)
        variance = std::max(variance, covariance[7 * i]);
      return std::sqrt(variance);
    };
    topics_.T_robot_camera_error.reset();
    if (largest(0) > 0.0 && largest(3) > 0.0)
      topics_.T_robot_camera_error = {largest(0), largest(3)};
  }

  void TakeFrameInfo(const recording::Message& message, const MessageType& type) {
    CdrReader reader = type.At("depth_unit_m", message.data);
    CollectedSetup setup;
    setup.depth_unit_m = Real(&reader);
    setup.invalid_value = static_cast<int>(reader.Length());
    setup.time = {StampOf(message, type), message.log_time_ns, 0, 0};
    if (reader.ok() && setup.depth_unit_m > 0.0) frame_infos_.push_back(setup);
  }

  void Take(const recording::Message& message) {
    const std::uint16_t id = message.channel_id;
    const MessageType* type = Type(id);
    if (type == nullptr) return LeaveOut(message, "has a type without a definition");
    if (type->name == "sensor_msgs/msg/CameraInfo") {
      const std::size_t before = topics_.infos.size();
      Keep(message, *type, "header", ReadInfo, &topics_.infos);
      if (topics_.infos.size() > before) topics_.infos.back().channel = id;
    }
    if (roles_.transforms.contains(id)) TakeTransforms(message, *type);
    if (roles_.Is(kDepthTopic, id)) TakeImage(message, *type, true, &topics_.depth);
    if (roles_.Is(kColorTopic, id)) TakeImage(message, *type, false, &topics_.color);
    if (roles_.Is(kPointsTopic, id)) TakePoints(message, *type);
    if (roles_.Is(kMarkersTopic, id)) TakeMarkers(message, *type);
    if (roles_.Is(kJointStatesTopic, id)) {
      Keep(message, *type, "header", ReadJoints, &topics_.joints);
    }
    if (roles_.Is(kCameraSetupTopic, id))
      Keep(message, *type, "header", ReadSetup, &topics_.setups);
    if (roles_.Is(kLoadTopic, id)) Keep(message, *type, "header", ReadWrench, &topics_.wrenches);
    if (roles_.Is(kFrameInfoTopic, id)) TakeFrameInfo(message, *type);
    if (roles_.Is(kCalibrationTopic, id)) TakeCalibration(message, *type);
    if (roles_.Is(kPhaseTopic, id)) {
      CdrReader reader = type->At("data", message.data);
      topics_.phases.push_back({{0, message.log_time_ns, 0, 0}, std::string(reader.String())});
    }
  }

  const recording::RecordedMessages& recorded_;
  const TopicRoles& roles_;
  std::map<std::uint16_t, std::unique_ptr<MessageType>> types_;
  std::vector<CollectedSetup> frame_infos_;
  CollectedTopics topics_;
};

}  // namespace

CollectedTopics CollectTopics(const recording::RecordedMessages& recorded,
                              const TopicRoles& roles) {
  return Collector(recorded, roles).Run();
}

}  // namespace palpate::offline

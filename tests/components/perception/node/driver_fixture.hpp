// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "libs/dds/camera_topics.hpp"
#include "libs/dds/stamp.hpp"
#include "libs/dds/transforms.hpp"
#include "tests/libs/dds/test_participant.hpp"

namespace palpate::perception {

inline constexpr int kDriverWidth_px = 4, kDriverHeight_px = 3;

/// A camera_info of the images below. `fx_px` 0: without intrinsics.
inline dds::Message<idl::sensor_msgs::CameraInfo> DriverInfo(double fx_px, std::int64_t stamp_ns,
                                                             const std::string& frame) {
  dds::Message<idl::sensor_msgs::CameraInfo> info;
  dds::SetHeader(info->header, stamp_ns, frame);
  info->width = kDriverWidth_px;
  info->height = kDriverHeight_px;
  dds::SetText(info->distortion_model, "plumb_bob");
  const std::array<double, 5> none{};
  dds::SetNumbers(info->d, none.data(), none.size());
  if (fx_px == 0.0) return info;
  info->k[0] = info->k[4] = fx_px;
  info->k[2] = 1.5;
  info->k[5] = 1.0;
  info->k[8] = 1.0;
  for (int row = 0; row < 3; ++row) std::copy_n(info->k + 3 * row, 3, info->p + 4 * row);
  return info;
}

/// An image whose pixels all have the same bytes.
template <typename T>
dds::Message<idl::sensor_msgs::Image> DriverImage(const std::string& encoding,
                                                  const std::vector<T>& pixel,
                                                  std::int64_t stamp_ns, const std::string& frame) {
  dds::Message<idl::sensor_msgs::Image> image;
  dds::SetHeader(image->header, stamp_ns, frame);
  dds::SetText(image->encoding, encoding);
  image->width = kDriverWidth_px;
  image->height = kDriverHeight_px;
  const std::size_t pixel_bytes = pixel.size() * sizeof(T);
  image->step = static_cast<std::uint32_t>(pixel_bytes) * kDriverWidth_px;
  dds::Resize(image->data, std::size_t{image->step} * kDriverHeight_px);
  for (std::size_t i = 0; i < image->data._length; i += pixel_bytes) {
    std::memcpy(image->data._buffer + i, pixel.data(), pixel_bytes);
  }
  return image;
}

/// The names of realsense-ros, to which the node under test is remapped.
inline const std::vector<std::string> kRealSenseRules{
    "/camera/depth/image_raw:=/camera/camera/depth/image_rect_raw",
    "/camera/depth/camera_info:=/camera/camera/depth/camera_info",
    "/camera/color/image_raw:=/camera/camera/color/image_raw",
    "/camera/color/camera_info:=/camera/camera/color/camera_info"};

/// The same for a second camera of that name.
inline const std::vector<std::string> kBackRules{
    "/camera_back/depth/image_raw:=/back/back/depth/image_rect_raw",
    "/camera_back/depth/camera_info:=/back/back/depth/camera_info",
    "/camera_back/color/image_raw:=/back/back/color/image_raw",
    "/camera_back/color/camera_info:=/back/back/color/camera_info"};

/// Plays the driver of a camera: best effort, never latched, under names of its own.
class FakeDriver {
 public:
  static constexpr auto kDepthFrame = "camera_depth_optical_frame";
  static constexpr auto kColorFrame = "camera_color_optical_frame";

  /// `camera`: "back", or empty for the first.
  explicit FakeDriver(dds::Reliability reliability = dds::Reliability::kBestEffort,
                      const std::string& camera = {})
      : of_(dds::TopicsOf(camera)),
        participant_(Settings(camera), TableOf(reliability)),
        transforms_(participant_),
        depths_(participant_.CreateWriter(of_.depth, {}, camera)),
        depth_infos_(participant_.CreateWriter(of_.depth_lens, {}, camera)),
        colors_(participant_.CreateWriter(of_.color, {}, camera)),
        color_infos_(participant_.CreateWriter(of_.color_lens, {}, camera)) {}

  bool IsRead() const {
    return depths_.matched() == 1 && depth_infos_.matched() == 1 && colors_.matched() == 1 &&
           color_infos_.matched() == 1;
  }
  /// As drivers do: the image, then its camera_info.
  void SendDepth(const dds::Message<idl::sensor_msgs::Image>& image, double fx_px = 5.0) {
    EXPECT_TRUE(depths_.Write(image));
    SendDepthInfo(dds::StampNs(image->header.stamp), fx_px);
  }
  void SendDepthInfo(std::int64_t stamp_ns, double fx_px) {
    EXPECT_TRUE(depth_infos_.Write(DriverInfo(fx_px, stamp_ns, kDepthFrame)));
  }
  void SendColor(const dds::Message<idl::sensor_msgs::Image>& image, double fx_px = 6.0) {
    EXPECT_TRUE(colors_.Write(image));
    EXPECT_TRUE(color_infos_.Write(DriverInfo(fx_px, dds::StampNs(image->header.stamp),
                                              std::string(dds::Text(image->header.frame_id)))));
  }
  void SendTransform(const Eigen::Isometry3d& T_depth_color) {
    EXPECT_TRUE(transforms_.Set(kDepthFrame, kColorFrame, T_depth_color, 0));
  }

 private:
  static dds::ParticipantSettings Settings(const std::string& camera) {
    dds::ParticipantSettings settings{.domain_id = dds::TestDomain(), .node_name = "camera"};
    settings.remap = camera.empty() ? kRealSenseRules : kBackRules;
    return settings;
  }
  static dds::TopicTable TableOf(dds::Reliability reliability) {
    std::vector<dds::TopicSettings> topics = dds::BuiltInTable().topics();
    for (dds::TopicSettings& topic : topics) {
      if (!topic.name.starts_with("/camera")) continue;
      topic.reliability = reliability;
      topic.durability = dds::Durability::kVolatile;
    }
    return dds::TopicTable(std::move(topics));
  }

  dds::CameraTopics of_;
  dds::Participant participant_;
  dds::TransformBroadcaster transforms_;
  dds::Writer<idl::sensor_msgs::Image> depths_;
  dds::Writer<idl::sensor_msgs::CameraInfo> depth_infos_;
  dds::Writer<idl::sensor_msgs::Image> colors_;
  dds::Writer<idl::sensor_msgs::CameraInfo> color_infos_;
};

}  // namespace palpate::perception

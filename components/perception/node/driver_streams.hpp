// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/perception/node/camera_config.hpp"
#include "components/perception/node/camera_streams.hpp"
#include "components/perception/node/driver_camera.hpp"
#include "components/perception/node/nearest_pairing.hpp"
#include "libs/dds/camera_topics.hpp"
#include "sensor_msgs/msg/CompressedImage.hpp"

namespace palpate::perception {

/// Rules for names with those of the images also for their packed forms, as image_transport has it.
std::vector<std::string> WithTransports(std::vector<std::string> rules);

/// The topics of a camera driver of ROS 2: depth and colour, as they are or packed, each with its
/// camera_info, of any stamps, reliable or best effort; and /tf_static and /tf for where the
/// cameras stand.
class DriverStreams : public CameraStreams {
 public:
  /// `wait_s`: longest wait of a depth image for colour. `largest_z_m`: of depth in metres.
  /// `camera`: name of a camera beside the first; empty: the first. Throws InputError for a
  /// T_depth_color that is no pose, and for a name that is none.
  DriverStreams(dds::Participant& participant, dds::WaitSet& loop, const CameraConfig& config,
                double wait_s, double largest_z_m, StreamEvents events,
                const std::string& camera = {});

  void ExpectInputs(dds::InputMonitor& inputs) override;
  std::optional<FrameSet> Take(Time now) override;
  std::optional<Time> NextOverdue() const override { return pairing_.NextOverdue(); }
  Status Examine(const FrameSet& set, rgbd::RgbdCamera* camera) override;
  std::string device() const override { return camera_.depth().frame; }
  std::string depth_frame() const override { return camera_.depth().frame; }
  std::optional<Eigen::Isometry3d> T_robot_depth() const override {
    return camera_.T_robot_depth();
  }
  std::optional<double> subpixel_sigma_px() const override { return std::nullopt; }
  std::uint64_t setups() const override { return 1; }
  const dds::Endpoint& depths() const override;
  std::uint64_t dropped() const override { return pairing_.dropped(); }

 private:
  template <typename T>
  dds::Reader<T> ReaderOf(dds::Participant& participant, const dds::Topic<T>& topic) const;
  template <typename Message>
  void AddDepth(const Message& message);
  template <typename Message>
  void AddColor(const Message& message);
  const dds::Endpoint* colors() const;  ///< nullptr: none are read
  void TakeInfos();
  void TakeDepth();
  void TakeColor();
  bool AwaitsColor() const;
  bool AwaitsInfo() const;

  CameraConfig config_;
  dds::CameraTopics of_;
  double wait_s_;
  double largest_z_m_;
  StreamEvents events_;
  std::optional<dds::Reader<idl::sensor_msgs::Image>> depths_;  ///< or packed ones
  std::optional<dds::Reader<idl::sensor_msgs::CompressedImage>> packed_depths_;
  dds::Reader<idl::sensor_msgs::CameraInfo> depth_infos_;
  std::optional<dds::Reader<idl::sensor_msgs::Image>> colors_;  ///< with use_color, or packed ones
  std::optional<dds::Reader<idl::sensor_msgs::CompressedImage>> packed_colors_;
  std::optional<dds::Reader<idl::sensor_msgs::CameraInfo>> color_infos_;
  dds::Reader<idl::tf2_msgs::TFMessage> transforms_;
  dds::Reader<idl::tf2_msgs::TFMessage> moving_transforms_;
  DriverCamera camera_;
  NearestPairing pairing_;
  double depth_unit_m_ = 0.0;  ///< of the last depth image
  std::uint64_t counter_ = 0;
};

}  // namespace palpate::perception

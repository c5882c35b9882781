// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>

#include "components/perception/node/camera_inputs.hpp"
#include "components/perception/node/camera_streams.hpp"
#include "libs/dds/camera_topics.hpp"

namespace palpate::perception {

/// The topics of palpate-capture and palpate-player: images, lenses, set-up and frame info, one
/// stamp for all parts of a frame.
class CaptureStreams : public CameraStreams {
 public:
  /// `wait_s`: longest wait of a depth image for the rest of its set. `camera`: name of a camera
  /// beside the first; empty: the first. Throws InputError for a name that is none.
  CaptureStreams(dds::Participant& participant, dds::WaitSet& loop, double wait_s,
                 StreamEvents events, const std::string& camera = {});

  void ExpectInputs(dds::InputMonitor& inputs) override;
  std::optional<FrameSet> Take(Time now) override;
  std::optional<Time> NextOverdue() const override { return pairing_.NextOverdue(); }
  Status Examine(const FrameSet& set, rgbd::RgbdCamera* camera) override;
  std::string device() const override { return camera_.device(); }
  std::string depth_frame() const override { return of_.depth_frame; }
  std::optional<double> subpixel_sigma_px() const override { return camera_.subpixel_sigma_px(); }
  std::uint64_t setups() const override { return camera_.setups(); }
  const dds::Endpoint& depths() const override { return depths_; }
  std::uint64_t dropped() const override { return dropped_ + pairing_.dropped(); }

 private:
  void TakeCamera();
  void TakeDepth();
  void TakeColor();
  void TakeFacts();
  template <typename Message>
  FrameSet* PartOf(const Message& message);
  bool IsWhole(const FrameSet& set) const;

  dds::CameraTopics of_;
  double wait_s_;
  StreamEvents events_;
  dds::Reader<idl::palpate_msgs::CameraSetup> setups_;
  dds::Reader<idl::sensor_msgs::CameraInfo> depth_lenses_;
  dds::Reader<idl::sensor_msgs::CameraInfo> color_lenses_;
  dds::Reader<idl::sensor_msgs::Image> depths_;
  dds::Reader<idl::sensor_msgs::Image> colors_;
  dds::Reader<idl::palpate_msgs::FrameInfo> infos_;
  CameraInputs camera_;
  FramePairing pairing_;
  std::optional<std::uint64_t> colorless_setup_;  ///< that was found to have no colour
  std::uint64_t dropped_ = 0;                     ///< parts that came too late
};

}  // namespace palpate::perception

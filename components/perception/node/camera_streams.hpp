// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "components/perception/node/frame_pairing.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/rgbd/rgbd_camera.hpp"

namespace palpate::perception {

bool IsSameCamera(const rgbd::RgbdCamera& a, const rgbd::RgbdCamera& b);

/// What camera streams tell their node.
struct StreamEvents {
  std::function<void()> changed;               ///< a frame set may have become whole
  std::function<void(std::int64_t)> repeated;  ///< the frame of this stamp, taken last, came again
};

/// Where the node has its frames from. All calls come from the node's loop.
class CameraStreams {
 public:
  using Time = FrameSet::Time;

  virtual ~CameraStreams() = default;

  virtual void ExpectInputs(dds::InputMonitor& inputs) = 0;

  /// The newest frame set that is whole; where none is, one that has waited long enough.
  virtual std::optional<FrameSet> Take(Time now) = 0;
  /// When the next set has waited long enough; nullopt: none waits.
  virtual std::optional<Time> NextOverdue() const = 0;
  /// Why a set cannot be used; ok, and its camera, where it can.
  virtual Status Examine(const FrameSet& set, rgbd::RgbdCamera* camera) = 0;

  /// "vendor-serial", the replayed folder, or the frame of a driver's depth; empty: not known yet.
  virtual std::string device() const = 0;
  /// The frame of the depth image as its publisher names it; empty: not known yet.
  virtual std::string depth_frame() const = 0;
  /// Where transforms of ROS 2 have the depth camera; nullopt: they do not say, or are not read.
  virtual std::optional<Eigen::Isometry3d> T_robot_depth() const { return std::nullopt; }
  virtual std::optional<double> subpixel_sigma_px() const = 0;
  virtual std::uint64_t setups() const = 0;  ///< times that the camera was set up
  virtual const dds::Endpoint& depths() const = 0;

  std::uint64_t received() const { return received_; }  ///< depth images
  virtual std::uint64_t dropped() const = 0;            ///< parts and sets that were not used
  Time last_depth() const { return last_depth_; }       ///< when the last depth image came

 protected:
  void CountDepth() {
    ++received_;
    last_depth_ = std::chrono::steady_clock::now();
  }

 private:
  std::uint64_t received_ = 0;
  Time last_depth_;
};

}  // namespace palpate::perception

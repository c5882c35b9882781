// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "components/perception/node/frame_perception.hpp"

namespace palpate::perception {

/// What the stand-in for JointPerception was asked, shared between it and the test.
class Script {
 public:
  struct Call {
    std::int64_t stamp_ns = 0;
    int perception = 0;  ///< which one, from 1
    int cameras = 0;     ///< that this one had been given
    bool with_color = false;
    std::uint16_t depth_value = 0;                  ///< of the first pixel
    std::uint16_t last_depth_value = 0;             ///< the same of the last camera
    std::uint8_t color_value = 0;                   ///< red of the first pixel
    std::optional<Eigen::Vector3d> first_vertex_m;  ///< of the predicted surface
  };

  /// Update does not return while it is held.
  void Hold(bool hold) {
    const std::lock_guard lock(mutex_);
    hold_ = hold;
    changed_.notify_all();
  }
  std::vector<Call> calls() const {
    const std::lock_guard lock(mutex_);
    return calls_;
  }
  rgbd::RgbdCamera camera() const {
    const std::lock_guard lock(mutex_);
    return camera_;
  }
  Config config() const {
    const std::lock_guard lock(mutex_);
    return config_;
  }

  FramePerceptionMaker Maker() {
    return [this](const Config& config) { return std::make_unique<Scripted>(*this, config); };
  }

 private:
  class Scripted : public FramePerception {
   public:
    Scripted(Script& script, const Config& config) : script_(script) {
      const std::lock_guard lock(script_.mutex_);
      script_.config_ = config;
      number_ = ++script_.made_;
    }
    void SetCamera(std::size_t, const rgbd::RgbdCamera& camera) override {
      const std::lock_guard lock(script_.mutex_);
      script_.camera_ = camera;
      ++cameras_;
    }
    void Restart(std::size_t, const Config&) override {}
    const JointObservation& Update(std::int64_t stamp_ns,
                                   const std::vector<CameraFrame>& frames) override {
      std::unique_lock lock(script_.mutex_);
      const rgbd::RgbdFrame& frame = *frames[0].images;
      EXPECT_EQ(frame.stamp_ns, stamp_ns);
      const PredictedSurface* predicted = frames[0].predicted;
      Call call;
      call.stamp_ns = frame.stamp_ns;
      call.perception = number_;
      call.cameras = cameras_;
      call.with_color = !frame.color.empty();
      call.depth_value = frame.depth.values.at(0);
      call.last_depth_value = frames.back().images->depth.values.at(0);
      if (call.with_color) call.color_value = frame.color.values.at(0);
      if (predicted) call.first_vertex_m = predicted->vertices_m.col(0);
      script_.calls_.push_back(call);
      script_.changed_.wait(lock, [this] { return !script_.hold_; });
      observation_ = {};
      observation_.stamp_ns = stamp_ns;
      for (const CameraFrame& of_camera : frames) AddView(*of_camera.images);
      return observation_;
    }

   private:
    /// One point of the robot, as far away as the first pixel says, two of an object, one contact.
    void AddView(const rgbd::RgbdFrame& frame) {
      SegmentedFrame& seen = observation_.views.emplace_back().frame;
      seen.status = Status::Ok();
      seen.robot.points_m = Eigen::Matrix3Xf::Zero(3, 1);
      seen.robot.points_m(2, 0) = 1e-3f * static_cast<float>(frame.depth.values[0]);
      seen.robot.sigma_m = Eigen::VectorXf::Constant(1, 1e-3f);
      seen.robot.colors_rgb = {1, 2, 3};
      seen.object.points_m = Eigen::Matrix3Xf::Ones(3, 2);
      seen.object.sigma_m = Eigen::VectorXf::Ones(2);
      seen.object.colors_rgb.assign(6, 0);
      seen.rejected.at_depth_edge = 17;
      seen.notes = {"the light has changed"};
      DetectedContact contact;
      contact.name = "contact_1";
      contact.position_m = {0.1, 0.2, 0.3};
      contact.covariance_m2(0, 1) = 2e-6;
      contact.extent_m = {0.01, 0.02, 0.004};
      contact.point_count = 9;
      observation_.contacts = {contact};
    }

    Script& script_;
    int number_ = 0;
    int cameras_ = 0;
    JointObservation observation_;
  };

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool hold_ = false;
  int made_ = 0;
  std::vector<Call> calls_;
  rgbd::RgbdCamera camera_;
  Config config_;
};

}  // namespace palpate::perception

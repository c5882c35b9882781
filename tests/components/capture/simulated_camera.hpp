// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "components/capture/frame_source.hpp"
#include "libs/gige_vision/device.hpp"

namespace palpate::capture {

/// A loopback address that no other test process uses; `index` for several cameras in one.
inline std::string LoopbackAddress(int index = 0) {
  const int pid = getpid();
  return "127." + std::to_string(40 + index) + "." + std::to_string((pid >> 8) & 255) + "." +
         std::to_string(1 + (pid & 255) % 254);
}

inline rgbd::RgbdCamera SmallCamera() {
  rgbd::RgbdCamera camera;
  camera.depth = {160, 120, 133.0, 134.5, 80.25, 59.5, {0.01, -0.02, 0.001, 0.002, 0.003}};
  camera.depth_unit_m = 1e-4;
  camera.baseline_m = 0.055;
  camera.color = {200, 100, 150.0, 151.0, 99.0, 50.0, {0.1, 0.0, 0.0, 0.0, 0.0}};
  camera.T_depth_color.translation() = Eigen::Vector3d(0.015, 0.001, -0.002);
  camera.T_depth_color.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, 3).normalized()));
  return camera;
}

inline std::uint32_t Scramble(std::uint32_t value) {
  value = (value ^ 61u) ^ (value >> 16);
  value *= 9u;
  value ^= value >> 4;
  value *= 0x27d4eb2du;
  return value ^ (value >> 15);
}

/// A frame of which every pixel follows from `index`, which stands in the first depth pixel (from
/// 1).
inline rgbd::RgbdFrame PatternFrame(const rgbd::RgbdCamera& camera, std::uint16_t index) {
  rgbd::RgbdFrame frame;
  frame.depth = rgbd::DepthImage(camera.depth.width_px, camera.depth.height_px);
  frame.color = rgbd::ColorImage(camera.color.width_px, camera.color.height_px);
  std::uint32_t key = std::uint32_t{index} << 16;
  for (auto& z : frame.depth.values) z = static_cast<std::uint16_t>(Scramble(++key));
  for (auto& c : frame.color.values) c = static_cast<std::uint8_t>(Scramble(++key));
  frame.depth.values[0] = index;
  return frame;
}

/// A camera on the loopback network that sends pattern frames 1, 2, 3, ... at its rate.
class SimulatedCamera {
 public:
  explicit SimulatedCamera(const std::string& address, double rate_hz = 30.0,
                           rgbd::RgbdCamera camera = SmallCamera(), double loss = 0.0,
                           const std::string& serial = "VC000001")
      : camera_(std::move(camera)), period_s_(1.0 / rate_hz) {
    gige_vision::DeviceSettings settings;
    settings.interface_address = address;
    settings.rate_hz = rate_hz;
    settings.serial = serial;
    settings.impairment.loss = loss;
    device_ = std::make_unique<gige_vision::Device>(settings, camera_);
    thread_ = std::thread([this] { Run(); });
  }
  ~SimulatedCamera() {
    stop_ = true;
    thread_.join();
  }
  gige_vision::Device& device() { return *device_; }
  const rgbd::RgbdCamera& camera() const { return camera_; }

 private:
  void Run() {
    std::uint16_t index = 0;
    auto due = std::chrono::steady_clock::now();
    while (!stop_) {
      auto frame = PatternFrame(camera_, static_cast<std::uint16_t>(1 + index++ % 60000));
      frame.stamp_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                           std::chrono::system_clock::now().time_since_epoch())
                           .count();
      device_->Send(frame);
      due += std::chrono::duration_cast<std::chrono::nanoseconds>(
          std::chrono::duration<double>(period_s_));
      std::this_thread::sleep_until(due);
    }
  }

  rgbd::RgbdCamera camera_;
  double period_s_;
  std::unique_ptr<gige_vision::Device> device_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

using Deadline = std::chrono::steady_clock::time_point;
inline Deadline In(double seconds) {
  return std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                                std::chrono::duration<double>(seconds));
}
inline double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The next frame that satisfies `wanted`, or nullptr after the deadline.
inline FramePtr WaitForFrame(FrameSource& source, Deadline deadline,
                             const std::function<bool(const SourceFrame&)>& wanted = {}) {
  while (std::chrono::steady_clock::now() < deadline) {
    const FramePtr frame = source.Next(0.05);
    if (frame && (!wanted || wanted(*frame))) return frame;
  }
  return nullptr;
}

/// Reads frames until `done(health)` holds; false after the deadline.
inline bool WaitForHealth(FrameSource& source, Deadline deadline,
                          const std::function<bool(const SourceHealth&)>& done) {
  while (std::chrono::steady_clock::now() < deadline) {
    if (done(source.Health())) return true;
    source.Next(0.01);
  }
  return false;
}

}  // namespace palpate::capture

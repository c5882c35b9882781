// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "libs/gige_vision/device.hpp"

namespace palpate::gige_vision {

/// A loopback address of the test that runs, so that tests run side by side; `which`: a second
/// one, for a second device.
std::string TestAddress(int which = 0);

/// A camera of odd sizes, with a colour camera of others beside it.
rgbd::RgbdCamera TestCamera(int width_px = 90, int height_px = 62);
DeviceSettings TestSettings();
/// Every pixel differs from its neighbours and from those of other frames.
rgbd::RgbdFrame TestFrame(const rgbd::RgbdCamera& camera, int number, std::int64_t stamp_ns);

/// A test with a device of TestCamera at TestAddress; skipped where a sandbox does not let one be.
class DeviceTest : public testing::Test {
 protected:
  void SetUp() override;
  void MakeDevice() { device = std::make_unique<Device>(settings, camera); }

  DeviceSettings settings = TestSettings();
  rgbd::RgbdCamera camera = TestCamera();
  std::unique_ptr<Device> device;
};

/// Asks until `done` or the deadline; whether it was done.
bool WaitUntil(const std::function<bool()>& done, double deadline_s = 20.0);

/// Sends frame after frame of a device in a thread of its own, numbered from 0, for its life.
class FrameFeeder {
 public:
  FrameFeeder(Device* device, const rgbd::RgbdCamera& camera, double rate_hz = 30.0,
              int frame_count = 8);
  ~FrameFeeder();
  /// The frames that are sent over and over again.
  const std::vector<rgbd::RgbdFrame>& frames() const { return frames_; }

 private:
  std::vector<rgbd::RgbdFrame> frames_;
  std::jthread thread_;
};

}  // namespace palpate::gige_vision

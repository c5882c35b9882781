// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/gige_vision/test_device.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "libs/core/clock.hpp"
#include "libs/gige_vision/protocol.hpp"

namespace palpate::gige_vision {

std::string TestAddress(int which) {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = std::string(test->test_suite_name()) + "." + test->name();
  std::uint32_t hash = 2166136261u;
  for (const char c : name) hash = (hash ^ static_cast<std::uint8_t>(c)) * 16777619u;
  return "127." + std::to_string(71 + which) + "." + std::to_string((hash >> 8) & 0xff) + "." +
         std::to_string(1 + (hash >> 16) % 250);
}

rgbd::RgbdCamera TestCamera(int width_px, int height_px) {
  rgbd::RgbdCamera camera;
  camera.depth = {width_px, height_px, 70.5, 71.25, 44.0, 30.5, {0.01, -0.02, 1e-3, 2e-3, 0.3}};
  camera.depth_unit_m = 1e-4;
  camera.invalid_value = 0;
  camera.baseline_m = 0.055;
  camera.color = {width_px + 7, height_px - 5, 81.0, 82.0, 48.0, 28.0, {0.1, 0.2, 0.3, 0.4, 0.5}};
  camera.T_depth_color.translation() = Eigen::Vector3d(0.015, -0.002, 0.001);
  camera.T_depth_color.linear() =
      Eigen::Quaterniond(0.96, 0.0, 0.28, 0.0).normalized().toRotationMatrix();
  return camera;
}

DeviceSettings TestSettings() {
  DeviceSettings settings;
  settings.interface_address = TestAddress();
  settings.serial = "T" + std::to_string(std::hash<std::string>{}(TestAddress()) % 100000000);
  settings.confidence = true;
  return settings;
}

rgbd::RgbdFrame TestFrame(const rgbd::RgbdCamera& camera, int number, std::int64_t stamp_ns) {
  rgbd::RgbdFrame frame;
  frame.stamp_ns = stamp_ns;
  frame.depth = rgbd::DepthImage(camera.depth.width_px, camera.depth.height_px);
  frame.color = rgbd::ColorImage(camera.color.width_px, camera.color.height_px);
  std::uint32_t state = 12345u + static_cast<std::uint32_t>(number);
  const auto next = [&] { return (state = state * 1664525u + 1013904223u) >> 16; };
  for (auto& value : frame.depth.values) value = static_cast<std::uint16_t>(next());
  for (auto& value : frame.color.values) value = static_cast<std::uint8_t>(next());
  for (std::size_t i = 0; i < frame.depth.values.size(); i += 5) frame.depth.values[i] = 0;
  return frame;
}

void DeviceTest::SetUp() {
  settings.heartbeat_timeout_s = 60.0;  // a machine that stands still for seconds loses no client
  const int trial = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(kControlPort);
  inet_pton(AF_INET, TestAddress().c_str(), &here.sin_addr);
  const bool bound = bind(trial, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0;
  const int cause = errno;
  close(trial);
  if (!bound && cause != EADDRINUSE) {
    GTEST_SKIP() << "no UDP port " << kControlPort << " at " << TestAddress() << ": "
                 << std::strerror(cause);
  }
}

bool WaitUntil(const std::function<bool()>& done, double deadline_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(deadline_s);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

FrameFeeder::FrameFeeder(Device* device, const rgbd::RgbdCamera& camera, double rate_hz,
                         int frame_count) {
  for (int i = 0; i < frame_count; ++i) frames_.push_back(TestFrame(camera, i, 0));
  thread_ = std::jthread([this, device, rate_hz](const std::stop_token& stop) {
    auto next = std::chrono::steady_clock::now();
    for (std::size_t i = 0; !stop.stop_requested(); ++i) {
      rgbd::RgbdFrame& frame = frames_[i % frames_.size()];
      frame.stamp_ns = WallNow_ns();
      device->Send(frame);
      next += std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / rate_hz));
      std::this_thread::sleep_until(next);
    }
  });
}

FrameFeeder::~FrameFeeder() {
  thread_.request_stop();
  thread_.join();
}

}  // namespace palpate::gige_vision

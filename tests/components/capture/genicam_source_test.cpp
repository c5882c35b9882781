// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/genicam_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "components/capture/camera_list.hpp"
#include "tests/components/capture/simulated_camera.hpp"

namespace palpate::capture {
namespace {

using testing::HasSubstr;

constexpr double kLong_s = 20.0;  ///< to wait for what must come; nothing is asserted of it

GenicamSettings At(const std::string& address) {
  GenicamSettings settings;
  settings.depth.target.id = address;
  return settings;
}

bool Streams(const SourceHealth& health) { return health.state == SourceState::kStream; }

void ExpectNear(const rgbd::CameraModel& a, const rgbd::CameraModel& b) {
  EXPECT_EQ(a.width_px, b.width_px);
  EXPECT_EQ(a.height_px, b.height_px);
  EXPECT_NEAR(a.fx_px, b.fx_px, 1e-3);
  EXPECT_NEAR(a.fy_px, b.fy_px, 1e-3);
  EXPECT_NEAR(a.cx_px, b.cx_px, 1e-3);
  EXPECT_NEAR(a.cy_px, b.cy_px, 1e-3);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(a.distortion[i], b.distortion[i], 1e-7);
}

TEST(GenicamSource, EveryPixelArrivesAsItWasSent) {
  SimulatedCamera camera(LoopbackAddress());
  GenicamSource source(At(LoopbackAddress()));
  for (int i = 0; i < 30; ++i) {
    const FramePtr frame = WaitForFrame(source, In(kLong_s));
    ASSERT_NE(frame, nullptr) << source.Health().reason;
    const auto wanted = PatternFrame(camera.camera(), frame->images.depth.values[0]);
    ASSERT_EQ(frame->images.depth, wanted.depth);
    ASSERT_EQ(frame->images.color, wanted.color);
    EXPECT_EQ(frame->facts.epoch, 1u);
    EXPECT_GT(frame->facts.valid_ratio, 0.99);
  }
  EXPECT_EQ(source.Health().frames_failed, 0u);
  EXPECT_THAT(source.Health().device, HasSubstr("VC000001"));
}

TEST(GenicamSource, TheCalibrationComesFromTheCamera) {
  SimulatedCamera camera(LoopbackAddress());
  GenicamSource source(At(LoopbackAddress()));
  const FramePtr frame = WaitForFrame(source, In(kLong_s));
  ASSERT_NE(frame, nullptr) << source.Health().reason;
  const rgbd::RgbdCamera& told = *frame->camera;
  ExpectNear(told.depth, camera.camera().depth);
  ExpectNear(told.color, camera.camera().color);
  EXPECT_NEAR(told.depth_unit_m, 1e-4, 1e-10);
  EXPECT_NEAR(told.baseline_m, 0.055, 1e-6);
  EXPECT_FALSE(told.color_registered);
  EXPECT_TRUE(told.T_depth_color.isApprox(camera.camera().T_depth_color, 1e-6));
}

TEST(GenicamSource, StampsAreTheCamerasOnTheHostsClock) {
  SimulatedCamera camera(LoopbackAddress());
  GenicamSource source(At(LoopbackAddress()));
  std::int64_t last_ns = 0;
  for (int i = 0; i < 10; ++i) {
    const FramePtr frame = WaitForFrame(source, In(kLong_s));
    ASSERT_NE(frame, nullptr);
    EXPECT_EQ(frame->facts.clock_source, ClockSource::kDeviceMapped);
    EXPECT_GT(frame->facts.stamp_host_ns, last_ns);
    // Taken before it was received, and not long before.
    EXPECT_LE(frame->facts.stamp_host_ns, frame->facts.stamp_receive_ns);
    EXPECT_GT(frame->facts.stamp_host_ns, frame->facts.stamp_receive_ns - 2'000'000'000);
    EXPECT_EQ(frame->images.stamp_ns, frame->facts.stamp_host_ns);
    last_ns = frame->facts.stamp_host_ns;
  }
}

TEST(GenicamSource, ACameraThatIsKilledIsMissedAndWelcomedBack) {
  const std::string address = LoopbackAddress();
  auto camera = std::make_unique<SimulatedCamera>(address);
  GenicamSource source(At(address));
  for (std::uint32_t cycle = 1; cycle <= 4; ++cycle) {
    const FramePtr frame = WaitForFrame(
        source, In(kLong_s), [&](const SourceFrame& f) { return f.facts.epoch == cycle; });
    ASSERT_NE(frame, nullptr) << "cycle " << cycle << ": " << source.Health().reason;
    camera.reset();
    const auto killed = std::chrono::steady_clock::now();
    ASSERT_TRUE(WaitForHealth(source, In(kLong_s), [](const auto& h) { return !Streams(h); }));
    EXPECT_LT(SecondsSince(killed), 1.5);
    EXPECT_FALSE(source.Health().reason.empty());
    ASSERT_TRUE(WaitForHealth(source, In(kLong_s),
                              [](const auto& h) { return h.state == SourceState::kDiscover; }));
    camera = std::make_unique<SimulatedCamera>(address);
    const auto back = std::chrono::steady_clock::now();
    const FramePtr again = WaitForFrame(source, In(kLong_s));
    ASSERT_NE(again, nullptr) << source.Health().reason;
    EXPECT_LT(SecondsSince(back), 1.5);
    EXPECT_EQ(again->images.depth,
              PatternFrame(camera->camera(), again->images.depth.values[0]).depth);
  }
}

TEST(GenicamSource, AfterTheReturnTheCalibrationIsReadAgain) {
  const std::string address = LoopbackAddress();
  auto camera = std::make_unique<SimulatedCamera>(address);
  GenicamSource source(At(address));
  const FramePtr before = WaitForFrame(source, In(kLong_s));
  ASSERT_NE(before, nullptr);
  camera.reset();
  rgbd::RgbdCamera other = SmallCamera();
  other.depth.fx_px = 150.0;
  other.depth_unit_m = 2e-4;
  camera = std::make_unique<SimulatedCamera>(address, 30.0, other);
  const FramePtr after =
      WaitForFrame(source, In(kLong_s), [](const SourceFrame& f) { return f.facts.epoch == 2; });
  ASSERT_NE(after, nullptr) << source.Health().reason;
  EXPECT_NEAR(before->camera->depth.fx_px, 133.0, 1e-3);
  EXPECT_NEAR(after->camera->depth.fx_px, 150.0, 1e-3);
  EXPECT_NEAR(after->camera->depth_unit_m, 2e-4, 1e-10);
}

TEST(GenicamSource, AnotherCameraInItsPlaceIsNotTaken) {
  const std::string address = LoopbackAddress();
  auto camera = std::make_unique<SimulatedCamera>(address);
  GenicamSource source(At(address));
  ASSERT_NE(WaitForFrame(source, In(kLong_s)), nullptr);
  camera.reset();
  camera = std::make_unique<SimulatedCamera>(address, 30.0, SmallCamera(), 0.0, "OTHER");
  EXPECT_TRUE(WaitForHealth(source, In(kLong_s), [](const auto& h) {
    return h.reason.find("another camera answers") != std::string::npos;
  }));
}

TEST(GenicamSource, OnePercentLossLosesNoFrame) {
  SimulatedCamera camera(LoopbackAddress(), 60.0, SmallCamera(), 0.01);
  GenicamSource source(At(LoopbackAddress()));
  for (int i = 0; i < 240; ++i) {
    const FramePtr frame = WaitForFrame(source, In(kLong_s));
    ASSERT_NE(frame, nullptr);
    ASSERT_EQ(frame->images.depth,
              PatternFrame(camera.camera(), frame->images.depth.values[0]).depth);
  }
  EXPECT_EQ(source.Health().frames_failed, 0u);
  EXPECT_GT(source.Health().packets_resent, 0u);
}

TEST(GenicamSource, FivePercentLossLosesFewFramesAndTearsNone) {
  SimulatedCamera camera(LoopbackAddress(), 30.0, SmallCamera(), 0.05);
  GenicamSource source(At(LoopbackAddress()));
  for (int i = 0; i < 120; ++i) {
    const FramePtr frame = WaitForFrame(source, In(kLong_s));
    ASSERT_NE(frame, nullptr);
    const auto wanted = PatternFrame(camera.camera(), frame->images.depth.values[0]);
    ASSERT_EQ(frame->images.depth, wanted.depth);
    ASSERT_EQ(frame->images.color, wanted.color);
  }
  EXPECT_LE(source.Health().frames_failed, 8u);  // 28 of 30
}

TEST(GenicamSource, ASlowReaderGetsTheNewestAndTheRestIsCounted) {
  SimulatedCamera camera(LoopbackAddress(), 100.0);
  GenicamSettings settings = At(LoopbackAddress());
  settings.queue_frames = 2;
  GenicamSource source(settings);
  ASSERT_NE(WaitForFrame(source, In(kLong_s)), nullptr);
  const Deadline deadline = In(kLong_s);
  while (source.Health().frames_dropped < 20 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_GE(source.Health().frames_dropped, 20u);
  EXPECT_EQ(source.Health().state, SourceState::kStream);
}

TEST(GenicamSource, AReaderThatHoldsFramesNeverStopsTheCamera) {
  SimulatedCamera camera(LoopbackAddress(), 100.0);
  GenicamSettings settings = At(LoopbackAddress());
  settings.depth.pool_frames = 6;
  GenicamSource source(settings);
  std::vector<FramePtr> held;
  for (int i = 0; i < 4; ++i) held.push_back(WaitForFrame(source, In(kLong_s)));
  const auto pixels = held[0]->images.depth;
  ASSERT_TRUE(WaitForHealth(source, In(kLong_s), [](const auto& h) { return h.frames > 50; }));
  EXPECT_EQ(held[0]->images.depth, pixels);
  EXPECT_NE(WaitForFrame(source, In(kLong_s)), nullptr);
}

TEST(GenicamSource, DepthAndColourOfTwoDevicesArePaired) {
  rgbd::RgbdCamera only_depth = SmallCamera();
  only_depth.color = rgbd::CameraModel();
  SimulatedCamera depth(LoopbackAddress(0), 30.0, only_depth);
  SimulatedCamera color(LoopbackAddress(1), 30.0, SmallCamera(), 0.0, "COLOR");
  GenicamSettings settings = At(LoopbackAddress(0));
  settings.depth.wishes.role = DeviceRole::kDepthOnly;
  settings.color = settings.depth;
  settings.color->target.id = LoopbackAddress(1);
  settings.color->wishes.role = DeviceRole::kColorOnly;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().x() = 0.1;
  settings.color_overrides.T_depth_color = pose;
  GenicamSource source(settings);
  for (int i = 0; i < 15; ++i) {
    const FramePtr frame = WaitForFrame(source, In(kLong_s));
    ASSERT_NE(frame, nullptr) << source.Health().reason;
    EXPECT_EQ(frame->images.color.width_px, 200);
    EXPECT_EQ(frame->images.depth.width_px, 160);
    EXPECT_LE(std::abs(frame->facts.pairing_difference_ns), 16'666'667);
    EXPECT_TRUE(frame->camera->T_depth_color.isApprox(pose));
    EXPECT_EQ(frame->camera->color.width_px, 200);
  }
  EXPECT_THAT(source.Health().device, HasSubstr("COLOR"));
}

TEST(GenicamSource, ACameraThatIsNotThereIsSaid) {
  GenicamSource source(At("127.0.0.98"));
  EXPECT_TRUE(WaitForHealth(source, In(kLong_s), [](const auto& h) {
    return h.reason == "no camera answers at 127.0.0.98";
  }));
  EXPECT_EQ(source.Next(0.0), nullptr);
}

TEST(GenicamSource, AnIntensityOnlyCameraIsRefusedWithTheReason) {
  GenicamSettings settings;
  settings.depth.target.fake = true;
  GenicamSource source(settings);
  EXPECT_TRUE(WaitForHealth(source, In(kLong_s), [](const auto& h) {
    return h.reason.find("sends no depth") != std::string::npos;
  })) << source.Health().reason;
}

TEST(GenicamSource, TheFakeCameraStreamsIntensity) {
  GenicamSettings settings;
  settings.depth.target.fake = true;
  settings.depth.wishes.role = DeviceRole::kColorOnly;
  GenicamSource source(settings);
  const FramePtr frame = WaitForFrame(source, In(kLong_s));
  ASSERT_NE(frame, nullptr) << source.Health().reason;
  EXPECT_EQ(frame->images.color.width_px, 512);
  EXPECT_TRUE(frame->images.depth.empty());
}

TEST(CameraList, ShowsWhatACameraIs) {
  SimulatedCamera camera(LoopbackAddress());
  const auto cameras = ListCameras({LoopbackAddress(), "127.0.0.98"});
  const auto at = [&](const std::string& address) {
    const auto found = std::find_if(cameras.begin(), cameras.end(),
                                    [&](const auto& c) { return c.address == address; });
    return found == cameras.end() ? CameraDescription() : *found;
  };
  const CameraDescription found = at(LoopbackAddress());
  EXPECT_EQ(found.trouble, "");
  EXPECT_EQ(found.serial, "VC000001");
  EXPECT_EQ(found.vendor, "Palpate");
  EXPECT_THAT(found.components, testing::UnorderedElementsAre("Range", "Intensity"));
  EXPECT_THAT(found.formats, testing::UnorderedElementsAre("Coord3D_C16", "RGB8"));
  EXPECT_THAT(at("127.0.0.98").trouble, HasSubstr("no camera answers"));
}

TEST(CameraList, PrintsATable) {
  std::ostringstream text;
  PrintCameras(
      {{"Blaze", "Basler", "123", "10.0.0.2", "GigEVision", {"Range"}, {"Coord3D_C16"}, ""},
       {"", "", "", "10.0.0.3", "GigEVision", {}, {}, "no camera answers"}},
      text);
  EXPECT_EQ(text.str(),
            "VENDOR  MODEL  SERIAL  ADDRESS   PROTOCOL    COMPONENTS         FORMATS\n"
            "Basler  Blaze  123     10.0.0.2  GigEVision  Range              Coord3D_C16\n"
            "-       -      -       10.0.0.3  GigEVision  no camera answers  -\n");
  std::ostringstream none;
  PrintCameras({}, none);
  EXPECT_THAT(none.str(), HasSubstr("No camera answers"));
}

}  // namespace
}  // namespace palpate::capture

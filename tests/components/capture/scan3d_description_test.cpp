// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/genicam/scan3d_description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "components/capture/genicam/device_setup.hpp"
#include "tests/components/capture/map_features.hpp"

namespace palpate::capture {
namespace {

using testing::HasSubstr;

Scan3dReading Read(MapFeatures f, const Scan3dOverrides& overrides = {}) {
  return ReadScan3d(f, 640, 480, overrides);
}

TEST(Scan3dDescription, HoldsWhatTheCameraTells) {
  const Scan3dReading reading = Read(ThreePartCamera());
  ASSERT_TRUE(reading.status.ok()) << reading.status.message();
  const Scan3dDescription& d = reading.description;
  EXPECT_EQ(d.mode, OutputMode::kProjectedC);
  EXPECT_DOUBLE_EQ(d.distance_unit_m, 1e-3);
  EXPECT_DOUBLE_EQ(d.coordinates[2].scale, 0.25);
  EXPECT_TRUE(d.coordinates[2].marks_invalid);
  EXPECT_FALSE(d.coordinates[0].marks_invalid);
  EXPECT_DOUBLE_EQ(d.camera.fx_px, 600.0);
  EXPECT_DOUBLE_EQ(d.camera.cx_px, 320.5);
  EXPECT_DOUBLE_EQ(d.baseline_m, 0.055);
  EXPECT_TRUE(reading.notes.empty());
}

TEST(Scan3dDescription, TakesTheRegionOffThePrincipalPoint) {
  MapFeatures f = ThreePartCamera();
  f.values["OffsetX"] = std::int64_t{100};
  f.values["OffsetY"] = std::int64_t{40};
  const auto camera = Read(f).description.camera;
  EXPECT_DOUBLE_EQ(camera.cx_px, 220.5);
  EXPECT_DOUBLE_EQ(camera.cy_px, 199.5);
}

TEST(Scan3dDescription, ABaselineInMetresBesideMillimetresIsRecognised) {
  MapFeatures f = ThreePartCamera();
  f.values["Scan3dBaseline"] = 0.16;
  const Scan3dReading reading = Read(f);
  EXPECT_DOUBLE_EQ(reading.description.baseline_m, 0.16);
  ASSERT_EQ(reading.notes.size(), 1u);
  EXPECT_THAT(reading.notes[0], HasSubstr("metres"));
}

TEST(Scan3dDescription, AnAbsurdBaselineIsUnknownUnlessDisparitiesNeedIt) {
  MapFeatures f = ThreePartCamera();
  f.values["Scan3dBaseline"] = 1e9;
  EXPECT_TRUE(Read(f).status.ok());
  EXPECT_EQ(Read(f).description.baseline_m, 0.0);
  f.values["Scan3dOutputMode"] = std::string("DisparityC");
  EXPECT_THAT(Read(f).status.message(), HasSubstr("baseline_m"));
  Scan3dOverrides overrides;
  overrides.baseline_m = 0.1;
  EXPECT_TRUE(Read(f, overrides).status.ok());
}

TEST(Scan3dDescription, RefusesWhatNoCameraHasAndNamesTheSettingThatMendsIt) {
  struct Case {
    const char* feature;
    FeatureValue value;
    const char* setting;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Case cases[] = {
      {"Scan3dFocalLength", 0.0, "depth.intrinsics_px"},
      {"Scan3dFocalLength", 49.0, "depth.intrinsics_px"},
      {"Scan3dFocalLength", 20001.0, "depth.intrinsics_px"},
      {"Scan3dFocalLength", nan, "depth.intrinsics_px"},
      {"Scan3dFocalLength", std::string("600"), "depth.intrinsics_px"},
      {"Scan3dPrincipalPointU", 2000.0, "depth.intrinsics_px"},
      {"Scan3dPrincipalPointV", -241.0, "depth.intrinsics_px"},
      {"Scan3dPrincipalPointV", nan, "depth.intrinsics_px"},
      {"Scan3dCoordinateScale[CoordinateC]", 0.0, "coordinate_scale"},
      {"Scan3dCoordinateScale[CoordinateC]", -1.0, "coordinate_scale"},
      {"Scan3dCoordinateScale[CoordinateC]", infinity, "coordinate_scale"},
      {"Scan3dCoordinateOffset", nan, "Offset"},
      {"Scan3dDistanceUnit", std::string("Parsec"), "distance_unit_m"},
      {"Scan3dOutputMode", std::string("CalibratedABC_PointCloud"), "Scan3dOutputMode"},
  };
  for (const Case& c : cases) {
    MapFeatures f = ThreePartCamera();
    f.values[c.feature] = c.value;
    const Status status = Read(f).status;
    EXPECT_FALSE(status.ok()) << c.feature;
    EXPECT_THAT(status.message(), HasSubstr(c.setting)) << c.feature;
  }
}

TEST(Scan3dDescription, APrincipalPointOfZeroCountsAsNotTold) {
  MapFeatures f = ThreePartCamera();
  f.values["Scan3dPrincipalPointU"] = 0.0;
  const Scan3dReading reading = Read(f);
  ASSERT_TRUE(reading.status.ok());
  EXPECT_EQ(reading.description.camera.cx_px, 319.5);
  EXPECT_THAT(reading.notes, testing::Contains(HasSubstr("reports 0 for its principal point")));
}

TEST(Scan3dDescription, WhatIsGivenCountsMoreThanWhatIsTold) {
  MapFeatures f = ThreePartCamera();
  for (const char* name : {"Scan3dFocalLength", "Scan3dPrincipalPointU", "Scan3dPrincipalPointV",
                           "Scan3dBaseline", "Scan3dDistanceUnit"}) {
    f.values.erase(name);
  }
  Scan3dOverrides overrides{.fx_px = 500.0,
                            .fy_px = 510.0,
                            .cx_px = 300.0,
                            .cy_px = 200.0,
                            .baseline_m = 0.1,
                            .distance_unit_m = 0.01,
                            .scale_c = 0.5,
                            .distortion = {0.1, 0.2, 0.3, 0.4, 0.5}};
  const Scan3dReading reading = Read(f, overrides);
  ASSERT_TRUE(reading.status.ok()) << reading.status.message();
  const rgbd::CameraModel wanted = {
      640, 480, 500.0, 510.0, 300.0, 200.0, {0.1, 0.2, 0.3, 0.4, 0.5}};
  EXPECT_EQ(reading.description.camera, wanted);
  EXPECT_DOUBLE_EQ(reading.description.baseline_m, 0.1);
  EXPECT_DOUBLE_EQ(reading.description.distance_unit_m, 0.01);
  EXPECT_DOUBLE_EQ(reading.description.coordinates[2].scale, 0.5);
}

TEST(Scan3dDescription, ACameraThatTellsOnlyItsFocalLengthWorks) {
  MapFeatures f;
  f.values["Scan3dFocalLength"] = 600.0;
  const Scan3dReading reading = Read(f);
  EXPECT_TRUE(reading.status.ok()) << reading.status.message();
  EXPECT_DOUBLE_EQ(reading.description.camera.cx_px, 319.5);
  EXPECT_TRUE(reading.description.coordinates[2].marks_invalid);
  EXPECT_EQ(reading.description.coordinates[2].invalid_raw, 0.0);
  EXPECT_GE(reading.notes.size(), 3u);
}

TEST(DeviceSetup, EnablesDepthAndColourAndNothingElse) {
  MapFeatures f = ThreePartCamera();
  const DeviceSetup setup = ConfigureDevice(f, {});
  ASSERT_TRUE(setup.status.ok()) << setup.status.message();
  EXPECT_EQ(f.values["ComponentEnable[Range]"], FeatureValue(true));
  EXPECT_EQ(f.values["ComponentEnable[Intensity]"], FeatureValue(true));
  EXPECT_EQ(f.values["ComponentEnable[Confidence]"], FeatureValue(false));
  EXPECT_EQ(setup.depth_format, PixelFormat::kCoord3dC16);
  EXPECT_EQ(setup.color.width_px, 640);
  EXPECT_DOUBLE_EQ(setup.period_s, 1.0 / 30.0);
  EXPECT_DOUBLE_EQ(setup.exposure_s, 0.005);
  EXPECT_DOUBLE_EQ(setup.gain_dB, 3.0);
}

TEST(DeviceSetup, ACameraThatWasLeftStreamingIsStoppedAndUnlockedFirst) {
  MapFeatures f = ThreePartCamera();
  f.values["AcquisitionStop"] = true;
  f.values["TLParamsLocked"] = std::int64_t{1};
  ASSERT_TRUE(ConfigureDevice(f, {}).status.ok());
  EXPECT_EQ(f.executed, std::vector<std::string>{"AcquisitionStop"});
  EXPECT_EQ(f.values["TLParamsLocked"], FeatureValue(std::int64_t{0}));
}

TEST(DeviceSetup, OneImageWithCoordinatesAndIntensityIsChosenBeforeGrey) {
  MapFeatures f = ThreePartCamera();
  f.choices.erase("ComponentSelector");
  f.values.erase("ComponentSelector");
  f.choices["PixelFormat"] = {{"Mono8", 0x01080001}, {"Coord3D_ABCY16", 0x82400099}};
  f.values["PixelFormat"] = std::string("Mono8");
  f.values["Scan3dOutputMode"] = std::string("CalibratedABC_Grid");
  const DeviceSetup setup = ConfigureDevice(f, {});
  ASSERT_TRUE(setup.status.ok()) << setup.status.message();
  EXPECT_EQ(setup.depth_format, PixelFormat::kCoord3dAbcy16);
  EXPECT_EQ(setup.color.width_px, 640);
  // The maker's own code is known by the name that the camera gives it.
  EXPECT_EQ(setup.codes.FormatOf(0x82400099), PixelFormat::kCoord3dAbcy16);
}

TEST(DeviceSetup, AGreyCameraIsToldFromADepthCamera) {
  MapFeatures f;
  f.choices["PixelFormat"] = {{"Mono8", 0x01080001}};
  f.values["PixelFormat"] = std::string("Mono8");
  f.values["Width"] = std::int64_t{512};
  f.values["Height"] = std::int64_t{512};
  const DeviceSetup depth = ConfigureDevice(f, {});
  EXPECT_FALSE(depth.status.ok());
  EXPECT_THAT(depth.status.message(), HasSubstr("sends no depth"));
  EXPECT_THAT(depth.status.message(), HasSubstr("Mono8"));
  DeviceWishes color;
  color.role = DeviceRole::kColorOnly;
  EXPECT_TRUE(ConfigureDevice(f, color).status.ok());
}

TEST(DeviceSetup, WishesThatTheCameraRefusesAreSaid) {
  MapFeatures f = ThreePartCamera();
  f.refused = {"ExposureTime"};
  DeviceWishes wishes;
  wishes.exposure_s = 0.002;
  wishes.gain_dB = 6.0;
  wishes.trigger_source = "Line0";
  const DeviceSetup setup = ConfigureDevice(f, wishes);
  ASSERT_TRUE(setup.status.ok());
  EXPECT_DOUBLE_EQ(setup.exposure_s, 0.005);
  EXPECT_DOUBLE_EQ(setup.gain_dB, 6.0);
  ASSERT_EQ(setup.notes.size(), 3u);  // exposure refused, TriggerMode and TriggerSource missing
  EXPECT_THAT(setup.notes[0], HasSubstr("Trigger"));
  EXPECT_THAT(setup.notes[2], HasSubstr("ExposureTime"));
}

FeatureValue AbsurdValue(std::mt19937& random) {
  const double numbers[] = {
      0.0, -1.0, 1e300, -1e300, 1e-300, std::nan(""), std::numeric_limits<double>::infinity(),
      1e9, 3.0};
  switch (random() % 4) {
    case 0: return random() % 2 == 0;
    case 1: return static_cast<std::int64_t>(random()) * (random() % 2 == 0 ? 1 : -2147483647);
    case 2: return numbers[random() % std::size(numbers)];
    default: return std::string(random() % 3 == 0 ? "" : "Garbage");
  }
}

TEST(DeviceSetup, AnyFeatureMissingOrAbsurdEndsInARefusalOrAWorkingSubset) {
  constexpr unsigned kSeed = 20261121;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937 random(kSeed);
  int working = 0;
  for (int round = 0; round < 3000; ++round) {
    MapFeatures f = ThreePartCamera();
    for (int change = 0; change < 1 + round % 4; ++change) {
      auto victim = std::next(f.values.begin(), static_cast<long>(random() % f.values.size()));
      if (random() % 2 == 0) {
        f.values.erase(victim);
      } else {
        victim->second = AbsurdValue(random);
      }
    }
    const DeviceSetup setup = ConfigureDevice(f, {});
    if (!setup.status.ok()) {
      EXPECT_FALSE(setup.status.message().empty());
      continue;
    }
    ++working;
    const rgbd::CameraModel& camera = setup.scan3d.camera;
    EXPECT_GE(camera.fx_px, 50.0);
    EXPECT_LE(camera.fx_px, 20000.0);
    EXPECT_TRUE(std::isfinite(camera.fy_px + camera.cx_px + camera.cy_px));
    EXPECT_GT(camera.width_px, 0);
    EXPECT_GT(setup.scan3d.coordinates[2].scale, 0.0);
    EXPECT_GE(setup.scan3d.baseline_m, 0.0);
    EXPECT_GE(setup.period_s, 0.0);
  }
  EXPECT_GT(working, 300);
  EXPECT_LT(working, 2700);
}

}  // namespace
}  // namespace palpate::capture

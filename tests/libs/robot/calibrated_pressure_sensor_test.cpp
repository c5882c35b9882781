// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibrated_pressure_sensor.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "tests/libs/robot/calibration_file_fixture.hpp"

namespace palpate::robot {
namespace {

using testing::HasSubstr;

class CalibratedPressureSensorTest : public CalibrationFileFixture {
 protected:
  CalibrationFile Example() const override {
    CalibrationFile calibration = DescribeForCalibration(*model_);
    calibration.date_utc = "2026-01-31T12:00:00Z";
    calibration.data = "some";
    calibration.data_hash = "sha256-00ff";
    calibration.pressure_sensors = {
        {.chamber = "tip", .zero_Pa = CalibratedNumber{-1.0 / 3.0, 12.5}, .gain = {}},
        {.chamber = "base", .zero_Pa = {}, .gain = CalibratedNumber{0.07, 0.004}}};
    return calibration;
  }
};

TEST_F(CalibratedPressureSensorTest, IsReadAsItWasWritten) {
  WriteCalibrationFile(Example(), file_);
  const CalibrationFile read = ReadCalibrationFile(file_, app::LoadYaml);
  ASSERT_EQ(read.pressure_sensors.size(), 2U);
  const CalibratedPressureSensor& tip = read.pressure_sensors[0];
  EXPECT_EQ(tip.chamber, "tip");
  ASSERT_TRUE(tip.zero_Pa);
  EXPECT_EQ(tip.zero_Pa->value, -1.0 / 3.0);
  EXPECT_EQ(tip.zero_Pa->standard_error, 12.5);
  EXPECT_FALSE(tip.gain) << "not determined is not 0";
  const CalibratedPressureSensor& base = read.pressure_sensors[1];
  EXPECT_FALSE(base.zero_Pa);
  ASSERT_TRUE(base.gain);
  EXPECT_EQ(base.gain->value, 0.07);
  EXPECT_EQ(base.gain->standard_error, 0.004);
}

TEST_F(CalibratedPressureSensorTest, IsRefusedWithItsPlaceInTheFile) {
  EXPECT_THAT(ReadRefusal(Altered("zero_Pa: -0.3333333333333333", "zero_Pa: .nan")),
              HasSubstr("zero_Pa"));
  EXPECT_THAT(ReadRefusal(Altered("gain: 0.07", "gain: -1")), HasSubstr(":13:"));
  EXPECT_THAT(ReadRefusal(Altered("gain_standard_error: 0.004", "gain_standard_error: -1")),
              HasSubstr("gain_standard_error"));
  EXPECT_THAT(ReadRefusal(Altered(", gain_standard_error: 0.004", "")),
              HasSubstr("gain_standard_error"));
  EXPECT_THAT(ReadRefusal(Altered(", gain: 0.07, gain_standard_error: 0.004", "")),
              HasSubstr("must hold zero_Pa or gain"));
}

TEST_F(CalibratedPressureSensorTest, OfAChamberThatIsNotThereIsRefused) {
  EXPECT_THAT(CheckCalibration(Example(), *model_).message(), HasSubstr("chamber 'tip'"));
}

TEST(PressureOfASensor, IsTheReadingWithGainAndZero) {
  const CalibratedPressureSensor sensor{.chamber = "tip",
                                        .zero_Pa = CalibratedNumber{-100.0, 0.0},
                                        .gain = CalibratedNumber{0.25, 0.0}};
  EXPECT_DOUBLE_EQ(sensor.Pressure_Pa(2000.0), 2400.0);
  EXPECT_DOUBLE_EQ(CalibratedPressureSensor{}.Pressure_Pa(2000.0), 2000.0);
}

/// Corrected twice is corrected by both as one.
TEST(PressureOfASensor, ComposesWithALaterCalibration) {
  const CalibratedPressureSensor before{.chamber = "tip",
                                        .zero_Pa = CalibratedNumber{-100.0, 3.0},
                                        .gain = CalibratedNumber{0.25, 0.02}};
  const CalibratedPressureSensor found{
      .chamber = "tip", .zero_Pa = CalibratedNumber{40.0, 2.0}, .gain = {}};
  const CalibratedPressureSensor both = Compose(before, found);
  for (const double reading_Pa : {-500.0, 0.0, 3e4}) {
    EXPECT_NEAR(both.Pressure_Pa(reading_Pa), found.Pressure_Pa(before.Pressure_Pa(reading_Pa)),
                1e-9);
  }
  EXPECT_EQ(both.zero_Pa->standard_error, 2.0);
  EXPECT_EQ(both.gain->standard_error, 0.02) << "not found again";
  const CalibratedPressureSensor none{.chamber = "tip", .zero_Pa = {}, .gain = {}};
  EXPECT_FALSE(Compose(none, none).gain);
}

TEST(PressureOfASensor, IsRefusedWhereAValueCannotBe) {
  const auto refused = [](CalibratedNumber zero_Pa, CalibratedNumber gain) {
    return !CheckPressureSensor({.chamber = "tip", .zero_Pa = zero_Pa, .gain = gain}).ok();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(refused({-3.0, 1.0}, {0.1, 0.0}));
  EXPECT_TRUE(refused({nan, 1.0}, {0.1, 0.0}));
  EXPECT_TRUE(refused({-3.0, -1.0}, {0.1, 0.0}));
  EXPECT_TRUE(refused({-3.0, 1.0}, {-1.0, 0.0}));
  EXPECT_FALSE(CheckPressureSensor({.chamber = "tip", .zero_Pa = {}, .gain = {}}).ok());
}

}  // namespace
}  // namespace palpate::robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/pressure_correction.hpp"

#include <gtest/gtest.h>

namespace palpate::offline {
namespace {

using Quantity = experiment::ActuatorQuantity;

TEST(CorrectPressures, OfCalibratedChambersAlone) {
  experiment::Recording recording;
  recording.actuation = experiment::Actuation{
      .t_s = {0.0, 1.0},
      .columns = {
          {.cable = "bend",
           .quantity = Quantity::kTension,
           .samples = {1e3, {}},
           .where = {},
           .of_chamber = true},
          {.cable = "bend",
           .quantity = Quantity::kDisplacement,
           .samples = {1e-6, 2e-6},
           .where = {},
           .of_chamber = true},
          {.cable = "tip",
           .quantity = Quantity::kTension,
           .samples = {5e3, 6e3},
           .where = {},
           .of_chamber = true},
          {.cable = "north", .quantity = Quantity::kTension, .samples = {2.0, 3.0}, .where = {}}}};
  experiment::Experiment experiment;
  experiment.recordings = {recording, {}};
  robot::CalibrationFile calibration;
  calibration.pressure_sensors = {{.chamber = "bend",
                                   .zero_Pa = robot::CalibratedNumber{-50.0, 1.0},
                                   .gain = robot::CalibratedNumber{0.1, 0.01}},
                                  {.chamber = "north", .zero_Pa = {}, .gain = {}}};
  CorrectPressures(calibration, &experiment);
  const auto& columns = experiment.recordings[0].actuation->columns;
  EXPECT_DOUBLE_EQ(*columns[0].samples[0], 1050.0);
  EXPECT_FALSE(columns[0].samples[1]) << "missing stays missing";
  EXPECT_EQ(columns[1].samples, recording.actuation->columns[1].samples) << "a volume";
  EXPECT_EQ(columns[2].samples, recording.actuation->columns[2].samples) << "not calibrated";
  EXPECT_EQ(columns[3].samples, recording.actuation->columns[3].samples) << "a cable";
}

}  // namespace
}  // namespace palpate::offline

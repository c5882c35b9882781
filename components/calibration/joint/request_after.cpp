// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/request_after.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace palpate::calibration {

namespace {

/// The largest; 0: there is none.
double LargestErrorOf(
    const std::vector<robot::CalibratedPressureSensor>& sensors,
    std::optional<robot::CalibratedNumber> robot::CalibratedPressureSensor::*number) {
  double error = 0.0;
  for (const robot::CalibratedPressureSensor& sensor : sensors) {
    if (sensor.*number) error = std::max(error, (sensor.*number)->standard_error);
  }
  return error;
}

}  // namespace

JointRequest RequestAfter(const robot::CalibrationFile& file) {
  double sigma_m = 0.0;
  for (const robot::CalibratedDrive& drive : file.drives) {
    sigma_m = std::max(sigma_m, drive.standard_error.offset_m);
  }
  JointRequest request;
  request.actuator_offsets = sigma_m > 0.0;
  if (request.actuator_offsets) request.actuator_offset_sigma_m = sigma_m;
  using Sensor = robot::CalibratedPressureSensor;
  request.pressure_zero_sigma_Pa = LargestErrorOf(file.pressure_sensors, &Sensor::zero_Pa);
  request.pressure_gain_sigma = LargestErrorOf(file.pressure_sensors, &Sensor::gain);
  return request;
}

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/pressure_correction.hpp"

#include <optional>

namespace palpate::offline {

void CorrectPressures(const robot::CalibrationFile& calibration, experiment::Recording* recording) {
  if (!recording->actuation) return;
  for (experiment::ActuatorColumn& column : recording->actuation->columns) {
    if (!column.of_chamber || column.quantity != experiment::ActuatorQuantity::kTension) continue;
    for (const robot::CalibratedPressureSensor& sensor : calibration.pressure_sensors) {
      if (sensor.chamber != column.cable) continue;
      for (std::optional<double>& sample : column.samples) {
        if (sample) sample = sensor.Pressure_Pa(*sample);
      }
    }
  }
}

void CorrectPressures(const robot::CalibrationFile& calibration,
                      experiment::Experiment* experiment) {
  for (experiment::Recording& recording : experiment->recordings) {
    CorrectPressures(calibration, &recording);
  }
}

}  // namespace palpate::offline

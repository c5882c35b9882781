// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/core/status.hpp"

namespace palpate::robot {

/// An estimated number, in the unit that its name says.
struct CalibratedNumber {
  double value = 0.0;
  double standard_error = 0.0;
};

/// Zero and gain of the pressure sensor of a chamber: where it reads p, the chamber has the
/// pressure (1 + gain) p + zero_Pa. What the data did not determine is absent. A chamber that is
/// open to the air has no reading, and so neither of them.
struct CalibratedPressureSensor {
  std::string chamber;
  std::optional<CalibratedNumber> zero_Pa;
  std::optional<CalibratedNumber> gain;

  /// With a zero or gain that is absent as 0.
  double Pressure_Pa(double reading_Pa) const;
};

/// The sensor that shows the readings of `before` corrected by `found`: both as one.
CalibratedPressureSensor Compose(const CalibratedPressureSensor& before,
                                 const CalibratedPressureSensor& found);

/// The keys of an item of `pressure_sensors`.
const KeyTable& PressureSensorKeys();

/// Reads the map strictly; throws InputError with file:line:column.
CalibratedPressureSensor ReadPressureSensor(const ConfigNode& node);
/// As ReadPressureSensor reads it: the key `pressure_sensors`; nothing where there is none.
std::string FormatPressureSensors(const std::vector<CalibratedPressureSensor>& sensors);

/// kInvalidInput: a value that is not finite, a gain of -1 or less, a standard error below 0, a
/// sensor with neither zero nor gain.
Status CheckPressureSensor(const CalibratedPressureSensor& sensor);

}  // namespace palpate::robot

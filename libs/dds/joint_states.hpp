// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "libs/core/cable_reading.hpp"
#include "libs/core/status.hpp"
#include "sensor_msgs/msg/JointState.hpp"

namespace palpate::dds {

/// Inputs of the robot's actuators in the order of `names`: position is the displacement of a
/// cable, m, or the change of volume of a chamber, m3; effort is its tension, N, or pressure, Pa.
/// NaN and actuators that the message does not name count as not known. kInvalidInput, with the
/// reason, for a cable that is not among `names` (with "did you mean"), or numbers that do not go
/// with the names.
Status FromJointState(const idl::sensor_msgs::JointState& message,
                      const std::vector<std::string>& names, CableReading* reading);

}  // namespace palpate::dds

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace palpate {

/// What is known of each of the robot's actuators at one time. Of a chamber volume and pressure
/// stand for displacement and tension until robot::ToPistons.
struct CableReading {
  struct Inputs {
    std::optional<double> displacement_m;  ///< as the actuator reports it
    std::optional<double> tension_N;
  };
  std::int64_t stamp_ns = 0;
  std::vector<Inputs> cables;  ///< in the order of the robot's cables
};

}  // namespace palpate

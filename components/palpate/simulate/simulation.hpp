// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "components/palpate/simulate/simulated_bench.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::command {

/// What is simulated and where it goes.
struct SimulationJob {
  robot::RobotDescription robot;
  scenario::Scenario scenario;
  std::uint64_t seed = 0;
  std::filesystem::path out;      ///< experiment folder, not there yet
  std::filesystem::path answer;   ///< file, not there yet
  bool tell_camera_pose = false;  ///< write T_robot_camera (as planned) into experiment.yaml
};

struct SimulationCounts {
  int recordings = 0;
  int images = 0;
  int marker_frames = 0;
};

/// Called after each moment: how many of how many are done.
using ReportProgress = std::function<void(int done, int total)>;

/// Drives the bench along the scenario, one history through all recordings and the rests between,
/// and writes the experiment folder (ARCHITECTURE, "Measured data") and the sealed answer. Both
/// appear when all is done; a failure leaves neither. Throws InputError where out or answer is
/// there already, or the scenario does not fit the robot or measures nothing; RunError where the
/// bench does not converge or something cannot be written.
SimulationCounts Simulate(const SimulationJob& job, const MakeBench& make_bench,
                          const ReportProgress& report);

}  // namespace palpate::command

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
  std::filesystem::path out;      ///< experiment folder; must not exist
  std::filesystem::path answer;   ///< file; must not exist
  bool tell_camera_pose = false;  ///< write the nominal T_robot_camera into experiment.yaml
};

struct SimulationCounts {
  int recordings = 0;
  int images = 0;
  int marker_frames = 0;
};

/// Called after each sample: how many of how many are done.
using ReportProgress = std::function<void(int done, int total)>;

/// Simulates the scenario as one history through all recordings and the pauses between them, and
/// writes the experiment folder (docs/experiment.md) and the answer. Both appear when all is done;
/// a failure leaves neither. Throws InputError where `out` or `answer` exists, or the scenario does
/// not fit the robot or measures nothing; RunError where the simulation does not converge or a file
/// cannot be written.
SimulationCounts Simulate(const SimulationJob& job, const MakeBench& make_bench,
                          const ReportProgress& report);

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/experiment/recording.hpp"
#include "libs/rgbd/rgbd_frame.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/random.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::command {

/// Collects the measurements of one recording and writes its folder; images at once. Every function
/// throws RunError where a file cannot be written.
class RecordingWriter {
 public:
  RecordingWriter(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
                  const scenario::RecordingPlan& plan, std::filesystem::path folder);

  /// Readings of the actuators in the order of the robot's cables; NaN: not actuated.
  void AddCables(double t_s, const std::vector<virtual_robot::CableReading>& readings);
  /// [3 x markers] m, in the measurement frame without noise, which is added here; NaN: not seen.
  void AddMarkers(double t_s, const Eigen::Matrix3Xd& positions_m, scenario::Random* noise);
  /// Of the camera of this number; 0: the first. `frame` has the time of the bench as its stamp.
  void AddImage(std::size_t camera, const rgbd::RgbdFrame& frame);

  /// `begin_s`: of the recording, on the clock of the experiment.
  void Finish(double begin_s);

 private:
  struct CameraFolder {
    std::filesystem::path folder;
    std::int64_t clock_offset_ns = 0;
  };

  experiment::Recording recording_;
  const robot::RobotDescription& robot_;
  const scenario::Scenario& scenario_;
  const scenario::RecordingPlan& plan_;
  std::filesystem::path folder_;
  experiment::Actuation actuation_;
  experiment::MarkerTracks markers_;
  std::vector<CameraFolder> cameras_;  ///< by number
};

/// loads.csv of the planned weights: nominal weight, in the robot frame, which turns with the base.
std::vector<experiment::KnownLoad> DeclaredLoads(const scenario::RecordingPlan& plan,
                                                 const Eigen::Vector3d& gravity_m_s2,
                                                 double begin_s);

}  // namespace palpate::command

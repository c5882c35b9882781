// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "components/view/experiment/estimated_forces.hpp"
#include "components/view/robot/known_robot.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::view {

/// A sample of an experiment.
struct ExperimentInstant {
  std::size_t recording = 0;  ///< index in Experiment::recordings
  double t_s = 0.0;           ///< on the clock of the experiment
  double position_s = 0.0;    ///< since the first sample, without the pauses between recordings
};

/// What was measured at one instant, and where the model is under the same commands and forces.
struct ExperimentFrame {
  /// Of the model's equilibrium. Without it `x_m` is the last shape, and the model's cables,
  /// markers and residual are NaN.
  Status status;
  Eigen::VectorXd x_m;                                    ///< [3n]
  std::vector<robot::ActuatorState> cables;               ///< of the model, by cable of the robot
  std::vector<std::optional<double>> measured_tension_N;  ///< by cable
  Eigen::Matrix3Xd measured_m;                ///< [3 x markers] robot frame; NaN: not seen
  Eigen::Matrix3Xd model_m;                   ///< [3 x markers]
  int seen = 0;                               ///< markers
  double residual_rms_m = 0.0;                ///< per coordinate, of the seen markers; NaN: none
  double noise_rms_m = 0.0;                   ///< the same as the noise has it; NaN: not stated
  std::vector<ShownForce> known;              ///< loads.csv
  const EstimatedFrame* estimated = nullptr;  ///< forces.csv; null: none
};

/// The recordings of an experiment one after the other, each sample beside the model's equilibrium
/// under its commands, its known loads and, where they are given, the estimated forces.
class ExperimentFrames {
 public:
  /// All must outlive this. Throws InputError where no recording has markers, images, clouds or
  /// commands, names do not fit the robot, or a pose is missing.
  ExperimentFrames(const experiment::Experiment& experiment, KnownRobot& robot,
                   const EstimatedForces* estimated);

  const std::vector<ExperimentInstant>& instants() const { return instants_; }
  double duration_s() const { return instants_.back().position_s; }
  const experiment::Recording& RecordingOf(const ExperimentInstant& instant) const {
    return experiment_.recordings[instant.recording];
  }
  /// Of the markers, by axis of the robot; nullopt: not stated.
  std::optional<Eigen::Vector3d> sigma_m(const ExperimentInstant& instant) const;

  ExperimentFrame FrameAt(const ExperimentInstant& instant);

 private:
  void AddInstants();
  std::vector<robot::ActuatorCommand> CommandsAt(const ExperimentInstant& instant) const;
  std::vector<robot::DeadLoad> LoadsAt(const ExperimentInstant& instant, ExperimentFrame* frame);
  void EnterRecording(const ExperimentInstant& instant);
  void AddMarkers(const ExperimentInstant& instant, ExperimentFrame* frame) const;
  Status FindOffsets(const ExperimentInstant& instant);

  const experiment::Experiment& experiment_;
  KnownRobot& robot_;
  const EstimatedForces* estimated_;
  Eigen::Vector3d gravity_m_s2_;
  std::vector<ExperimentInstant> instants_;
  std::optional<std::size_t> entered_;  ///< the recording whose gravity and offsets are set
  Eigen::Isometry3d T_robot_markers_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix3Xd offsets_m_;  ///< [3 x markers] added to what was measured
  fem::StaticState state_;
};

}  // namespace palpate::view

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "components/diagnosis/forward/kept_stress.hpp"
#include "libs/core/status.hpp"
#include "libs/fem/load_state.hpp"
#include "libs/robot/robot_model.hpp"
#include "libs/robot/sensitivity/eyelet_slides.hpp"

namespace palpate::diagnosis {

/// A shape of the body and what holds it.
struct HeldShape {
  /// A cable that pulls by no more holds nothing.
  static constexpr double kNothing_N = 1e-6;
  double share = 1.0;    ///< of a sample's frames that it stands for
  std::size_t part = 0;  ///< of its parts, in which it is
  fem::StaticState state;
  std::vector<robot::ActuatorCommand> commands;
  /// [nodes of ObstacleSurface] with which the hypothesis's obstacle presses on the body; empty:
  /// nowhere.
  Eigen::VectorXd obstacle_force_N;
  Eigen::VectorXd seen_m;  ///< [coordinates] as SimulatedSample::seen_m

  bool AtObstacle() const { return obstacle_force_N.size() > 0; }
};

/// What the past leaves for a sample: the body answers 1 + scale times as stiff, keeps stresses,
/// and its elements are softened.
struct HistoryVariables {
  double scale = 0.0;
  PointStresses stress_Pa;      ///< or empty: none
  Eigen::VectorXd cell_factor;  ///< [elements] of the moduli, or empty: 1
};

/// What the history variables are computed from, at one sample.
struct HistoryInput {
  PointStresses elastic_Pa;     ///< without the kept stresses
  Eigen::VectorXf energy_J_m3;  ///< [elements] of the undamaged material
};

/// One sample of a simulated experiment.
struct SimulatedSample {
  Status status;
  HeldShape middle;
  /// In a motion: one shape for each other set of cables that are taut in parts of it.
  std::vector<HeldShape> beside;
  std::size_t parts = 0;     ///< that these were chosen among; 0: not simulated yet
  int choices = 0;           ///< how often they were chosen
  bool turns_round = false;  ///< its parts differ in what slides, and each was simulated
  HistoryInput in_the_middle;
  /// In order of time, of robots with eyelets that rub: about the middle, or of all parts where it
  /// turns_round. Empty: not known.
  std::vector<robot::EyeletSlides> slides;
  /// Where its piece begins and where that ends; empty, where another sample is nearer to there, or
  /// it is no other than in the middle.
  std::array<HistoryInput, 2> at_ends;
  /// [coordinates] mean over the sample: x, y, z of each marker, measurement frame, then each
  /// feature of the surface along its normal (SurfaceMeasurement::measured_m); NaN: not known, or
  /// not measured.
  Eigen::VectorXd seen_m;
  Eigen::Index markers = 0;
  Eigen::VectorXd bend_m;      ///< [coordinates] by which that mean is not where the middle is
  bool bend_is_own = true;     ///< and not that of another robot
  Eigen::MatrixXd jacobian_m;  ///< [coordinates x parameters] of them; 0: not measured

  /// [3 x markers] of seen_m.
  Eigen::Map<const Eigen::Matrix3Xd> markers_m() const { return {seen_m.data(), 3, markers}; }
};

/// A simulated experiment.
struct Simulation {
  Status status;  ///< of the first sample that failed
  std::vector<SimulatedSample> samples;
  HistoryInput at_rest;                ///< with every command at zero, as between recordings
  HeldShape resting;                   ///< in which that is
  Eigen::MatrixXf below_largest_J_m3;  ///< BelowLargest_J_m3 (history.hpp)
  std::vector<HistoryVariables> history_variables;  ///< [samples] with which they are in balance
};

/// What a column of HistoryOperator stands for.
const HistoryInput& HistoryInputOf(const Simulation& simulation, Eigen::Index column);

/// Adds the elastic stresses of all samples of HistoryOperator, each so often: `weights` [columns
/// of it], of which those that matter nowhere are left out.
void AddHistoryStress(const Simulation& simulation, const Eigen::VectorXd& weights,
                      PointStresses* stress_Pa);

}  // namespace palpate::diagnosis

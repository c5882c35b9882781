// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/marker_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Markers [3m] of the model in a reference shape, robot frame, m: of the undeformed body, or of
/// the equilibrium under gravity and `cables`. Not ok, and `positions_m` unchanged, where that
/// equilibrium is not found. `shape` must not be kNone.
Status ReferenceMarkers(robot::RobotModel& model, ReferenceShape shape,
                        const std::vector<robot::ActuatorCommand>& cables,
                        Eigen::VectorXd* positions_m);

/// Markers at rest as they were measured and as the model has them, column k the same marker.
struct RestMarkers {
  std::vector<std::string> names;
  Eigen::Matrix3Xd measured_m;  ///< [3 x n] in what is taken for the robot frame
  Eigen::Matrix3Xd model_m;     ///< [3 x n] robot frame
};

/// What must agree.
enum class RestAgreement {
  kShape,             ///< distances between the markers only: the pose is free
  kShapeAndTurn,      ///< and their orientation: displacements count, from a reference window
  kShapeTurnAndPlace  ///< and where they are: positions count
};

/// Distances in units of the robot at hand: `spread` is the RMS distance of the model's markers
/// from their mean.
struct RestMarkersTuning {
  /// Residual of the rigid fit, in spreads, from which the shape is another. Smaller: also markers
  /// that sit elsewhere than the robot file says are refused. Larger: labels of near markers that
  /// are exchanged pass.
  double largest_residual = 0.2;
  /// Residual, in spreads, from which a pair of labels is tried the other way round.
  double suspicious_residual = 0.05;
  /// Share of the residual that is left where labels are exchanged.
  double exchanged_residual = 0.3;
  /// Share of the residual below which an exchange of two labels counts as a step towards the right
  /// order. Smaller: cycles of several labels are not found. Larger: labels of near markers change
  /// for the noise.
  double least_gain = 0.95;
  /// Largest turn, rad: 15 degrees, which make a quarter of a displacement point elsewhere. It must
  /// also exceed four standard errors.
  double largest_turn_rad = 0.26;
  double turn_sigmas = 4.0;
  /// Largest shift of the markers' mean, in spreads.
  double largest_shift = 1.0;
};

/// Labels that lie where the robot has other markers.
struct ExchangedLabels {
  /// Label in the data, and the marker of the robot that is there; two or more.
  std::vector<std::pair<std::string, std::string>> pairs;
  double rms_m = 0.0;            ///< of the best rigid motion onto the robot's markers
  double rms_exchanged_m = 0.0;  ///< the same with the right labels
};

/// The labels whose exchange leaves a small share of the residual; nullopt where the markers fit as
/// they are, where none does, or where they are too few or too near a line to tell.
std::optional<ExchangedLabels> FindExchangedLabels(const RestMarkers& markers,
                                                   const RestMarkersTuning& tuning = {});

/// The labels by name, what fits, and how they are exchanged.
std::string ToText(const ExchangedLabels& exchange);

/// kOk where the markers agree, or are too few or too near a line to tell. kInvalidInput with what
/// differs, how far, and the likely cause: two labels exchanged, another unit, another frame, or
/// another robot.
Status CheckRestMarkers(const RestMarkers& markers, RestAgreement agreement,
                        const RestMarkersTuning& tuning = {});

}  // namespace palpate::force_estimation

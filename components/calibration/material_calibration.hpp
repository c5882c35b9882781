// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Shape of the body from which the displacements of an observation are counted.
enum class ReferenceShape {
  kNone,         ///< none: marker rest positions are those of the robot file
  kUndeformed,   ///< the body was held in its undeformed shape
  kEquilibrium,  ///< at rest under its own weight and the observation's cables, no load
};

/// One static phase with known loads.
struct StaticObservation {
  std::string name;             ///< for messages
  Eigen::VectorXd position_m;   ///< [3m] mean marker positions, robot frame
  Eigen::VectorXd variance_m2;  ///< [3m] of them; <= 0: marker not seen
  ReferenceShape reference = ReferenceShape::kNone;
  Eigen::VectorXd reference_position_m;  ///< [3m] where there is a reference shape
  std::vector<robot::CableCommand> cables;
  std::vector<robot::DeadLoad> loads;
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
};

struct MaterialCalibrationSettings {
  /// Materials to fit: RobotBody::materials, 0 the body, k + 1 region k. The others stay.
  std::vector<int> materials = {0};
  int max_iterations = 50;
  double tolerance = 1e-7;  ///< largest change of any ln E at which the fit stops
  /// ln E known no better than this (one sigma) counts as not determined by the data.
  double undetermined_sigma = 0.5;
};

struct FittedModulus {
  int material = 0;
  double youngs_modulus_Pa = 0.0;
  double standard_error_Pa = 0.0;
};

struct MaterialCalibration {
  Status status;
  std::vector<FittedModulus> moduli;
  Eigen::MatrixXd correlation;  ///< [p x p] of the fitted ln E
  double residual_rms_m = 0.0;
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;
  int iterations = 0;
  std::vector<double> residual_rms_of_observation_m;
};

/// Fits Young's moduli to static observations by Gauss-Newton on ln E with analytic sensitivities
/// (all equilibria to the static solver's tolerance). Standard errors come from the variances,
/// widened where the residual exceeds them. The model is left with the fitted moduli where the fit
/// succeeds, and as it was where it fails: kUnobservable names the modulus that the data do not
/// determine (for instance E under displacement-controlled cables without a known force).
/// The moduli hold for this mesh and element only.
MaterialCalibration CalibrateMaterial(robot::RobotModel& model,
                                      const std::vector<StaticObservation>& observations,
                                      const MaterialCalibrationSettings& settings);

}  // namespace palpate::calibration

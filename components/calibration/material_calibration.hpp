// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::calibration {

/// Reference shape of an observation's displacements.
enum class ReferenceShape {
  kNone,         ///< none: marker positions of the undeformed body are those of the robot file
  kUndeformed,   ///< the undeformed body
  kEquilibrium,  ///< equilibrium under its weight and the observation's cables, without loads
};

/// One static phase with known loads.
struct StaticObservation {
  std::string name;             ///< for messages
  Eigen::VectorXd position_m;   ///< [3m] mean marker positions, robot frame
  Eigen::VectorXd variance_m2;  ///< [3m] of these means; <= 0: not observed
  ReferenceShape reference = ReferenceShape::kNone;
  Eigen::VectorXd reference_position_m;  ///< [3m] in the reference shape; kNone: empty
  std::vector<robot::ActuatorCommand> cables;
  std::vector<robot::DeadLoad> loads;
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
};

struct MaterialCalibrationSettings {
  /// Materials whose modulus is estimated: RobotBody::materials, 0 the body, k + 1 region k.
  std::vector<int> materials = {0};
  int max_iterations = 50;
  double tolerance = 1e-7;  ///< converged where no ln E changes by more
  /// ln E with a larger standard deviation is not determined by the data.
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

/// Fits Young's moduli to static observations by Gauss-Newton on ln E with exact sensitivities; all
/// equilibria are solved to the static solver's tolerance. Standard errors follow from the
/// variances and carry Birge's ratio. On success the model has the fitted moduli, on failure those
/// of before. kUnobservable names the modulus that the data do not determine (such as E under
/// displacement control without a known force); kNotConverged: no smaller residual, or
/// max_iterations. The moduli hold for this mesh and element only.
MaterialCalibration CalibrateMaterial(robot::RobotModel& model,
                                      const std::vector<StaticObservation>& observations,
                                      const MaterialCalibrationSettings& settings);

}  // namespace palpate::calibration

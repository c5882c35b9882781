// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/actuator_chain.hpp"
#include "components/diagnosis/forward/camera_view.hpp"
#include "components/diagnosis/forward/mesh_error.hpp"
#include "components/diagnosis/forward/obstacle.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// A Prony term: the instantaneous modulus is (1 + g) times the long-term one.
struct CreepTerm {
  double g = 0.0;
  double tau_s = 1.0;
};

/// Softening of a body that was strained before, eta = 1 - erf((W_max - W) / m) / r (R. W. Ogden
/// and D. G. Roxburgh, A pseudo-elastic model for the Mullins effect, Proc. R. Soc. A 455, 1999).
struct MullinsSoftening {
  double inverse_r = 0.0;
  double m_J_m3 = 1.0;
};

/// A mass that sits on the body.
struct CarriedMass {
  fem::InterpolationWeights weights;
  double mass_kg = 0.0;
};

/// A force on the body, fixed in the world, where an untilted base stands as the robot frame.
struct WorldForce {
  fem::InterpolationWeights weights;
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
};

/// Everything that a robot's simulation in an experiment is made of. It begins as the robot file
/// has it (NominalHypothesis), and faults change it.
struct ModelHypothesis {
  explicit ModelHypothesis(const robot::RobotBody& of)
      : body(of), actuators(static_cast<int>(of.cables.size() + of.chambers.size())) {}

  robot::RobotBody body;
  /// The robot file's body, on which places are named: where the body is of another shape, what
  /// hangs on it keeps its weights, as markers and eyelets do.
  std::shared_ptr<const fem::PointLocator> places;
  /// [3n] the shape at which the actuators were zeroed; that of the body unless something was bent
  /// afterwards.
  Eigen::VectorXd assembled_m;
  ActuatorSettings actuators;
  Eigen::VectorXd cable_compliance_m_N;  ///< [cables] stretch per tension at the actuator; < 0:
                                         ///< less than the mesh yields by
  /// The base stands askew by so much beside what is known of its tilt: gravity in the robot frame
  /// is (R_tilt R_tilt_error)' g.
  Eigen::Matrix3d R_tilt_error = Eigen::Matrix3d::Identity();
  std::vector<CarriedMass> masses;
  std::vector<WorldForce> forces;
  double base_compliance_rad_Nm = 0.0;
  double modulus_change_at_end = 0.0;  ///< grows linearly with time
  std::vector<CreepTerm> creep;
  std::optional<MullinsSoftening> mullins;
  std::optional<Obstacle> obstacle;             ///< rides with the base
  std::shared_ptr<const MeshError> mesh_error;  ///< or nothing
  double mesh_error_share = 0.0;                ///< so much of it is added to what is seen
  Eigen::Matrix3Xd marker_offset_m;             ///< [3 x markers] through the undeformed body
  /// [recordings] how what is seen lies to the robot frame: p_seen = T_seen p_robot, before
  /// T_measurement_robot.
  std::vector<Eigen::Isometry3d> T_seen;
  /// [recordings] the same of what depth frames show, before T_camera_robot.
  std::vector<Eigen::Isometry3d> T_surface_seen;
  Eigen::VectorXd surface_offset_m;  ///< [features] by which the surface is seen beyond the body's
  CameraErrors camera;               ///< of the depth camera, in recordings that one saw
};

/// The robot file's.
ModelHypothesis NominalHypothesis(const robot::RobotBody& body, const ObservedExperiment& observed);

/// Known loads this much along what gravity was assumed to be (cosine; a degree) are weights.
inline constexpr double kHangs = 0.99985;

/// Gravity in the robot frame of a recording, m/s^2.
Eigen::Vector3d GravityIn(const ModelHypothesis& hypothesis, const ObservedRecording& recording);

/// The middle of the held nodes, about which a compliant base turns and the body grows, m.
Eigen::Vector3d MiddleOfBase(const robot::RobotBody& body);

}  // namespace palpate::diagnosis

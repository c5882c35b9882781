// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/fem/static_solver.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/robot/actuator.hpp"
#include "libs/robot/cable.hpp"
#include "libs/robot/chamber.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::robot {

/// Boundary condition of one actuator, a cable or a chamber (actuator.hpp).
struct ActuatorCommand {
  enum class Kind {
    kNone,  ///< free: no tension; a chamber is open to the air
    /// m pulled in, counted from the undeformed body; the cable may be slack. Of a chamber its
    /// change of volume over the area of its piston.
    kDisplacement,
    kTension,  ///< N, >= 0; of a chamber its pressure above ambient times that area, of either sign
  };
  Kind kind = Kind::kNone;
  double value = 0.0;

  bool operator==(const ActuatorCommand&) const = default;
};

/// Which input of an actuator is imposed where both its displacement and its tension are known.
enum class CableInput { kDisplacement, kTension };

/// The command for what is known of one actuator; kNone where nothing is.
ActuatorCommand ChooseCommand(std::optional<double> displacement_m, std::optional<double> tension_N,
                              CableInput preferred);

/// The same for what the actuator reports (ActuatorTraits).
ActuatorCommand ChooseCommand(const ActuatorTraits& traits, std::optional<double> displacement,
                              std::optional<double> force, CableInput preferred);

/// Errors of an actuator: it pulls in (1 + gain) u + offset_m where it reports the displacement u.
struct DriveCalibration {
  double offset_m = 0.0;
  double gain = 0.0;

  double TakenIn_m(double displacement_m) const { return (1.0 + gain) * displacement_m + offset_m; }
};

/// What one actuator does in a state, as the piston that stands for it where it is a chamber
/// (ActuatorTraits converts).
struct ActuatorState {
  double length_m = 0.0;        ///< Actuator::Value
  double displacement_m = 0.0;  ///< of the body: rest length - length; slack: more than commanded
  double tension_N = 0.0;
};

/// A dead load on the body: the same in size and direction however the body moves.
struct DeadLoad {
  fem::InterpolationWeights weights;
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
};

/// What softens a material for good (fem/mullins.hpp), until another robot takes its place.
struct StrainHistory {
  double t_s = -std::numeric_limits<double>::infinity();  ///< of the last posture, s
  Eigen::VectorXd
      largest_J_m3;  ///< [elements] largest energy density so far; empty: never strained
};

/// A robot to compute with: body, cables, chambers and solvers, put together from a RobotBody.
/// Static equilibria of the paper's eq. (1). Not copied or moved: its parts point at each other.
class RobotModel {
 public:
  /// Constraints are the cables, then the chambers, then `further`, which must outlive it; Loads
  /// leaves these off.
  explicit RobotModel(RobotBody body, const fem::StaticSettings& settings = {},
                      const fem::SolverSettings& solver = {},
                      const std::vector<fem::ScalarConstraint*>& further = {});
  RobotModel(const RobotModel&) = delete;
  RobotModel& operator=(const RobotModel&) = delete;

  const RobotBody& body() const { return body_; }
  fem::ElasticBody& elastic_body() { return elastic_body_; }
  fem::Linearisation& linearisation() { return linearisation_; }
  fem::StaticSolver& static_solver() { return static_solver_; }
  int CableCount() const { return static_cast<int>(cables_.size()); }
  const Cable& cable(int index) const { return cables_[At(index)]; }
  int ChamberCount() const { return static_cast<int>(chambers_.size()); }
  const Chamber& chamber(int index) const { return chambers_[At(index)]; }
  /// Cables, then chambers.
  int ActuatorCount() const { return static_cast<int>(traits_.size()); }
  const Actuator& actuator(int index) const;
  const ActuatorTraits& traits(int actuator) const { return traits_[At(actuator)]; }
  const std::vector<ActuatorTraits>& traits() const { return traits_; }
  const Eigen::VectorXd& actuator_rest_m() const { return actuator_rest_m_; }  ///< [a]

  std::vector<std::string> ActuatorNames() const;
  std::vector<std::string> CableNames() const;
  std::vector<std::string> ChamberNames() const;
  std::vector<std::string> MarkerNames() const;
  /// A patch of the surface for loads and contacts (fem/surface_patch.hpp).
  fem::SurfacePatch Patch(const Eigen::Vector3d& position_m, double radius_m) const;

  /// Moduli of body (0) and regions (k + 1); see RobotBody::materials.
  void SetYoungsModulus(int material, double youngs_modulus_Pa);
  void SetPoissonsRatio(int material, double poissons_ratio);
  /// Friction of a cable in its eyelets (cable_friction.hpp); at first the robot file's, sliding in
  /// all of them. The static solver then takes more steps. The caller decides which eyelets stick
  /// or slide after a load history.
  void SetCableFriction(int cable, const CableFriction& friction) {
    cables_.at(At(cable)).SetFriction(friction);
  }
  /// Cable::compliance_m_N, which equilibria and their sensitivities know; Compliance (eq. 5) has
  /// cables that do not stretch.
  void SetCableCompliance(int cable, double compliance_m_N) {
    cables_.at(At(cable)).SetCompliance(compliance_m_N);
  }
  /// The point fixed to the ground that a cable is pulled from; at first the robot file's. Its rest
  /// length and displacements count from the undeformed body with the point there.
  void SetPullPoint(int cable, const Eigen::Vector3d& pull_point_m);
  /// Moves an eyelet (0: next to the actuator) by `moved_m` from its place in the robot file, for a
  /// robot of scale 1; body() has it there. Displacements count as with SetPullPoint. Returns
  /// kInvalidInput and moves nothing where the body has no room for it (GiveEyeletsRoom).
  Status MoveEyelet(int cable, int eyelet, const Eigen::Vector3d& moved_m);
  const fem::PointLocator& locator() const { return locator_; }
  /// Offset and gain by which measured displacements of an actuator are corrected; at first none.
  void SetDrive(int cable, const DriveCalibration& drive) { drives_.at(At(cable)) = drive; }
  const std::vector<DriveCalibration>& drives() const { return drives_; }  ///< [actuators]
  /// The command for what is measured of an actuator (ChooseCommand), in what it reports: m and N
  /// of a cable, change of volume m3 and pressure Pa of a chamber. The displacement is corrected by
  /// its drive's offset and gain.
  ActuatorCommand CommandFor(int actuator, std::optional<double> displacement,
                             std::optional<double> force, CableInput preferred) const;

  /// Gravity in the robot frame; at first the robot file's.
  void SetGravity(const Eigen::Vector3d& gravity_m_s2) { gravity_m_s2_ = gravity_m_s2; }
  const Eigen::Vector3d& gravity_m_s2() const { return gravity_m_s2_; }

  /// A nodal dead load [3n], N, that goes with the weight from now on: of the history variables
  /// (history_state.hpp). Empty: none.
  void SetHistoryForce(Eigen::VectorXd force_N) { history_force_N_ = std::move(force_N); }

  /// Outlives the HistoryState that follows it: a sequence of frames begins where the last ended.
  StrainHistory& strain_history() { return strain_history_; }

  /// Adds each node's weight, and the history force, to `force_N` [3n].
  void AddWeight(Eigen::VectorXd& force_N) const;
  /// Loads of weight, actuators and `loads` for the static solver. Checks the number of commands.
  fem::LoadState Loads(const std::vector<ActuatorCommand>& cables,
                       const std::vector<DeadLoad>& loads) const;
  fem::ConstraintCommand ToConstraint(int actuator, const ActuatorCommand& command) const;

  fem::StaticState RestState() const { return static_solver_.RestState(); }
  /// The balance of weight, actuators and loads, reached from `state` on. Failures name the
  /// actuator.
  fem::StaticResult Solve(const std::vector<ActuatorCommand>& cables,
                          const std::vector<DeadLoad>& loads, fem::StaticState* state);

  ActuatorState StateOfActuator(int actuator, const fem::StaticState& state) const;

 private:
  Status CheckForces(const std::vector<ActuatorCommand>& commands) const;
  std::vector<fem::ScalarConstraint*> Constraints(
      const std::vector<fem::ScalarConstraint*>& further);

  RobotBody body_;
  fem::PointLocator locator_;
  fem::ElasticBody elastic_body_;
  std::vector<Cable> cables_;
  std::vector<Chamber> chambers_;
  std::vector<ActuatorTraits> traits_;
  fem::Linearisation linearisation_;
  fem::StaticSolver static_solver_;
  Eigen::VectorXd actuator_rest_m_;
  Eigen::Vector3d gravity_m_s2_;
  std::vector<DriveCalibration> drives_;  ///< [actuators]
  Eigen::VectorXd history_force_N_;       ///< [3n], or empty
  StrainHistory strain_history_;
};

}  // namespace palpate::robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

#include "libs/fem/embedding.hpp"
#include "libs/robot/sensitivity/parameter.hpp"

/// The parameters there are, one function each; their sources lie in parameters/. Derivatives are
/// taken at the model as it is. SI units; robot frame. Indices count as in RobotBody; one out of
/// range, or a nodal vector of another size, is a broken promise.
namespace palpate::robot {

/// Which undeformed shape a displacement command counts from where a parameter changes that shape.
enum class CableZero {
  kOfChangedShape,  ///< the changed one: the actuator was zeroed on the robot as it is
  kKept,            ///< the model's: the change came after the actuator was zeroed
};

/// What becomes of the nodal masses where a parameter changes the rest shape.
enum class MassRule {
  kNodalKept,    ///< each node keeps its own
  kDensityKept,  ///< they follow the volume; for mass by volume
  kTotalKept,    ///< they follow their share of the volume; for mass by volume
};

/// What turns and moves along with the base.
enum class BaseRiders {
  kHeldNodes,               ///< the clamp slips against the ground and the actuators
  kHeldNodesAndPullPoints,  ///< clamp and actuators are on one plate, which moves
};

/// Young's modulus of a material (RobotBody::materials), Pa.
ParameterPtr YoungsModulus(int material);
/// Poisson's ratio of a material, at fixed Young's modulus.
ParameterPtr PoissonsRatio(int material);

/// Factor on all nodal masses (now 1). Of the density rho: divide by rho for per kg/m3.
ParameterPtr MassFactor();
/// Factor on the density of one material's elements (now 1), where mass is by volume: of a uniform
/// density, the one that gives the model's total mass.
ParameterPtr RegionMassFactor(int material);

/// Change of gravity by so many times `change_m_s2`.
ParameterPtr GravityChange(const Eigen::Vector3d& change_m_s2);
/// Angle, rad, by which gravity turns about `axis` (unit); dead loads keep their direction.
ParameterPtr GravityTurn(const Eigen::Vector3d& axis);

/// o, m: the actuator takes in u + o where u is commanded. Of no effect where a tension is
/// commanded.
ParameterPtr CableOffset(int cable);
/// g: the actuator takes in (1 + g) u + o; `gain` and `offset_m` are the present g and o, which the
/// command of the cable (1 + g) u + o already holds. Of no effect where a tension is commanded.
ParameterPtr CableGain(int cable, double gain = 0.0, double offset_m = 0.0);
/// The same of an actuator under force control: it pulls with (1 + g) T + o where T is commanded, g
/// and o (N) now `gain` and `offset_N`. Of no effect where a displacement is commanded. At 0 N the
/// derivative towards a pull.
ParameterPtr TensionOffset(int cable);
ParameterPtr TensionGain(int cable, double gain = 0.0, double offset_N = 0.0);
/// G: the actuator of `driven` takes in u + G times what cable `by` is commanded. Acts where both
/// are commanded a displacement.
ParameterPtr DriveCoupling(int driven, int by);
/// m/N, at 0: the cable's stretch per tension at the actuator, which lets out so much of it. Acts
/// where displacement is commanded.
ParameterPtr CableCompliance(int cable);
/// mu of a cable's capstan friction (cable_friction.hpp) with each eyelet sliding as it is; exact
/// at every mu. Nothing where the cable is slack.
ParameterPtr CableFrictionCoefficient(int cable);
/// mu s at one of its eyelets (0: next to the actuator), CableFriction::Signed.
ParameterPtr CableFrictionAt(int cable, int eyelet);

/// Distance, m, by which the pull point moves along `direction` (unit).
ParameterPtr PullPointMove(int cable, const Eigen::Vector3d& direction,
                           CableZero zero = CableZero::kOfChangedShape);
/// Distance, m, by which an eyelet (0: next to the actuator) moves through the undeformed body
/// along `direction`. `weights_along`: the derivative of its weights (eyelet_gradient.hpp).
ParameterPtr EyeletMove(int cable, int eyelet, fem::InterpolationWeights weights_along,
                        CableZero zero = CableZero::kOfChangedShape);

/// Angle, rad, by which the base turns about `axis` (unit) through `pivot_m`: the held nodes are
/// moved along, in their held directions. Gravity, dead loads and the robot frame stay, and so does
/// what displacement commands count from. (The whole robot tilted is GravityTurn the other way.)
ParameterPtr BaseRotation(const Eigen::Vector3d& axis, const Eigen::Vector3d& pivot_m,
                          BaseRiders riders = BaseRiders::kHeldNodes);
/// Distance, m, by which the base moves along `direction` (unit).
ParameterPtr BaseTranslation(const Eigen::Vector3d& direction,
                             BaseRiders riders = BaseRiders::kHeldNodes);
/// The base on a spring of six degrees of freedom. The model's base is rigid, so that the parameter
/// is a factor c on the compliance (inverse stiffness) `compliance` [6 x 6], at c = 0; for a stiff
/// spring of stiffness k = 1/c, d/dk = -c^2 d/dc to first order in c. The base turns by (rows 0-2,
/// rad) and moves by (rows 3-5, m) `compliance` times the moment about `pivot_m` (columns 0-2, N m)
/// and the force (columns 3-5, N) with which the body, and the pull points where they ride, act on
/// it. A torsion spring that is equal about all axes: diag(1, 1, 1, 0, 0, 0), the parameter then in
/// rad/(N m).
ParameterPtr BaseCompliance(const Eigen::Matrix<double, 6, 6>& compliance,
                            const Eigen::Vector3d& pivot_m,
                            BaseRiders riders = BaseRiders::kHeldNodes);

/// Amplitude of a change of the rest shape by `mode_m` [3n]: X + p mode. Held nodes are held where
/// it takes them; pull points stay; points of the body keep their weights.
ParameterPtr RestShapeMode(Eigen::VectorXd mode_m, CableZero zero, MassRule mass);
/// Factor (now 1) on the size of the undeformed body about `centre_m`: a rest shape mode.
ParameterPtr GeometryScale(const Eigen::Vector3d& centre_m, CableZero zero, MassRule mass);

/// Dead load, N, along `direction` (unit) on a point or patch of the body.
ParameterPtr ExternalForce(fem::InterpolationWeights weights, const Eigen::Vector3d& direction);
/// Factor on dead nodal forces [3n].
ParameterPtr NodalForce(Eigen::VectorXd force_N);

}  // namespace palpate::robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>

#include "libs/fem/shape_functions.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/robot/sensitivity/eyelet_gradient.hpp"
#include "tests/libs/robot/sensitivity/robot_case.hpp"
#include "tests/support/robots.hpp"

namespace palpate::robot {
namespace {

const Eigen::Vector3d kDirection = Eigen::Vector3d(0.5, -0.3, 0.8).normalized();

/// The robot of config/robots/four_leg.yaml with its own mesh, a load on its tip and its four
/// cables under one kind of control or both.
class FourLegSensitivity : public testing::TestWithParam<CaseKind> {
 protected:
  static constexpr double kDensity_kg_m3 = 1070.0;

  FourLegSensitivity() {
    description_ = test_support::FourLegRobot();
    description_.element = GetParam().element;
    if (GetParam().element == fem::ElementType::kTet10) {
      description_.material.volumetric = fem::Volumetric::kMeanDilatation;
    }
    robot_.body = BuildRobotBody(description_);
    robot_.body.markers.resize(5);
    const auto displace = [](double value_m) {
      return ActuatorCommand{ActuatorCommand::Kind::kDisplacement, value_m};
    };
    const auto pull = [](double value_N) {
      return ActuatorCommand{ActuatorCommand::Kind::kTension, value_N};
    };
    robot_.cables = {displace(0.010), displace(0.009), displace(0.010), displace(0.011)};
    if (GetParam().control == Control::kTension) {
      robot_.cables = {pull(0.6), pull(0.3), pull(0.4), pull(0.5)};
    } else if (GetParam().control == Control::kMixed) {
      robot_.cables = {displace(0.006), pull(0.4), displace(-0.02), displace(0.005)};
    }
    robot_.loads = {{robot_.body.markers[0].point.weights, {0.05, 0.1, -0.05}}};
    robot_.held_motion_m = Eigen::VectorXd::Zero(3 * robot_.body.mesh.NodeCount());
    robot_.friction.resize(robot_.cables.size());
    robot_.compliance_m_N = Eigen::VectorXd::Zero(std::ssize(robot_.cables));
  }

  /// The robot with `change` made to it by so much.
  Change By(const std::function<void(RobotCase*, double)>& change) const {
    return [this, change](double by) {
      RobotCase robot = robot_;
      change(&robot, by);
      return robot;
    };
  }

  RobotDescription description_;
  RobotCase robot_;
};

TEST_P(FourLegSensitivity, Material) {
  ExpectDerivative(robot_, YoungsModulus(1), By([](RobotCase* robot, double by) {
                     robot->body.materials[1].youngs_modulus_Pa += by;
                   }),
                   500.0);
  ExpectDerivative(
      robot_, PoissonsRatio(0),
      By([](RobotCase* robot, double by) { robot->body.materials[0].poissons_ratio += by; }), 5e-4);
}

TEST_P(FourLegSensitivity, WeightAndForce) {
  ExpectDerivative(robot_, MassFactor(),
                   By([](RobotCase* robot, double by) { robot->body.node_mass_kg *= 1.0 + by; }),
                   1e-2);
  ExpectDerivative(robot_, GravityTurn(kDirection), By([](RobotCase* robot, double by) {
                     robot->body.gravity_m_s2 =
                         Eigen::AngleAxisd(by, kDirection) * robot->body.gravity_m_s2;
                   }),
                   1e-2);
  const fem::InterpolationWeights patch =
      Solve(robot_).model->Patch({0.021, 0.021, 0.1}, 0.008).weights;
  ExpectDerivative(robot_, ExternalForce(patch, kDirection), By([&](RobotCase* robot, double by) {
                     robot->loads.push_back({patch, by * kDirection});
                   }),
                   1e-2);
}

TEST_P(FourLegSensitivity, Drive) {
  const int cable = 1;
  const double command = robot_.cables[1].value;
  const bool pulled = robot_.cables[1].kind == ActuatorCommand::Kind::kTension;
  const auto taking = [&](double factor) {
    return By([=](RobotCase* robot, double by) { robot->cables[1].value += by * factor; });
  };
  ExpectDerivative(robot_, pulled ? TensionOffset(cable) : CableOffset(cable), taking(1.0),
                   pulled ? 5e-3 : 5e-5);
  ExpectDerivative(robot_, pulled ? TensionGain(cable) : CableGain(cable), taking(command), 1e-2);
}

TEST_P(FourLegSensitivity, Guides) {
  ExpectDerivative(robot_, PullPointMove(0, kDirection), By([](RobotCase* robot, double by) {
                     robot->body.cables[0].pull_point_m += by * kDirection;
                   }),
                   1e-4);
  const fem::PointLocator locator(robot_.body.mesh);
  const CableSettings& north = description_.cables[0];
  const Eigen::Vector3d knot_m = north.path_m.col(1);
  const fem::InterpolationWeights along =
      EyeletWeightsAlong(locator, knot_m, north.guide_radius_m, kDirection);
  ExpectDerivative(robot_, EyeletMove(0, 0, along), By([&](RobotCase* robot, double by) {
                     robot->body.cables[0].eyelets[0] =
                         locator.EmbedBall(knot_m + by * kDirection, north.guide_radius_m);
                   }),
                   2e-6);
}

TEST_P(FourLegSensitivity, Base) {
  const Eigen::Vector3d pivot_m(0.01, 0.02, -0.005);
  ExpectDerivative(robot_, BaseRotation(kDirection, pivot_m), By([&](RobotCase* robot, double by) {
                     const Eigen::Matrix3d turned =
                         Eigen::AngleAxisd(by, kDirection).toRotationMatrix();
                     const Eigen::Matrix3Xd& rest_m = robot->body.mesh.nodes_m;
                     for (Eigen::Index node = 0; node < rest_m.cols(); ++node) {
                       const Eigen::Vector3d arm_m = rest_m.col(node) - pivot_m;
                       robot->held_motion_m.segment<3>(3 * node) = turned * arm_m - arm_m;
                     }
                   }),
                   1e-3);
}

TEST_P(FourLegSensitivity, Size) {
  const Eigen::Vector3d centre_m(0.0, 0.0, 0.02);
  ExpectDerivative(robot_,
                   GeometryScale(centre_m, CableZero::kOfChangedShape, MassRule::kDensityKept),
                   By([&](RobotCase* robot, double by) {
                     Eigen::Matrix3Xd& nodes_m = robot->body.mesh.nodes_m;
                     nodes_m += by * (nodes_m.colwise() - centre_m);
                     robot->body.node_mass_kg = fem::ConsistentNodalMass_kg(
                         robot->body.mesh,
                         Eigen::VectorXd::Constant(robot->body.mesh.CellCount(), kDensity_kg_m3));
                   }),
                   2e-4);
}

INSTANTIATE_TEST_SUITE_P(Robots, FourLegSensitivity,
                         testing::Values(CaseKind{fem::ElementType::kTet4, Control::kDisplacement},
                                         CaseKind{fem::ElementType::kTet4, Control::kTension},
                                         CaseKind{fem::ElementType::kTet4, Control::kMixed},
                                         CaseKind{fem::ElementType::kTet10, Control::kMixed}));

}  // namespace
}  // namespace palpate::robot

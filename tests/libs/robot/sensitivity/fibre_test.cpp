// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>

#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

/// The soft beam with a fibre along it, off its axis, and one across. Their stiffness is no part of
/// the moduli.
class BeamWithFibres : public SensitivityCase {
 protected:
  BeamWithFibres() {
    const fem::PointLocator locator(robot_.body.mesh);
    Eigen::Matrix3Xd along_m(3, 2), across_m(3, 3);
    along_m << 0.0, 0.097, 0.0131, 0.0123, 0.0067, 0.0072;
    across_m << 0.041, 0.053, 0.044, 0.001, 0.011, 0.019, 0.003, 0.017, 0.011;
    for (const Eigen::Matrix3Xd& path_m : {along_m, across_m}) {
      BodyFibre fibre{.name = "fibre", .paths_m = {path_m}};
      fibre.embedded.axial_stiffness_N = 30.0;  // of E A = 26 N
      fem::AddPolyline(locator, path_m, &fibre.embedded);
      robot_.body.fibres.push_back(fibre);
    }
  }
};

TEST_P(BeamWithFibres, ElasticConstants) {
  for (const int material : {0, 1}) {
    const auto stiffer = [&](double by) {
      RobotCase robot = robot_;
      robot.body.materials[static_cast<size_t>(material)].youngs_modulus_Pa += by;
      return robot;
    };
    ExpectDerivative(robot_, YoungsModulus(material), stiffer, 100.0);
    const auto wider = [&](double by) {
      RobotCase robot = robot_;
      robot.body.materials[static_cast<size_t>(material)].poissons_ratio += by;
      return robot;
    };
    ExpectDerivative(robot_, PoissonsRatio(material), wider, 2e-4);
  }
}

/// Held nodes pull at the fibre that ends at them.
TEST_P(BeamWithFibres, RotationOfTheBase) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, 1.0, -0.6).normalized();
  const Eigen::Vector3d pivot_m(-0.004, 0.008, 0.012);
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    for (Eigen::Index node = 0; node < robot.body.mesh.nodes_m.cols(); ++node) {
      const Eigen::Vector3d arm_m = robot.body.mesh.nodes_m.col(node) - pivot_m;
      robot.held_motion_m.segment<3>(3 * node) = Eigen::AngleAxisd(by, axis) * arm_m - arm_m;
    }
    return robot;
  };
  ExpectDerivative(robot_, BaseRotation(axis, pivot_m, BaseRiders::kHeldNodes), changed, 5e-4);
}

/// The fibres are material lines: their lengths at rest change with the shape.
TEST_P(BeamWithFibres, RestShape) {
  Eigen::VectorXd mode(robot_.body.mesh.nodes_m.size());
  for (Eigen::Index node = 0; node < mode.size() / 3; ++node) {
    const Eigen::Vector3d X = robot_.body.mesh.nodes_m.col(node);
    mode.segment<3>(3 * node) = Eigen::Vector3d(0.3 * X.x() + 2.0 * X.y(), std::sin(20.0 * X.x()),
                                                0.5 + 500.0 * X.x() * X.y());
  }
  const auto changed = [&](double by) {
    RobotCase robot = robot_;
    robot.body.mesh.nodes_m.reshaped() += by * mode;
    return robot;
  };
  ExpectDerivative(robot_, RestShapeMode(mode, CableZero::kOfChangedShape, MassRule::kNodalKept),
                   changed, 2e-5);
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, BeamWithFibres, AllCases());

}  // namespace
}  // namespace palpate::robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/sensitivity/eyelet_gradient.hpp"
#include "tests/libs/robot/sensitivity/robot_case.hpp"

namespace palpate::robot {
namespace {

class Guide : public SensitivityCase {
 protected:
  /// What the drive takes in where it keeps the zero of the unchanged robot: its command counts
  /// from there, the model's from the changed robot.
  void KeepZero(int cable, RobotCase* changed) const {
    ActuatorCommand& command = changed->cables[static_cast<size_t>(cable)];
    if (command.kind != ActuatorCommand::Kind::kDisplacement) return;
    const auto c = static_cast<size_t>(cable);
    command.value += RestLength_m(changed->body, c) - RestLength_m(robot_.body, c);
  }

  const Eigen::Vector3d direction_ = Eigen::Vector3d(0.4, -0.7, 0.6).normalized();
};

TEST_P(Guide, PullPoint) {
  for (const int c : {0, 1}) {
    for (const CableZero zero : {CableZero::kOfChangedShape, CableZero::kKept}) {
      const auto changed = [&](double by) {
        RobotCase robot = robot_;
        robot.body.cables[static_cast<size_t>(c)].pull_point_m += by * direction_;
        if (zero == CableZero::kKept) KeepZero(c, &robot);
        return robot;
      };
      ExpectDerivative(robot_, PullPointMove(c, direction_, zero), changed, 2e-5);
    }
  }
}

TEST_P(Guide, Eyelet) {
  const fem::PointLocator locator(robot_.body.mesh);
  const GuidePlan guides = SoftBeamGuides();
  for (const auto& [c, e] : {std::pair{0, 0}, {0, 1}, {0, 2}, {1, 1}}) {
    const Eigen::Vector3d centre_m = guides.eyelets_m[static_cast<size_t>(c)].col(e);
    for (const CableZero zero : {CableZero::kOfChangedShape, CableZero::kKept}) {
      const auto changed = [&](double by) {
        RobotCase robot = robot_;
        robot.body.cables[static_cast<size_t>(c)].eyelets[static_cast<size_t>(e)] =
            locator.EmbedBall(centre_m + by * direction_, guides.radius_m);
        if (zero == CableZero::kKept) KeepZero(c, &robot);
        return robot;
      };
      ExpectDerivative(
          robot_,
          EyeletMove(c, e, EyeletWeightsAlong(locator, centre_m, guides.radius_m, direction_),
                     zero),
          changed, 2e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SoftBeam, Guide, AllCases());

/// All points about a cell: inside, and outside above a face, an edge and a corner.
TEST(EyeletWeights, AlongADirectionAreTheDerivativeOfTheEmbedding) {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, 0.5, -0.8).normalized();
  for (const fem::ElementType element : {fem::ElementType::kTet4, fem::ElementType::kTet10}) {
    const RobotCase robot = SoftBeam({element, Control::kTension});
    const fem::PointLocator locator(robot.body.mesh);
    for (const Eigen::Vector3d& point_m :
         {Eigen::Vector3d(0.041, 0.0073, 0.0118), Eigen::Vector3d(0.0417, 0.0061, 0.0216),
          Eigen::Vector3d(0.043, 0.0223, 0.0217), Eigen::Vector3d(0.1019, -0.0012, 0.0213),
          Eigen::Vector3d(0.0187, 0.0017, -0.0009)}) {
      for (const double radius_m : {0.0, 0.0011}) {
        const auto weights = [&](double by) {
          const fem::InterpolationWeights at =
              locator.EmbedBall(point_m + by * direction, radius_m).weights;
          Eigen::VectorXd dense = Eigen::VectorXd::Zero(robot.body.mesh.NodeCount());
          for (size_t k = 0; k < at.nodes.size(); ++k) dense[at.nodes[k]] += at.weights[k];
          return dense;
        };
        const fem::InterpolationWeights along =
            EyeletWeightsAlong(locator, point_m, radius_m, direction);
        Eigen::VectorXd dense = Eigen::VectorXd::Zero(robot.body.mesh.NodeCount());
        for (size_t k = 0; k < along.nodes.size(); ++k) dense[along.nodes[k]] += along.weights[k];
        const double step = 1e-7;
        const Eigen::VectorXd expected = (weights(step) - weights(-step)) / (2.0 * step);
        EXPECT_LE((dense - expected).norm(), 1e-7 * expected.norm())
            << point_m.transpose() << ", radius " << radius_m;
        EXPECT_NEAR(dense.sum(), 0.0, 1e-10);
      }
    }
  }
}

}  // namespace
}  // namespace palpate::robot

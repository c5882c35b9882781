// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/robot/known_robot.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "libs/core/statistics.hpp"
#include "tests/components/view/robot/cabled_beam.hpp"

namespace palpate::view {
namespace {

class ForceThatIsFelt : public testing::Test {
 protected:
  ForceThatIsFelt() : x_m_(robot_.model().RestState().x_m) {
    const Eigen::Vector3d high_m = robot_.body().mesh.nodes_m.rowwise().maxCoeff();
    const Eigen::Vector3d low_m = robot_.body().mesh.nodes_m.rowwise().minCoeff();
    place_.rest_m = 0.5 * (high_m + low_m);
    place_.rest_m.z() = high_m.z();
    place_.rest_m.x() = 0.25 * low_m.x() + 0.75 * high_m.x();
    place_.radius_m = 0.004;
    patch_ = robot_.model().Patch(place_.rest_m, place_.radius_m);
  }

  /// The motion of the pushed patch itself, along its normal.
  MeasuredRows OwnRow(double sigma_m, std::size_t count = 1) const {
    MeasuredRows rows;
    rows.rows.assign(count, robot::RowOfPoint(patch_.weights, patch_.normal));
    rows.sigma_m.assign(count, sigma_m);
    return rows;
  }
  double SmallestForce_N(const MeasuredRows& measured, double tension_N = 0.0,
                         double significance = 1e-3) {
    double force_N = 0.0;
    const Status status = robot_.SmallestForce(
        place_, x_m_, Eigen::VectorXd::Constant(1, tension_N), measured, significance, &force_N);
    EXPECT_TRUE(status.ok()) << status.message();
    return force_N;
  }

  KnownRobot robot_{CabledBeam()};
  Eigen::VectorXd x_m_;
  ProbedPlace place_;
  fem::SurfacePatch patch_;
};

TEST_F(ForceThatIsFelt, MovesWhatIsMeasuredByTheStatedMultipleOfItsNoise) {
  constexpr double kSigma_m = 1e-4;
  constexpr double kSignificance = 1e-3;
  const double smallest_N = SmallestForce_N(OwnRow(kSigma_m), 0.0, kSignificance);
  // The static solver under a small share of that force: the same compliance by another way.
  constexpr double kShare = 1e-3;
  robot_.model().SetGravity(Eigen::Vector3d::Zero());
  fem::StaticState state = robot_.model().RestState();
  ASSERT_TRUE(robot_.model()
                  .Solve({robot::ActuatorCommand{}},
                         {{patch_.weights, -kShare * smallest_N * patch_.normal}}, &state)
                  .status.ok());
  const double motion_m =
      -patch_.normal.dot(patch_.weights.Position(state.x_m) - patch_.weights.Position(x_m_));
  EXPECT_NEAR(motion_m / kShare, NormalQuantile(1.0 - kSignificance) * kSigma_m,
              0.01 * NormalQuantile(1.0 - kSignificance) * kSigma_m);
}

TEST_F(ForceThatIsFelt, GrowsWithTheNoiseAndShrinksWithTheNumberOfMeasurements) {
  const double smallest_N = SmallestForce_N(OwnRow(1e-4));
  EXPECT_NEAR(SmallestForce_N(OwnRow(3e-4)), 3.0 * smallest_N, 1e-9 * smallest_N);
  EXPECT_NEAR(SmallestForce_N(OwnRow(1e-4, 16)), smallest_N / 4.0, 1e-9 * smallest_N);
  EXPECT_GT(SmallestForce_N(OwnRow(1e-4), 0.0, 1e-6), smallest_N);
}

TEST_F(ForceThatIsFelt, IsLargerWhereATautCableHoldsTheBody) {
  const double slack_N = SmallestForce_N(OwnRow(1e-4), 0.0);
  EXPECT_GT(SmallestForce_N(OwnRow(1e-4), std::nan("")), 1.2 * slack_N);
}

TEST_F(ForceThatIsFelt, IsUnknownWithoutMeasurements) {
  double force_N = -1.0;
  const Eigen::VectorXd tension_N = Eigen::VectorXd::Zero(1);
  EXPECT_EQ(robot_.SmallestForce(place_, x_m_, tension_N, {}, 1e-3, &force_N).code(),
            StatusCode::kNoRobotSeen);
  // A row at the clamp does not move.
  Eigen::Index clamped = 0;
  robot_.body().mesh.nodes_m.row(0).minCoeff(&clamped);
  const MeasuredRows held{{{{static_cast<int>(clamped)}, {Eigen::Vector3d::UnitZ()}}}, {1e-4}};
  EXPECT_EQ(robot_.SmallestForce(place_, x_m_, tension_N, held, 1e-3, &force_N).code(),
            StatusCode::kUnobservable);
  EXPECT_EQ(force_N, -1.0);
}

TEST(KnownRobot, DrawsCablesAlongTheBody) {
  const KnownRobot robot(CabledBeam());
  const Eigen::VectorXd rest_m = robot.body().mesh.nodes_m.reshaped();
  const Eigen::Vector3d moved_m(0.001, -0.002, 0.003);
  const Eigen::VectorXd x_m = rest_m + moved_m.replicate(robot.NodeCount(), 1);
  const auto before = robot.CablePaths(rest_m);
  const auto after = robot.CablePaths(x_m);
  ASSERT_THAT(after, testing::SizeIs(1));
  const Eigen::Matrix3Xf& path_m = after.at("top");
  EXPECT_EQ(path_m.col(0), before.at("top").col(0));  // the actuator stays
  const Eigen::Index last = path_m.cols() - 1;
  EXPECT_LT((path_m.col(last) - before.at("top").col(last) - moved_m.cast<float>()).norm(), 1e-7F);
}

TEST(KnownRobot, TellsTheStiffnessAboutEachNode) {
  robot::RobotBody body = CabledBeam();
  fem::Material soft = body.materials.front();
  soft.youngs_modulus_Pa = 0.5 * body.materials.front().youngs_modulus_Pa;
  const double stiff_Pa = body.materials.front().youngs_modulus_Pa;
  body.materials.push_back(soft);
  body.region_names = {"far"};
  const double middle_m = body.mesh.nodes_m.row(0).mean();
  for (Eigen::Index cell = 0; cell < body.mesh.cells.cols(); ++cell) {
    const double x_m = body.mesh.nodes_m(0, body.mesh.cells.col(cell)).mean();
    body.material_of_cell[static_cast<std::size_t>(cell)] = x_m > middle_m ? 1 : 0;
  }
  KnownRobot robot(std::move(body));
  const PageSurface surface = MakePageSurface(robot.body().mesh_hash, robot.body().mesh.nodes_m,
                                              robot.body().boundary.CornerTriangles());
  const auto extremes = [&] {
    const std::vector<float> stiffness_Pa = robot.Stiffness_Pa(surface);
    EXPECT_EQ(stiffness_Pa.size(), surface.nodes.size());
    const auto [low, high] = std::minmax_element(stiffness_Pa.begin(), stiffness_Pa.end());
    return std::pair<double, double>(*low, *high);
  };
  EXPECT_THAT(extremes(), testing::Pair(testing::DoubleNear(0.5 * stiff_Pa, 1.0),
                                        testing::DoubleNear(stiff_Pa, 1.0)));
  // As a calibration has found it.
  EXPECT_TRUE(robot.SetYoungsModulus("far", 0.25 * stiff_Pa));
  EXPECT_FALSE(robot.SetYoungsModulus("far", 0.25 * stiff_Pa));
  EXPECT_FALSE(robot.SetYoungsModulus("no such part", 1.0));
  EXPECT_NEAR(extremes().first, 0.25 * stiff_Pa, 1.0);
  PageSurface other = surface;
  other.hash = "of another mesh";
  EXPECT_TRUE(robot.Stiffness_Pa(other).empty());
}

TEST(KnownRobot, FindsThePointOfTheDeformedBodyNextToAForce) {
  const KnownRobot robot(CabledBeam());
  const Eigen::VectorXd x_m = 1.1 * robot.body().mesh.nodes_m.reshaped();
  const Eigen::Vector3i face = robot.body().boundary.CornerTriangles().col(7);
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  for (const int node : face) middle_m += x_m.segment<3>(3 * node) / 3.0;
  const fem::InterpolationWeights place = robot.PlaceNear(middle_m, x_m);
  EXPECT_LT((place.Position(x_m) - middle_m).norm(), 1e-12);
  EXPECT_TRUE(std::is_sorted(place.nodes.begin(), place.nodes.end()));
}

}  // namespace
}  // namespace palpate::view

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "components/calibration/joint/models_like.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"

namespace palpate::calibration {
namespace {

/// Everything that can be unknown, at once, with markers and surface points and both conditions.
class JointDerivatives : public testing::Test {
 protected:
  explicit JointDerivatives(double eyelet_room_m = 0.0)
      : model_(BuildWithRoom(QuickFourLegRobot(), eyelet_room_m)) {
    const auto pulled = Commands(Kind::kDisplacement, {0.012, 0.010, 0.011, 0.009});
    const auto tight = Commands(Kind::kTension, {1.2, 0.7, 1.0, 0.5});
    setup_.frames = {See(*model_, TableOnePose(), "pulled", pulled, {}, 1e-4),
                     See(*model_, TableOnePose(), "tight", tight, {}, 1e-4)};
    const fem::InterpolationWeights hub = model_->body().markers.front().point.weights;
    setup_.frames[1].surface.push_back({.position_m = {0.01, -0.02, 0.4},
                                        .sigma_m = 3e-4,
                                        .point = hub,
                                        .normal = Eigen::Vector3d(0.6, 0.0, 0.8)});
    auto& unknowns = setup_.unknowns;
    unknowns.push_back(CableInput(0, "pulled", 0, "north", Kind::kDisplacement,
                                  {.mean = 0.012, .plausible = 1e-3}));
    unknowns.push_back(CableInput(1, "tight", 2, "south", Kind::kTension, {.mean = 1.0}));
    unknowns.push_back(CommandOffset(1, "west", {.plausible = 1e-3}));
    unknowns.push_back(CommandGain(3, "east", {0.009, 0.0}, {.plausible = 0.1}));
    unknowns.push_back(LogYoungsModulus(0, "body", 1e5, {.sigma = 0.3}));
    unknowns.push_back(PoissonsRatioOf(0, "body", {.mean = 0.4, .sigma = 0.02, .plausible = 0.1}));
    unknowns.push_back(MassFactor({.mean = 1.0, .sigma = 0.05, .plausible = 0.1}));
    unknowns.push_back(GravityTilt("x", Eigen::Vector3d::UnitX(), {.plausible = 0.1}));
    unknowns.push_back(GravityTilt("y", Eigen::Vector3d::UnitY(), {.plausible = 0.1}));
    setup_.conditions.push_back(CableLengths(1, {1.0, 0.0, 1.0, 0.0}, 0.0, 0.0));
    setup_.conditions.push_back(
        StaysBeyondPlane(0, hub, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.0, 0.6, 0.8)));
    setup_.T_robot_camera = TableOnePose();
    setup_.depth_bias = DepthBiasPrior{.coefficient = {.sigma = 0.005, .plausible = 0.01}};
    setup_.marker_offset_sigma_m = 5e-4;
  }

  std::unique_ptr<robot::RobotModel> model_;
  JointSetup setup_;
};

/// A larger robot whose guides and eyelets sit elsewhere, with loads on it.
class GeometryDerivatives : public JointDerivatives {
 protected:
  GeometryDerivatives() : JointDerivatives(4e-3) {
    setup_.conditions.clear();
    setup_.unknowns.push_back(GeometryScaleOf({.mean = 1.03, .sigma = 0.02, .plausible = 0.02}));
    for (int point = 0; point <= 1; ++point) {
      const auto across = AcrossCable(model_->body(), 2, point);
      const double size = point == 0 ? 1.0 : 0.25;  // more of an eyelet lets the east cable slack
      setup_.unknowns.push_back(RouteOf(model_->body(), 2, point, across[0],
                                        {.mean = size * 1e-3, .sigma = 2e-3, .plausible = 2e-3}));
      setup_.unknowns.push_back(RouteOf(model_->body(), 2, point, across[1],
                                        {.mean = size * -2e-3, .sigma = 2e-3, .plausible = 2e-3}));
    }
    setup_.unknowns.push_back(CableInput(0, "pulled", 2, "south", Kind::kDisplacement,
                                         {.mean = 0.011, .plausible = 1e-3}));
    setup_.frames[0].loads.push_back(
        {model_->body().markers[1].point.weights, Eigen::Vector3d(0.1, -0.2, 0.15)});
    setup_.frames[0].load_places = {{model_->body().markers[1].point.rest_m, 0.0}};
  }
};

void ExpectCentralDifferences(robot::RobotModel& model, const JointSetup& setup) {
  JointProblem problem(model, setup);
  const Eigen::Index count = problem.Start().size();
  const Eigen::VectorXd at = 0.05 * Eigen::VectorXd::LinSpaced(count, -1.0, 1.0);
  LeastSquaresPoint point, plus, minus;
  ASSERT_TRUE(problem.Evaluate(at, &point).ok());
  problem.Accept();
  constexpr double kStep = 1e-3;
  for (Eigen::Index v = 0; v < count; ++v) {
    Eigen::VectorXd beside = at;
    beside[v] += kStep;
    ASSERT_TRUE(problem.Evaluate(beside, &plus).ok());
    beside[v] -= 2.0 * kStep;
    ASSERT_TRUE(problem.Evaluate(beside, &minus).ok());
    const Eigen::VectorXd slope = (plus.residual - minus.residual) / (2.0 * kStep);
    const double size = std::max(1.0, slope.norm());
    const std::string& name = problem.variables()[static_cast<size_t>(v)].name;
    EXPECT_LE((slope - point.jacobian.col(v)).norm(), 2e-6 * size) << name;
    EXPECT_GT(slope.norm(), 1e-3) << name << " changes nothing";
    const Eigen::VectorXd bend = (plus.constraint - minus.constraint) / (2.0 * kStep);
    EXPECT_LE((bend - point.constraint_jacobian.col(v)).norm(), 1e-6 * std::max(1.0, bend.norm()))
        << name;
  }
}

TEST_F(JointDerivatives, AreThoseOfCentralDifferences) {
  ExpectCentralDifferences(*model_, setup_);
}

TEST_F(JointDerivatives, OfPosesWithPriorsAreThoseOfCentralDifferences) {
  setup_.pose_prior = PosePrior{.name = "camera",
                                .T_robot_camera = Disturbed(TableOnePose(), 0.02, 0.004),
                                .translation_sigma_m = 0.005,
                                .rotation_sigma_rad = 0.02};
  setup_.own_poses = {*setup_.pose_prior};
  setup_.frames[0].own_pose = 0;
  ExpectCentralDifferences(*model_, setup_);
}

TEST_F(JointDerivatives, OfFurtherCamerasAreThoseOfCentralDifferences) {
  const geometry::RigidTransform beside = Disturbed(TableOnePose(), 0.3, 0.05);
  setup_.further_cameras = {
      {.name = "left", .T_robot_camera = beside, .depth_bias = setup_.depth_bias},
      {.name = "right",
       .T_robot_camera = TableOnePose(),
       .pose_prior = PosePrior{.name = "right",
                               .T_robot_camera = Disturbed(TableOnePose(), 0.02, 0.004),
                               .translation_sigma_m = 0.005,
                               .rotation_sigma_rad = 0.02}}};
  SurfaceSighting sighting = setup_.frames[1].surface[0];
  const fem::InterpolationWeights foot = model_->body().markers.back().point.weights;
  for (const int camera : {1, 2}) {
    for (int k = 0; k < 6; ++k) {  // as many as a pose has freedoms
      sighting.camera = camera;
      sighting.position_m = Eigen::Vector3d(0.03 * std::cos(k), 0.03 * std::sin(k), 0.4 + 0.01 * k);
      sighting.normal = Eigen::Vector3d(std::sin(2.0 * k), std::cos(3.0 * k), 1.0).normalized();
      if (k > 3) sighting.point = foot;
      setup_.frames[static_cast<std::size_t>(k % 2)].surface.push_back(sighting);
    }
  }
  ExpectCentralDifferences(*model_, setup_);
}

TEST_F(GeometryDerivatives, AreThoseOfCentralDifferences) {
  ExpectCentralDifferences(*model_, setup_);
}

TEST_F(GeometryDerivatives, AreTheSameWithAModelForEachFrame) {
  LeastSquaresPoint alone, together;
  const auto evaluate = [&](LeastSquaresPoint* point) {
    JointProblem problem(*model_, setup_);
    const Eigen::VectorXd at = 0.05 * Eigen::VectorXd::LinSpaced(problem.Start().size(), -1.0, 1.0);
    ASSERT_TRUE(problem.Evaluate(at, point).ok());
  };
  evaluate(&alone);
  setup_.helpers = ModelsLike(*model_, 1);
  evaluate(&together);
  EXPECT_TRUE(alone.residual.isApprox(together.residual, 1e-9));
  EXPECT_TRUE(alone.jacobian.isApprox(together.jacobian, 1e-9));
}

/// A line search would else look at steps that change nothing, again and again.
TEST_F(JointDerivatives, HoldForChangesBelowTheStaticSolversTolerance) {
  JointProblem problem(*model_, setup_);
  const Eigen::VectorXd at = problem.Start();
  LeastSquaresPoint point, beside;
  ASSERT_TRUE(problem.Evaluate(at, &point).ok());
  problem.Accept();
  constexpr double kStep = 1e-8;
  for (Eigen::Index v = 0; v < at.size(); ++v) {
    ASSERT_TRUE(problem.Evaluate(at + kStep * Eigen::VectorXd::Unit(at.size(), v), &beside).ok());
    const Eigen::VectorXd slope = (beside.residual - point.residual) / kStep;
    EXPECT_LE((slope - point.jacobian.col(v)).norm(), 0.02 * std::max(1.0, slope.norm()))
        << problem.variables()[static_cast<size_t>(v)].name;
  }
}

}  // namespace
}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>

#include "components/force_estimation/shape/camera_biases.hpp"
#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

using correspondence::FeatureMatch;
using correspondence::MatchState;

Eigen::Isometry3d OppositePose() { return LookAt({-0.343, 0.198, 0.275}, {0.0, 0.0, 0.065}); }

/// The robot before two cameras that are opposite each other.
class SeveralCameras : public testing::Test {
 protected:
  ShapeView View(const Eigen::VectorXd& x_m, const Eigen::Isometry3d& T_robot_camera) {
    ShapeView view{Cast(scene_, x_m, T_robot_camera), T_robot_camera};
    AddDepthNoise(random_, &view.cloud);
    return view;
  }
  ShapeFrame FrameOfBoth(const Eigen::VectorXd& x_m) {
    ShapeFrame frame;
    frame.views = {View(x_m, BenchPose()), View(x_m, OppositePose())};
    Complete(&frame);
    return frame;
  }
  void Complete(ShapeFrame* frame) {
    frame->t_s = t_s_ += 1.0 / 30.0;
    frame->cables.assign(static_cast<std::size_t>(model_.CableCount()),
                         {robot::ActuatorCommand::Kind::kDisplacement, 0.0});
  }
  Eigen::VectorXd Solve(double push_N, const Eigen::Vector3d& at_m) {
    fem::StaticState state = model_.RestState();
    const fem::SurfacePatch patch = model_.Patch(at_m, 0.006);
    ShapeFrame frame;
    Complete(&frame);
    EXPECT_TRUE(
        model_.Solve(frame.cables, {{patch.weights, -push_N * patch.normal}}, &state).status.ok());
    return state.x_m;
  }
  static long Matched(const std::vector<FeatureMatch>& matches, int camera) {
    return std::count_if(matches.begin(), matches.end(), [&](const FeatureMatch& match) {
      return match.camera == camera && match.state == MatchState::kMatched;
    });
  }

  const ShapeScene& scene_ = FourLegScene();
  robot::RobotModel model_{robot::BuildRobotBody(test_support::FourLegRobot())};
  const Eigen::Vector3d back_m_{-0.0212, 0.0212, 0.103};  ///< hidden from the first camera
  std::mt19937 random_{7};
  double t_s_ = 0.0;
};

TEST_F(SeveralCameras, MatchEachItsOwnCloud) {
  SurfaceMatching matching(*scene_.features, {});
  const ShapeFrame both = FrameOfBoth(scene_.rest_x_m);
  const auto count = static_cast<std::size_t>(scene_.features->Count());
  const std::vector<FeatureMatch> matches = matching.Match(both, scene_.rest_x_m);
  ASSERT_EQ(matches.size(), 2 * count);
  for (std::size_t m = 0; m < matches.size(); ++m) {
    EXPECT_EQ(matches[m].feature, static_cast<int>(m % count));
    EXPECT_EQ(matches[m].camera, static_cast<int>(m / count));
  }
  ShapeFrame second = both;
  second.views.erase(second.views.begin());
  const std::vector<FeatureMatch>& alone = matching.Match(second, scene_.rest_x_m);
  for (std::size_t f = 0; f < count; ++f) {
    EXPECT_EQ(matches[count + f].state, alone[f].state);
    EXPECT_EQ(matches[count + f].target_m, alone[f].target_m);
    EXPECT_EQ(matches[count + f].sigma_m, alone[f].sigma_m);
  }
  EXPECT_GT(Matched(matches, 0), 10);
  EXPECT_GT(Matched(matches, 1), 10);
}

TEST_F(SeveralCameras, OfWhichOneIsMissingGiveTheBitsOfTheOther) {
  ShapeForceEstimator one(model_, {}, {});
  robot::RobotModel other_model(robot::BuildRobotBody(test_support::FourLegRobot()));
  ShapeForceEstimator two(other_model, {}, {});
  const Eigen::VectorXd pushed_m = Solve(0.6, {0.0212, -0.0212, 0.103});
  for (int k = 0; k < 12; ++k) {
    ShapeFrame frame;
    frame.views[0] = View(k < 6 ? Solve(0.0, back_m_) : pushed_m, BenchPose());
    Complete(&frame);
    frame.untouched = k < 6;
    ShapeFrame with_missing = frame;
    with_missing.views.push_back({{}, OppositePose()});
    const ForceEstimate& a = one.Update(frame);
    const ForceEstimate& b = two.Update(with_missing);
    ASSERT_EQ(a.status.code(), b.status.code());
    ASSERT_EQ(a.contacts.size(), b.contacts.size());
    for (std::size_t c = 0; c < a.contacts.size(); ++c) {
      EXPECT_EQ(a.contacts[c].force_N, b.contacts[c].force_N);
      EXPECT_EQ(a.contacts[c].covariance_N2, b.contacts[c].covariance_N2);
    }
    one.PrepareNext();
    two.PrepareNext();
  }
}

/// Without a visible object: the push is known by the deformation alone, to which a second camera
/// adds what it sees.
TEST_F(SeveralCameras, KnowAHiddenPushBetterThanOne) {
  const Eigen::VectorXd pushed_m = Solve(0.5, back_m_);
  const Eigen::VectorXd rest_m = Solve(0.0, back_m_);
  double interval_N[2] = {};
  for (const std::size_t cameras : {1u, 2u}) {
    robot::RobotModel model(robot::BuildRobotBody(test_support::FourLegRobot()));
    ShapeForceEstimator estimator(model, {}, {});
    ForceEstimate estimate;
    for (int k = 0; k < 16; ++k) {
      ShapeFrame frame = FrameOfBoth(k < 6 ? rest_m : pushed_m);
      frame.views.resize(cameras);
      frame.untouched = k < 6;
      estimate = estimator.Update(frame);
      estimator.PrepareNext();
    }
    ASSERT_EQ(estimate.contacts.size(), 1u) << cameras;
    interval_N[cameras - 1] = estimate.contacts[0].ci95_N;
    EXPECT_LE(std::abs(estimate.contacts[0].force_N.norm() - 0.5),
              estimate.contacts[0].ci95_N + 0.02)
        << cameras;
  }
  EXPECT_LT(interval_N[1], interval_N[0]);
}

/// The second camera's depth is 4 mm too large, which its own bias explains.
TEST_F(SeveralCameras, HaveEachTheirOwnDepthBias) {
  ShapeForceEstimator estimator(model_, {}, {});
  const Eigen::VectorXd rest_m = Solve(0.0, back_m_);
  ForceEstimate estimate;
  for (int k = 0; k < 16; ++k) {
    ShapeFrame frame = FrameOfBoth(rest_m);
    frame.views[1].cloud.points_m *= 1.009f;
    frame.untouched = k < 8;
    estimate = estimator.Update(frame);
    estimator.PrepareNext();
  }
  EXPECT_EQ(estimate.status.code(), StatusCode::kNoContact) << estimate.status.message();
}

TEST_F(SeveralCameras, OfUnknownBiasBesideAKnownOneAreNotUsed) {
  ShapeForceEstimator estimator(model_, {}, {});
  const Eigen::VectorXd rest_m = Solve(0.0, back_m_);
  ForceEstimate estimate;
  for (int k = 0; k < 12; ++k) {
    ShapeFrame frame = FrameOfBoth(rest_m);
    frame.untouched = k < 8;
    if (frame.untouched) frame.views[1].cloud = {};
    frame.views[1].cloud.points_m *= 1.02f;  // a bias that would be a force
    estimate = estimator.Update(frame);
    estimator.PrepareNext();
  }
  EXPECT_EQ(estimate.status.code(), StatusCode::kNoContact) << estimate.status.message();
}

TEST(CameraBiases, ASequenceIsContactFreeWhereAllCamerasThatSeeItFindItSo) {
  const ShapeScene& scene = FourLegScene();
  SurfaceMatching matching(*scene.features, {});
  CameraBiases biases(scene.features->Count(), {});
  biases.HaveCameras(2);
  const Eigen::VectorXd bent_m = Moved(scene.rest_x_m, Bend);
  for (std::uint32_t sequence = 1; sequence <= 3; ++sequence) {
    ShapeFrame frame;
    const Eigen::VectorXd& second_m = sequence == 3 ? bent_m : scene.rest_x_m;
    frame.views = {{Cast(scene, scene.rest_x_m, BenchPose()), BenchPose()},
                   {Cast(scene, second_m, OppositePose()), OppositePose()}};
    if (sequence == 2) frame.views[1].cloud = {};
    for (int k = 0; k < 5; ++k) {
      biases.Learn(matching.Match(frame, scene.rest_x_m), scene.rest_x_m, frame.Poses(), sequence);
    }
  }
  const std::vector<BiasSequence> verdicts = biases.Judge();
  ASSERT_EQ(verdicts.size(), 3u);
  EXPECT_TRUE(verdicts[0].contact_free);
  EXPECT_TRUE(verdicts[1].contact_free) << "a camera that does not see it says nothing";
  EXPECT_FALSE(verdicts[2].contact_free);
  EXPECT_EQ(verdicts[1].frames, 5);
}

}  // namespace
}  // namespace palpate::force_estimation

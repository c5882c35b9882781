// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/support/robots.hpp"
#include "tests/support/sensing/contact_generator.hpp"
#include "tests/support/sensing/ideal_perception.hpp"
#include "tests/support/sensing/paths.hpp"
#include "tests/support/sensing/scene_sight.hpp"
#include "tests/support/sensing/sensing_scene.hpp"

namespace palpate::test_support {
namespace {

using testing::Each;
using testing::Gt;
using testing::SizeIs;
using Where = ContactWish::Where;

/// Physics of any kind will do.
scenario::Scenario QuickestScenario() {
  scenario::Scenario scenario = BallScenario();
  scenario.body.refine = 0;
  return scenario;
}

class Scene : public testing::Test {
 protected:
  static void SetUpTestSuite() { scene_ = new SensingScene(FourLegRobot(), QuickestScenario(), 1); }
  static void TearDownTestSuite() { delete scene_; }

  /// RMS of (z - true z) / sigma over the cloud, the mean taken off: the camera's depth has a bias.
  static double ScatterInSigmas(const rgbd::SensedCloud& cloud) {
    rgbd::SurfaceView view(scene_->camera().depth);
    view.Look(scene_->NodesInCamera_m(), scene_->triangles());
    double sum = 0.0;
    double sum_squares = 0.0;
    for (Eigen::Index k = 0; k < cloud.Count(); ++k) {
      const Eigen::Vector3d point_m = cloud.points_m.col(k).cast<double>();
      const Eigen::Vector2d pixel = rgbd::Project(view.camera(), point_m).array().round();
      const auto z_m =
          static_cast<double>(view.Z_m(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())));
      const double error = (point_m.z() - z_m) / static_cast<double>(cloud.sigma_m[k]);
      sum += error;
      sum_squares += error * error;
    }
    const auto count = static_cast<double>(cloud.Count());
    return std::sqrt(sum_squares / count - (sum / count) * (sum / count));
  }

  static SensingScene* scene_;
};

SensingScene* Scene::scene_ = nullptr;

TEST_F(Scene, VisibleContactsAreSeenAndPushAsHardAsWanted) {
  ContactGenerator generator(*scene_, {.largest_command = 0.003}, 5);
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(generator.Next());
    ASSERT_THAT(scene_->state().forces, SizeIs(1));
    const virtual_robot::TrueForce& force = scene_->state().forces[0];
    EXPECT_GT(force.force_N.norm(), 0.24);
    EXPECT_LT(force.force_N.norm(), 1.65);
    EXPECT_GE(SceneSight(*scene_).SeenShare(force.position_m, 0.012), 0.5);
  }
}

TEST_F(Scene, HiddenContactsAreOnTheFarSide) {
  ContactGenerator generator(*scene_, {.where = Where::kHidden}, 6);
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(generator.Next());
    ASSERT_THAT(scene_->state().forces, SizeIs(1));
    EXPECT_LT(SceneSight(*scene_).SeenShare(scene_->state().forces[0].position_m, 0.006), 0.1);
  }
}

TEST_F(Scene, TwoAtOnceAreApart) {
  ContactGenerator generator(*scene_, {.count = 2}, 7);
  for (int k = 0; k < 4; ++k) {
    ASSERT_TRUE(generator.Next());
    const auto& forces = scene_->state().forces;
    ASSERT_THAT(forces, SizeIs(2));
    EXPECT_NE(forces[0].name, forces[1].name);
    EXPECT_GT((forces[0].rest_position_m - forces[1].rest_position_m).norm(), 0.03);
  }
}

TEST_F(Scene, TheSameSeedGivesTheSameContactsAndAnotherOneOthers) {
  const auto first_force_N = [](std::uint64_t seed) {
    ContactGenerator generator(*scene_, {}, seed);
    EXPECT_TRUE(generator.Next());
    return scene_->state().forces.at(0).force_N;
  };
  const Eigen::Vector3d force_N = first_force_N(8);
  EXPECT_LT((first_force_N(8) - force_N).norm(), 1e-3);  // the way there differs
  EXPECT_GT((first_force_N(9) - force_N).norm(), 1e-2);
}

TEST_F(Scene, TheIdealCloudLiesOnTheTrueSurfaceWithinTheDepthNoise) {
  ASSERT_TRUE(scene_->Start(scene_->Nothing()).ok());
  scene_->TakeFrame();
  const rgbd::SensedCloud cloud = IdealPerception(*scene_).Cloud();
  EXPECT_GT(cloud.Count(), 2000);
  EXPECT_THAT(cloud.sigma_m, Each(Gt(0.0f)));
  EXPECT_THAT(cloud.colors_rgb, SizeIs(static_cast<std::size_t>(3 * cloud.Count())));
  EXPECT_GT(ScatterInSigmas(cloud), 0.5);  // noise is on
  EXPECT_LT(ScatterInSigmas(cloud), 2.5);  // and the smooth and periodic biases with it
}

TEST_F(Scene, AKeptStateLooksAsItDid) {
  ContactGenerator generator(*scene_, {}, 10);
  ASSERT_TRUE(generator.Next());
  const SceneState pushed = scene_->state();
  scene_->TakeFrame();
  const rgbd::RangeImage range = scene_->true_range();
  ASSERT_TRUE(scene_->Start(scene_->Nothing()).ok());
  scene_->TakeFrame();
  EXPECT_NE(scene_->true_range().values, range.values);
  scene_->Show(pushed);
  scene_->TakeFrame();
  std::size_t different = 0;
  for (std::size_t k = 0; k < range.values.size(); ++k) {
    const float now = scene_->true_range().values[k];
    if (now != range.values[k] && !(std::isnan(now) && std::isnan(range.values[k]))) ++different;
  }
  EXPECT_EQ(different, 0U);
}

TEST_F(Scene, IdealContactsAreWhereTheToolsTouchButForTheErrorGiven) {
  ContactGenerator generator(*scene_, {}, 11);
  ASSERT_TRUE(generator.Next());
  scene_->TakeFrame();
  const Eigen::Vector3d error_m(1e-3, -2e-3, 0.5e-3);
  const auto& force = scene_->state().forces.at(0);
  const auto contacts = IdealPerception(*scene_).Contacts(2e-3, [&](const std::string& tool) {
    EXPECT_EQ(tool, force.name);
    return error_m;
  });
  ASSERT_THAT(contacts, SizeIs(1));
  EXPECT_EQ(contacts[0].name, force.name);
  EXPECT_NEAR((contacts[0].position_m - force.position_m - error_m).norm(), 0.0, 1e-12);
  EXPECT_NEAR(contacts[0].covariance_m2(1, 1), 4e-6, 1e-12);
}

TEST_F(Scene, ThePathOfAPushBeginsUntouchedAndEndsInTheState) {
  ContactGenerator generator(*scene_, {.largest_command = 0.003}, 12);
  ASSERT_TRUE(generator.Next());
  const std::vector<SceneState>& path = generator.path();
  EXPECT_THAT(path.front().forces, testing::IsEmpty());
  EXPECT_TRUE(path.front().inputs.displacement_m.isZero());
  EXPECT_FALSE(path.back().inputs.displacement_m.isZero());
  EXPECT_EQ(path.back().nodes_m, scene_->state().nodes_m);
  for (std::size_t k = 1; k < path.size(); ++k) {  // no jump
    EXPECT_LT((path[k].nodes_m - path[k - 1].nodes_m).colwise().norm().maxCoeff(), 4e-3) << k;
  }
}

TEST_F(Scene, AHungWeightPullsDownWithItsForceInTheEnd) {
  const std::vector<SceneState> path = HangWeight(*scene_, {0.0, 0.0, 0.125}, 0.46, 0.006);
  EXPECT_THAT(path.front().forces, testing::IsEmpty());
  ASSERT_THAT(path.back().forces, SizeIs(1));
  EXPECT_NEAR((path.back().forces[0].force_N - Eigen::Vector3d(0, 0, -0.46)).norm(), 0.0, 1e-9);
  EXPECT_LT(path.back().nodes_m.row(2).maxCoeff(), path.front().nodes_m.row(2).maxCoeff() - 1e-4);
}

TEST_F(Scene, TheHandComesNearAndTouchesNothing) {
  ASSERT_TRUE(scene_->Start(scene_->Nothing()).ok());
  scenario::Random random(13, "hand");
  for (int k = 0; k < 3; ++k) {
    double nearest_m = 1.0;
    for (const SceneState& state : HandComesNear(*scene_, 0.008, 10, &random)) {
      nearest_m =
          std::min(nearest_m, HandDistance_m(state.inputs.tools.at(0).T_robot_tool, state.nodes_m));
      EXPECT_THAT(state.forces, testing::IsEmpty());
    }
    EXPECT_NEAR(nearest_m, 0.008, 1e-4);
  }
}

}  // namespace
}  // namespace palpate::test_support

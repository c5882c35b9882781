// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/frame_estimator.hpp"

#include <gmock/gmock.h>

#include <random>
#include <string>
#include <vector>

#include "tests/components/force_estimation/shape_scene.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

using ::testing::ElementsAre;

/// A push that perception did not see, at a place that --contact gives: it has that name, and is
/// not searched for.
TEST(FrameEstimatorFromShape, AContactThatIsGivenHasItsForce) {
  const Eigen::Vector3d place_m(0.0, 0.0, 0.125);
  ShapeScene scene(51);
  const std::vector<robot::CableCommand> cables(4);
  const Eigen::VectorXd free_m = SolveTruth(*scene.model, cables, {}).x_m;
  const robot::DeadLoad push = LoadAt(*scene.model, place_m, 0.006, {0.0, 0.0, -1.0});
  const Eigen::VectorXd pushed_m = SolveTruth(*scene.model, cables, {push}).x_m;
  NodeConfig config;
  config.source = "shape";
  config.shape.untouched_frames = 3;
  config.contacts = {"top: 0, 0, 0.125, 0.006"};
  const auto estimator = EstimatorMakerOf(config, {})(*scene.model);
  std::mt19937 random(1);
  FrameResult result;
  for (int k = 0; k < 6; ++k) {
    FrameInput input;
    input.head.stamp_ns = 33'000'000 * k;
    auto& seen = input.frame.emplace<SeenShape>();
    seen.looked = Status::Ok();
    seen.frame = FrameOf(Cast(scene, k < 3 ? free_m : pushed_m, BenchPose()));
    AddDepthNoise(random, &seen.frame.cloud);
    seen.frame.t_s = 0.033 * k;
    seen.frame.cables = cables;
    result = estimator->Update(input);
  }
  ASSERT_TRUE(result.estimate.status.ok()) << result.estimate.status.message();
  std::vector<std::string> names;
  for (const ContactForce& contact : result.estimate.contacts) names.push_back(contact.name);
  ASSERT_THAT(names, ElementsAre("top"));
  EXPECT_NEAR(result.estimate.contacts[0].force_N.z(), -1.0, 0.1);
}

}  // namespace
}  // namespace palpate::force_estimation

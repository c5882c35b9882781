// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/bias_frame_check.hpp"

#include <gmock/gmock.h>

#include <random>
#include <vector>

#include "tests/components/force_estimation/shape_scene.hpp"

namespace palpate::force_estimation {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Sequences of the robot in its undeformed shape, seen by a camera 1 mm and 2 mrad off its assumed
/// pose whose depth is 0.3 % short.
class BiasFrameCheckTest : public testing::Test {
 protected:
  static constexpr int kFrames = 5;

  /// `bent`: share of Bend, some millimetres, that something pushes the robot by.
  void Add(std::uint32_t epoch, double bent = 0.0, int frames = kFrames) {
    Eigen::Isometry3d error = Eigen::Isometry3d::Identity();
    error.rotate(Eigen::AngleAxisd(2e-3, Eigen::Vector3d(1, -2, 2) / 3.0));
    error.translation() = Eigen::Vector3d(0.6, -0.48, 0.64) * 1e-3;
    const auto push = [&](const Eigen::Vector3d& rest_m) -> Eigen::Vector3d {
      return rest_m.y() < 0.0 ? Eigen::Vector3d(bent * Bend(rest_m)) : Eigen::Vector3d::Zero();
    };
    const rgbd::SensedCloud cloud = Cast(scene_, Moved(scene_.rest_x_m, push), BenchPose() * error);
    for (int k = 0; k < frames; ++k) {
      ShapeFrame frame = FrameOf(cloud);
      AddDepthNoise(random_, &frame.views[0].cloud);
      frame.views[0].cloud.points_m *= 1.003f;
      check_.Add(bias_, epoch, matching_.Match(frame, scene_.rest_x_m), scene_.rest_x_m,
                 frame.views[0].T_robot_camera);
    }
  }
  std::vector<bool> ContactFree() const {
    std::vector<bool> verdicts;
    for (const BiasSequence& sequence : check_.Judge()) verdicts.push_back(sequence.contact_free);
    return verdicts;
  }

  const ShapeScene& scene_ = FourLegScene();
  SurfaceMatching matching_{*scene_.features, {}};
  DepthBias bias_{scene_.features->Count(), {}};
  BiasFrameCheck check_{ShapeConfig()};
  std::mt19937 random_{3};
};

TEST_F(BiasFrameCheckTest, WithoutFramesThereIsNothingToJudge) {
  EXPECT_THAT(check_.Judge(), IsEmpty());
}

TEST_F(BiasFrameCheckTest, ErrorsOfTheCameraAreNoContact) {
  Add(1);
  ASSERT_THAT(ContactFree(), ElementsAre(true));
  EXPECT_EQ(check_.Judge()[0].frames, kFrames);
  EXPECT_LT(check_.Judge()[0].misfit, 2.0);
  Add(2);
  Add(3);
  EXPECT_THAT(ContactFree(), ElementsAre(true, true, true));
}

TEST_F(BiasFrameCheckTest, OneOfThreeThatIsTouchedIsFoundByTheOthers) {
  Add(1);
  Add(4, 0.5);
  Add(7);
  EXPECT_THAT(ContactFree(), ElementsAre(true, false, true));
  const BiasSequence& touched = check_.Judge()[1];
  EXPECT_EQ(touched.epoch, 4u);
  EXPECT_GT(touched.difference_m, 1e-4);
  EXPECT_LT(touched.difference_m, 2e-3);
}

TEST_F(BiasFrameCheckTest, OfTwoTheOneThatNoCameraErrorExplainsIsTouched) {
  Add(1, 1.0);
  Add(2);
  EXPECT_THAT(ContactFree(), ElementsAre(false, true));
}

TEST_F(BiasFrameCheckTest, AloneATouchedSequenceIsFoundByThePriorOfTheCamerasErrors) {
  Add(1, 2.0);
  EXPECT_THAT(ContactFree(), ElementsAre(false));
}

TEST_F(BiasFrameCheckTest, ASequenceWithoutTheRobotIsNotContactFree) {
  ShapeFrame empty = FrameOf(Cast(scene_, scene_.rest_x_m, BenchPose()));
  empty.views[0].cloud.points_m.array() += 10.0f;
  check_.Add(bias_, 1, matching_.Match(empty, scene_.rest_x_m), scene_.rest_x_m, BenchPose());
  ASSERT_THAT(ContactFree(), ElementsAre(false));
  EXPECT_EQ(check_.Judge()[0].frames, 0);
}

}  // namespace
}  // namespace palpate::force_estimation

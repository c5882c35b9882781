// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/calibration/joint/joint_request.hpp"
#include "components/calibration/joint/recording_frames.hpp"
#include "tests/components/calibration/joint/joint_scene.hpp"
#include "tests/components/calibration/recording_test_folder.hpp"

namespace palpate::calibration {
namespace {

constexpr double kYoungsModulus_Pa = 230e3;
constexpr double kPoissonsRatio = 0.35;
constexpr double kMassFactor = 1.06;
constexpr double kTiltX = 0.05;
constexpr double kTiltY = -0.03;
const JointRequest kEverything{.pose = false,
                               .moduli = {},
                               .poissons_ratio_sigma = 0.2,
                               .gravity_tilt_sigma_rad = 0.2,
                               .mass_relative_sigma = 0.2};

/// A beam that is heavier, stiffer and bulges less than its robot file says, on a base that is not
/// level: under its own weight, with a known load, and lying on its side.
class WeightAndMaterial : public testing::Test {
 protected:
  CalibrationFrame FrameOf(const std::string& name, const Eigen::Vector3d& gravity_m_s2,
                           double load_N) {
    const auto truth = force_estimation::Build(force_estimation::BeamRobot());
    truth->SetYoungsModulus(0, kYoungsModulus_Pa);
    truth->SetPoissonsRatio(0, kPoissonsRatio);
    const Eigen::Vector3d turn(kTiltX, kTiltY, 0.0);
    truth->SetGravity(kMassFactor * (gravity_m_s2 + turn.cross(gravity_m_s2)));
    std::vector<robot::DeadLoad> loads;
    if (load_N > 0.0) {
      loads.push_back(
          force_estimation::LoadAt(*truth, {0.0, 0.015, 0.03}, 0.005, {0.0, 0.0, -load_N}));
    }
    CalibrationFrame frame = See(*truth, {}, name, {}, loads, 1e-5);
    frame.gravity_m_s2 = gravity_m_s2;
    return frame;
  }

  std::unique_ptr<robot::RobotModel> model_ =
      force_estimation::Build(force_estimation::BeamRobot());
};

TEST_F(WeightAndMaterial, AreFoundFromAKnownLoadAndATurnedBase) {
  const Eigen::Vector3d down = model_->gravity_m_s2();
  JointRequest request = kEverything;
  request.moduli = {0};
  const geometry::RigidTransform here;
  const JointCalibration fit =
      CalibrateFrames(*model_,
                      {FrameOf("rest", down, 0.0), FrameOf("load", down, 0.5),
                       FrameOf("side", {0.0, -down.norm(), 0.0}, 0.0)},
                      &here, request);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  EXPECT_NEAR(ValueNamed(fit, "youngs_modulus:body")->value, kYoungsModulus_Pa, 10.0);
  EXPECT_NEAR(ValueNamed(fit, "poissons_ratio:body")->value, kPoissonsRatio, 1e-4);
  EXPECT_NEAR(ValueNamed(fit, "mass_factor")->value, kMassFactor, 1e-4);
  EXPECT_NEAR(ValueNamed(fit, "gravity_tilt:x")->value, kTiltX, 1e-4);
  EXPECT_NEAR(ValueNamed(fit, "gravity_tilt:y")->value, kTiltY, 1e-4);
}

TEST_F(WeightAndMaterial, SelfWeightAloneDoesNotTellMassFromStiffness) {
  JointRequest request = kEverything;
  request.moduli = {0};
  const geometry::RigidTransform here;
  const JointCalibration fit =
      CalibrateFrames(*model_, {FrameOf("rest", model_->gravity_m_s2(), 0.0)}, &here, request);
  ASSERT_TRUE(fit.status.ok()) << fit.status.message();
  const FittedValue* mass = ValueNamed(fit, "mass_factor");
  EXPECT_FALSE(mass->determined);
  EXPECT_EQ(mass->value, 1.0);
  EXPECT_THAT(mass->what_would_tell, testing::HasSubstr("known load"));
}

/// Reference and static phase as frames of their own, seen from one pose.
TEST(RecordedFrames, GiveTheReferenceWithoutWeightAndCountTheBiasOnce) {
  const RecordingFolder folder;
  folder.Write("experiment.yaml", "frame: camera\nmarkers_sigma_m: [1.0e-4, 2.0e-4, 3.0e-4]\n");
  auto experiment = folder.Read();
  experiment.T_robot_camera = Eigen::Translation3d(1.0, 2.0, 3.0) *
                              Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ());
  robot::RobotDescription robot = force_estimation::BeamRobot();
  const auto model = force_estimation::Build(robot);
  constexpr double kBias_m = 1e-3;
  RecordedFrames recorded(experiment, *model, robot::CableInput::kDisplacement, kBias_m);
  recorded.Add(experiment.recordings[0], false);
  const std::vector<CalibrationFrame>& frames = recorded.frames();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(recorded.has_reference());
  EXPECT_FALSE(recorded.has_camera());
  ASSERT_EQ(recorded.own_poses().size(), 1U);
  const PosePrior& pose = recorded.own_poses()[0];
  EXPECT_EQ(pose.name, "T_robot_camera of experiment.yaml");
  EXPECT_EQ(pose.translation_sigma_m, 0.005);
  EXPECT_EQ(pose.rotation_sigma_rad, 0.01);
  EXPECT_EQ(frames[0].gravity_m_s2, model->gravity_m_s2());
  EXPECT_EQ(frames[0].loads.size(), 1U);
  const MarkerSighting& hanging = frames[0].markers[0];
  EXPECT_EQ(hanging.marker, 0);
  EXPECT_EQ(frames[0].own_pose, 0);
  EXPECT_LT((pose.T_robot_camera * hanging.position_m - Eigen::Vector3d(0.8, 2.1, 3.29)).norm(),
            1e-12);
  EXPECT_NEAR(hanging.covariance_m2(0, 0), kBias_m * kBias_m + 1e-8 / 3.0, 1e-12);
  EXPECT_EQ(frames[1].name, "hang (reference)");
  EXPECT_EQ(frames[1].gravity_m_s2, Eigen::Vector3d::Zero());
  EXPECT_TRUE(frames[1].loads.empty());
  const MarkerSighting& held = frames[1].markers[0];
  EXPECT_EQ(frames[1].own_pose, 0);
  EXPECT_LT((pose.T_robot_camera * held.position_m - Eigen::Vector3d(0.8, 2.1, 3.3)).norm(), 1e-12);
  EXPECT_NEAR(held.covariance_m2(0, 0), 1e-8 / 2.0, 1e-12);
}

}  // namespace
}  // namespace palpate::calibration

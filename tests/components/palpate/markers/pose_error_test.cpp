// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <string>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "tests/components/palpate/markers/marked_bar.hpp"

/// `palpate calibrate` and `estimate` with a camera pose that is known to its standard error.
namespace palpate::command {
namespace {

using testing::HasSubstr;

constexpr double kTruth_Pa = 100e3;

class PoseError : public MarkedBar {
 protected:
  PoseError() { ChangeRobot("youngs_modulus_Pa: 100.0e3", "youngs_modulus_Pa: 130.0e3", false); }

  void WithoutWeight() {
    ChangeRobot("youngs_modulus_Pa: 130.0e3", "youngs_modulus_Pa: 100.0e3", false);
    ChangeRobot("gravity_m_s2: [0, 0, -9.81]", "gravity_m_s2: [0, 0, 0]", true);
    ChangeRobot("youngs_modulus_Pa: 100.0e3", "youngs_modulus_Pa: 130.0e3", false);
  }

  /// Off by 2 mm and 0.3 degrees in a random direction.
  Eigen::Isometry3d PoseOff(unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Eigen::Vector3d shift, axis;
    for (int i = 0; i < 3; ++i) shift[i] = normal(random);
    for (int i = 0; i < 3; ++i) axis[i] = normal(random);
    Eigen::Isometry3d off = T_robot_camera_;
    off.prerotate(Eigen::AngleAxisd(0.3 * std::numbers::pi / 180.0, axis.normalized()));
    off.translation() = T_robot_camera_.translation() + 2e-3 * shift.normalized();
    return off;
  }

  /// In all tests the modulus is within its interval or left out.
  void ExpectHonestModulus() const {
    for (const robot::CalibratedModulus& modulus : Found().moduli) {
      EXPECT_NEAR(modulus.youngs_modulus_Pa, kTruth_Pa, 3.0 * modulus.standard_error_Pa);
    }
  }
};

TEST_F(PoseError, DoesNotBecomeAModulus) {
  RecordThree({});
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    TellPose(PoseOff(seed));
    const ProgramRun run = Calibrate();
    ASSERT_EQ(run.exit_code, 0) << run.output;
    ExpectPose();
    ExpectHonestModulus();
    EXPECT_EQ(Found().moduli.size(), 1U);  // the weight of the bar tells it
    EXPECT_LT(Found().chi_squared, 2.0 * Found().degrees_of_freedom);
  }
}

/// Without weight, displacements alone tell no modulus, whatever the pose.
TEST_F(PoseError, LeavesOutAModulusThatNothingTells) {
  WithoutWeight();
  RecordThree({});
  TellPose(PoseOff(1));
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const robot::CalibrationFile file = Found();
  EXPECT_TRUE(file.moduli.empty());
  ASSERT_FALSE(file.undetermined.empty());
  const robot::Undetermined& modulus = file.undetermined.back();
  EXPECT_EQ(modulus.name, "youngs_modulus:body");
  EXPECT_GT(modulus.standard_error, modulus.limit);
  EXPECT_NEAR(modulus.limit, 0.25 * 130e3, 1.0);
  EXPECT_THAT(run.output, HasSubstr("youngs_modulus:body is not determined by these data"));
  EXPECT_THAT(run.output, HasSubstr("counts) and keeps its value"));
  ExpectPose();
}

/// And does not ask for a known load where there is one.
TEST_F(PoseError, NamesTheKnownLoadsThatCounted) {
  WithoutWeight();
  BarSight hung{.load_N = 1e-4, .kind = "known_load"};
  RecordThree(hung);
  TellPose(PoseOff(1));
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(Found().moduli.empty());
  EXPECT_THAT(run.output,
              HasSubstr("larger known loads than those that counted, hold_2 (0.0001 N)"));
}

TEST_F(PoseError, AKnownLoadTellsTheModulus) {
  WithoutWeight();
  RecordThree({});
  Record({.name = "hung", .commanded_m = 0.004, .load_N = 0.2, .kind = "known_load"});
  TellPose(PoseOff(2));
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ASSERT_EQ(Found().moduli.size(), 1U);
  ExpectHonestModulus();
  EXPECT_LT(Found().moduli[0].standard_error_Pa, 0.15 * kTruth_Pa);
}

/// `frame: robot` states no pose, and is no better than one.
TEST_F(PoseError, OfTheRobotFrameDoesNotBecomeAModulus) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Eigen::Isometry3d off = PoseOff(seed);
    RecordThree({.spoil = [&](const Eigen::Vector3d& seen_m) { return off * seen_m; }});
    folder_.Write("data/experiment.yaml", "frame: robot\nmarkers_sigma_m: 1.0e-4\n");
    const ProgramRun run = Calibrate();
    ASSERT_EQ(run.exit_code, 0) << run.output;
    EXPECT_FALSE(Found().pose);
    ExpectHonestModulus();
  }
}

/// The markers tell the pose by themselves.
TEST_F(PoseError, LargerThanStatedIsSaidAndLeftOut) {
  RecordThree({});
  TellPose(Eigen::Translation3d(0.04, 0.0, 0.0) * T_robot_camera_,
           ", standard_error: {translation_m: 0.001, rotation_rad: 0.002}");
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("note: T_robot_camera of experiment.yaml is off by"));
  EXPECT_THAT(run.output, HasSubstr("the pose is estimated from the markers alone"));
  ExpectPose();
}

/// A pose that is known better than the data tell it stays where it is.
TEST_F(PoseError, OfAWellKnownPoseIsNotMadeWorse) {
  RecordThree({.markers = {0, 3, 7}});
  TellPose(T_robot_camera_, ", standard_error: {translation_m: 1e-6, rotation_rad: 1e-6}");
  const ProgramRun run = Calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.output;
  ASSERT_TRUE(Found().pose);
  EXPECT_TRUE(Found().pose->T_robot_camera.isApprox(T_robot_camera_, 1e-5));
  EXPECT_LE(Found().pose->translation_error_m.maxCoeff(), 2e-6);
}

/// Without a reference window the error of the pose is all there is to see.
TEST_F(PoseError, IsNoForceInEstimate) {
  ChangeRobot("youngs_modulus_Pa: 130.0e3", "youngs_modulus_Pa: 100.0e3", false);
  Record({.name = "hold", .commanded_m = 0.004});
  const std::string commanded_m = FormatNumber(0.004 + kOffset_m);
  folder_.Write("data/recordings/hold/actuation.csv",
                "t_s,top.displacement_m\n0," + commanded_m + "\n1," + commanded_m + "\n");
  const auto estimate = [&](const std::string& error) {
    TellPose(PoseOff(1), error);
    const ProgramRun run = Run({"estimate", robot_.string(), "--data", (folder_ / "data").string(),
                                "--out", (folder_ / "forces.csv").string()});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return ReadFile(folder_ / "forces.csv");
  };
  EXPECT_THAT(estimate(", standard_error: {translation_m: 0.002, rotation_rad: 0.005}"),
              HasSubstr("no_contact"));
  EXPECT_THAT(estimate(""), HasSubstr("no_contact"));  // 5 mm and 0.01 rad
  EXPECT_THAT(estimate(", standard_error: {translation_m: 1e-5, rotation_rad: 1e-5}"),
              testing::Not(HasSubstr("no_contact")));
}

}  // namespace
}  // namespace palpate::command

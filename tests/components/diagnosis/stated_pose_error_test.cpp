// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/faults/catalogue.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

/// Tolerances of the camera's pose in diagnosis, of one that experiment.yaml states.
class StatedPoseError : public testing::Test {
 protected:
  std::vector<FaultParameter> Pose(double extrinsics_m = 0.0) const {
    const ObservedExperiment observed = Observe(experiment_, body_, {.most_samples = 20});
    const CatalogueInputs inputs{.body = body_, .observed = observed, .extrinsics_m = extrinsics_m};
    for (const FaultModelPtr& model : MakeFaultModels(inputs, {})) {
      if (model->name().id == "extrinsics") return model->parameters();
    }
    ADD_FAILURE() << "no extrinsics";
    return std::vector<FaultParameter>(6);
  }

  const robot::RobotBody body_ = SmallRobot();
  experiment::Experiment experiment_ = SmallExperiment(body_);
};

TEST_F(StatedPoseError, IsTheToleranceOfThePose) {
  for (experiment::Recording& recording : experiment_.recordings) {
    if (recording.T_robot_camera) recording.T_robot_camera_error = {0.002, 0.005};
  }
  experiment_.T_robot_camera_error = {0.002, 0.005};
  const std::vector<FaultParameter> pose = Pose();
  EXPECT_DOUBLE_EQ(pose[3].tolerance, 0.005);
  // About the camera, so that a turn moves the robot's middle, too.
  EXPECT_GT(pose[0].tolerance, 0.002);
  EXPECT_LT(pose[0].tolerance, 0.02);
}

TEST_F(StatedPoseError, GivesWayToATolerance) {
  experiment_.T_robot_camera_error = {0.002, 0.005};
  EXPECT_DOUBLE_EQ(Pose(0.001)[0].tolerance, 0.001);
}

TEST_F(StatedPoseError, AbsentIsThatOfACarefulCalibration) {
  EXPECT_DOUBLE_EQ(Pose()[0].tolerance, 5e-4);
  EXPECT_DOUBLE_EQ(Pose()[3].tolerance, 2e-3);
}

}  // namespace
}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/recording_observation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "components/force_estimation/recording_frames.hpp"
#include "libs/core/error.hpp"
#include "tests/components/calibration/recording_test_folder.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::calibration {
namespace {

using force_estimation::BeamRobot;
using force_estimation::Build;
using force_estimation::FramesOfRecording;

/// The beam with markers m0, m1, m2 and a cable.
std::unique_ptr<robot::RobotModel> CableBeam() {
  robot::RobotDescription robot = BeamRobot();
  robot.markers.resize(3);
  robot::CableSettings cable;
  cable.name = "top";
  cable.path_m.resize(3, 2);
  cable.path_m << -0.15, 0.0, 0.015, 0.015, 0.03, 0.03;
  robot.cables.push_back(cable);
  return Build(robot);
}

StaticObservation Observe(const RecordingFolder& folder, double marker_bias_m = 0.0) {
  const auto experiment = folder.Read();
  return ObserveRecording(experiment, experiment.recordings[0], *CableBeam(),
                          robot::CableInput::kDisplacement, marker_bias_m);
}

std::string RefusalOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(ObserveRecording, AveragesTheSteadyWindow) {
  const StaticObservation observation = Observe(RecordingFolder());
  EXPECT_EQ(observation.name, "hang");
  EXPECT_EQ(observation.reference, ReferenceShape::kUndeformed);
  EXPECT_LT((observation.position_m.head<3>() - Eigen::Vector3d(0.1, 0.2, 0.29)).norm(), 1e-12);
  EXPECT_LT((observation.reference_position_m.head<3>() - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(),
            1e-12);
  // x: the stated noise over 3 frames, and that of the reference over 2. z moved more than that.
  EXPECT_NEAR(observation.variance_m2[0], 1e-8 / 3.0 + 1e-8 / 2.0, 1e-12);
  EXPECT_GT(observation.variance_m2[2], 9e-8 / 3.0 + 9e-8 / 2.0);
  // m1 was seen twice, m2 never.
  EXPECT_NEAR(observation.variance_m2[3], 1e-8 / 2.0 + 1e-8 / 2.0, 1e-12);
  EXPECT_LT(observation.variance_m2[6], 0.0);
}

TEST(ObserveRecording, AddsTheBiasOnce) {
  const RecordingFolder folder;
  const double without_m2 = Observe(folder).variance_m2[0];
  EXPECT_NEAR(Observe(folder, 1e-3).variance_m2[0], without_m2 + 1e-6, 1e-12);
}

TEST(ObserveRecording, TakesTheWholeRecordingWhereNoWindowIsGiven) {
  const RecordingFolder folder;
  folder.Write("recordings/hang/recording.yaml", "kind: known_load\n");
  const StaticObservation observation = Observe(folder);
  EXPECT_EQ(observation.reference, ReferenceShape::kNone);
  EXPECT_NEAR(observation.position_m[2], (2 * 0.3 + 3 * 0.29) / 5.0, 1e-12);
}

TEST(ObserveRecording, TakesLoadsCablesAndTiltedGravity) {
  const RecordingFolder folder;
  folder.Write("recordings/hang/actuation.csv",
               "t_s,top.displacement_m,top.tension_N\n0,0,1\n2.2,0.022,3.2\n");
  folder.Write("recordings/hang/recording.yaml",
               "kind: base_tilted\nbase_tilt_deg: [90, 0]\nsteady_window_s: [0.95, 1.25]\n");
  const auto experiment = folder.Read();
  const auto model = CableBeam();
  const auto observe = [&](robot::CableInput preferred) {
    return ObserveRecording(experiment, experiment.recordings[0], *model, preferred, 0.0);
  };
  const StaticObservation observation = observe(robot::CableInput::kDisplacement);
  ASSERT_EQ(observation.loads.size(), 1U);
  EXPECT_EQ(observation.loads[0].force_N, Eigen::Vector3d(0.0, 0.0, -0.5));
  ASSERT_EQ(observation.cables.size(), 1U);
  EXPECT_EQ(observation.cables[0].kind, robot::ActuatorCommand::Kind::kDisplacement);
  EXPECT_NEAR(observation.cables[0].value, 0.011, 1e-12);
  EXPECT_NEAR(observe(robot::CableInput::kTension).cables[0].value, 2.1, 1e-12);
  // R = Rx(90 deg); R' (0, 0, -g) = (0, -g, 0).
  EXPECT_LT((observation.gravity_m_s2 - Eigen::Vector3d(0.0, -9.81, 0.0)).norm(), 1e-12);
}

TEST(ObserveRecording, RefusesWithFileAndLine) {
  using testing::HasSubstr;
  const RecordingFolder folder;
  const auto refusal = [&] { return RefusalOf([&] { Observe(folder); }); };
  folder.Write("recordings/hang/loads.csv",
               "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n0,0.3,0.015,0.03,0,0,-0.5\n");
  EXPECT_THAT(refusal(), testing::AllOf(HasSubstr("loads.csv:2"), HasSubstr("body's surface")));
  folder.Write("recordings/hang/recording.yaml",
               "kind: known_load\nsteady_window_s: [0.95, 1.25]\n");
  folder.Write("recordings/hang/markers.csv",
               "t_s,marker,x_m,y_m,z_m\n0,m0,0,0,0\n1,m0,,,\n1.2,m0,,,\n");
  EXPECT_THAT(refusal(), HasSubstr("no marker of the robot was seen"));
  folder.Write("recordings/hang/recording.yaml", "kind: known_load\n");
  folder.Write("recordings/hang/markers.csv", "t_s,marker,x_m,y_m,z_m\n0,n0,0,0,0\n");
  EXPECT_THAT(refusal(), testing::AllOf(HasSubstr("markers.csv:2"), HasSubstr("n0")));
  std::filesystem::remove(folder.Read().recordings[0].folder / "markers.csv");
  EXPECT_THAT(refusal(), HasSubstr("no markers.csv"));
}

TEST(FramesOfRecording, GivesMarkersCablesAndReferenceOfEachFrame) {
  const RecordingFolder folder;
  folder.Write("recordings/hang/actuation.csv", "t_s,top.displacement_m\n0,0\n2,0.02\n");
  const auto experiment = folder.Read();
  const auto frames = FramesOfRecording(experiment, experiment.recordings[0], *CableBeam(),
                                        robot::CableInput::kDisplacement);
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames[1].reference, force_estimation::ReferenceShape::kUndeformed);
  EXPECT_EQ(frames[2].reference, force_estimation::ReferenceShape::kNone);
  const force_estimation::MarkerFrame& frame = frames[3];
  EXPECT_EQ(frame.t_s, 1.1);
  ASSERT_EQ(frame.markers.size(), 3U);
  EXPECT_TRUE(frame.markers[0].valid);
  EXPECT_LT((frame.markers[0].position_m - Eigen::Vector3d(0.1, 0.2, 0.292)).norm(), 1e-12);
  EXPECT_LT((frame.markers[0].sigma_m - Eigen::Vector3d(1e-4, 2e-4, 3e-4)).norm(), 1e-12);
  EXPECT_FALSE(frame.markers[1].valid);
  EXPECT_FALSE(frame.markers[2].valid);
  EXPECT_NEAR(frame.cables[0].value, 0.011, 1e-12);
}

TEST(FramesOfRecording, TurnsCameraMeasurementsIntoTheRobotFrame) {
  const RecordingFolder folder;
  const auto frames = [&] {
    const auto experiment = folder.Read();
    return FramesOfRecording(experiment, experiment.recordings[0], *CableBeam(),
                             robot::CableInput::kDisplacement);
  };
  folder.Write("experiment.yaml", "frame: camera\nmarkers_sigma_m: [1.0e-4, 2.0e-4, 3.0e-4]\n");
  EXPECT_THAT(RefusalOf([&] { frames(); }), testing::HasSubstr("hang: "));
  auto experiment = folder.Read();
  experiment.T_robot_camera =
      Eigen::Translation3d(1.0, 2.0, 3.0) *
      Eigen::AngleAxisd(0.5 * 3.14159265358979323846, Eigen::Vector3d::UnitZ());
  const auto turned = FramesOfRecording(experiment, experiment.recordings[0], *CableBeam(),
                                        robot::CableInput::kDisplacement);
  EXPECT_LT((turned[0].markers[0].position_m - Eigen::Vector3d(0.8, 2.1, 3.3)).norm(), 1e-12);
  EXPECT_LT((turned[0].markers[0].sigma_m - Eigen::Vector3d(2e-4, 1e-4, 3e-4)).norm(), 1e-12);
}

TEST(FramesOfRecording, RefusesUnknownNames) {
  const RecordingFolder folder;
  const auto refusal = [&] {
    return RefusalOf([&] {
      const auto experiment = folder.Read();
      FramesOfRecording(experiment, experiment.recordings[0], *CableBeam(),
                        robot::CableInput::kDisplacement);
    });
  };
  folder.Write("recordings/hang/actuation.csv", "t_s,topp.displacement_m\n0,0\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("topp"));
  folder.Write("recordings/hang/recording.yaml", "kind: known_load\n");
  folder.Write("recordings/hang/markers.csv", "t_s,marker,x_m,y_m,z_m\n0,m00,0,0,0\n");
  EXPECT_THAT(refusal(), testing::HasSubstr("m00"));
  std::filesystem::remove(folder.Read().recordings[0].folder / "markers.csv");
  EXPECT_THAT(refusal(), testing::HasSubstr("no markers.csv"));
}

}  // namespace
}  // namespace palpate::calibration

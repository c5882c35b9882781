// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/experiment_player.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "tests/components/player/sample_experiment.hpp"

namespace palpate::player {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<Event> AllEvents(ExperimentPlayer& player) {
  std::vector<Event> events;
  while (auto event = player.Next()) events.push_back(std::move(*event));
  return events;
}

std::string RefusalOf(const experiment::Experiment& experiment, const std::string& recording) {
  try {
    ExperimentPlayer(experiment, recording, true);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Seen by a camera that is turned by 90 degrees about z and stands at x = 1 m.
experiment::Experiment CameraExperiment() {
  experiment::Experiment experiment = SampleExperiment();
  experiment.frame = experiment::MeasurementFrame::kCamera;
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  T_robot_camera.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T_robot_camera.translation() << 1, 0, 0;
  experiment.T_robot_camera = T_robot_camera;
  return experiment;
}

TEST(ExperimentPlayer, PlaysEachFrameAndEachRowOnceInTheOrderOfTime) {
  ExperimentPlayer player(SampleExperiment(), "a", true);
  std::vector<double> times_s, frames_s;
  for (const Event& event : AllEvents(player)) {
    times_s.push_back(event.t_s);
    if (event.markers) frames_s.push_back(event.t_s);
  }
  EXPECT_THAT(times_s, ElementsAre(0.0, 0.1, 0.2, 0.25, DoubleNear(0.3, 1e-12)));
  EXPECT_THAT(frames_s, ElementsAre(0.0, 0.1, 0.2, DoubleNear(0.3, 1e-12)));
}

TEST(ExperimentPlayer, CablesMoveLinearlyBetweenTheRowsAndStayAfterTheLast) {
  ExperimentPlayer player(SampleExperiment(), "a", true);
  const std::vector<Event> events = AllEvents(player);
  const std::vector<double> displacements_m{0.0, 0.004, 0.008, 0.010, 0.010};
  for (size_t i = 0; i < events.size(); ++i) {
    ASSERT_EQ(events[i].cables.size(), 2u);
    EXPECT_EQ(events[i].cables[0].cable, "north");
    EXPECT_NEAR(events[i].cables[0].displacement_m.value(), displacements_m[i], 1e-12);
    EXPECT_FALSE(events[i].cables[0].tension_N.has_value());
    EXPECT_EQ(events[i].cables[1].tension_N, 2.0);
  }
}

TEST(ExperimentPlayer, FlagsTheFramesOfTheReferenceWindow) {
  ExperimentPlayer player(SampleExperiment(), "a", true);
  std::vector<MarkerReference> references;
  for (const Event& event : AllEvents(player)) {
    if (event.markers) references.push_back(event.markers->reference);
  }
  using enum MarkerReference;
  EXPECT_THAT(references, ElementsAre(kEquilibrium, kEquilibrium, kNone, kNone));
}

TEST(ExperimentPlayer, AMarkerThatWasNotSeenHasNoPosition) {
  ExperimentPlayer player(SampleExperiment(), "a", true);
  const std::vector<Event> events = AllEvents(player);
  EXPECT_TRUE(events[2].markers->markers[0].position_m.has_value());
  EXPECT_FALSE(events[2].markers->markers[1].position_m.has_value());
}

TEST(ExperimentPlayer, RecordingsFollowEachOtherEachCountedFromZero) {
  ExperimentPlayer player(SampleExperiment(), "", true);
  std::string sequence;
  for (const Event& event : AllEvents(player)) {
    if (event.markers) sequence += event.recording + std::to_string(event.markers->counter) + " ";
  }
  EXPECT_EQ(sequence, "a0 a1 a2 a3 b0 b1 b2 b3 ");
}

TEST(ExperimentPlayer, RewindingRepeatsTheRecordingThatIsPlayed) {
  ExperimentPlayer player(SampleExperiment(), "", true);
  for (int i = 0; i < 7; ++i) player.Next();
  player.RewindRecording();
  const auto event = player.Next();
  EXPECT_EQ(event->recording, "b");
  EXPECT_EQ(event->markers->counter, 0u);
  player.RewindAll();
  EXPECT_EQ(player.Next()->recording, "a");
}

TEST(ExperimentPlayer, CameraCoordinatesAndNoiseAreTurnedIntoTheRobotFrame) {
  ExperimentPlayer player(CameraExperiment(), "a", true);
  const MarkerSet set = *player.Next()->markers;
  EXPECT_EQ(set.frame, experiment::MeasurementFrame::kRobot);
  EXPECT_TRUE(set.markers[0].position_m->isApprox(Eigen::Vector3d(0, 0, 2)));
  EXPECT_TRUE(set.markers[0].sigma_m.isApprox(Eigen::Vector3d(2e-4, 1e-4, 3e-4)));
}

TEST(ExperimentPlayer, TheErrorOfTheCamerasPoseGoesWithItsMarkers) {
  experiment::Experiment experiment = CameraExperiment();
  experiment.T_robot_camera_error = {.translation_m = 0.001, .rotation_rad = 0.002};
  const MarkerSet set = *ExperimentPlayer(experiment, "a", true).Next()->markers;
  ASSERT_TRUE(set.pose_error.has_value());
  EXPECT_EQ(set.pose_error->translation_m, 0.001);
  EXPECT_EQ(set.pose_error->rotation_rad, 0.002);
  EXPECT_EQ(set.pose_about_m, experiment.T_robot_camera->translation());
  experiment.T_robot_camera_error.reset();
  EXPECT_EQ(ExperimentPlayer(experiment, "a", true).Next()->markers->pose_error->translation_m,
            geometry::PoseStandardError().translation_m);
  EXPECT_FALSE(ExperimentPlayer(experiment, "a", false).Next()->markers->pose_error);
  EXPECT_FALSE(ExperimentPlayer(SampleExperiment(), "a", true).Next()->markers->pose_error);
}

TEST(ExperimentPlayer, LeavesMeasuredCoordinatesAloneWhereAsked) {
  ExperimentPlayer player(CameraExperiment(), "a", false);
  const MarkerSet set = *player.Next()->markers;
  EXPECT_EQ(set.frame, experiment::MeasurementFrame::kCamera);
  EXPECT_EQ(*set.markers[0].position_m, Eigen::Vector3d(0, 1, 2));
}

TEST(ExperimentPlayer, RefusesWhatCannotBePlayed) {
  EXPECT_THAT(RefusalOf(SampleExperiment(), "aa"), HasSubstr("did you mean 'a'"));
  experiment::Experiment experiment = SampleExperiment();
  experiment.recordings[0].markers.reset();
  EXPECT_THAT(RefusalOf(experiment, "a"), HasSubstr("has no markers.csv"));
  EXPECT_EQ(RefusalOf(experiment, ""), "accepted");
  experiment = CameraExperiment();
  experiment.T_robot_camera.reset();
  EXPECT_THAT(RefusalOf(experiment, "a"), HasSubstr("frame=measured"));
}

}  // namespace
}  // namespace palpate::player

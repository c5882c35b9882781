// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/simulate_verb.hpp"

#include <algorithm>
#include <cmath>

#include "components/palpate/simulate/sample_times.hpp"
#include "libs/experiment/cameras.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "tests/components/palpate/simulate_fixture.hpp"

namespace palpate::command {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using Vector = Eigen::Vector3d;

TEST_F(SimulateTest, WritesWhatTheExperimentReaderReads) {
  ASSERT_EQ(Run(), 0);
  const experiment::Experiment experiment = Read();
  EXPECT_TRUE(fs::equivalent(*experiment.robot, options_.robot));
  EXPECT_EQ(experiment.frame, experiment::MeasurementFrame::kRobot);
  EXPECT_EQ(experiment.markers_sigma_m, Vector(1e-4, 2e-4, 3e-4));
  EXPECT_EQ(experiment.rest_between_s, 0.5);
  EXPECT_FALSE(experiment.T_robot_camera || experiment.depth_noise);
  ASSERT_THAT(experiment.recordings, SizeIs(2));
  const experiment::Recording& rest = experiment.recordings[0];
  EXPECT_EQ(rest.name, "a_rest");
  EXPECT_EQ(rest.kind, experiment::RecordingKind::kRest);
  EXPECT_FALSE(rest.actuation);  // not driven
  EXPECT_THAT(rest.loads, IsEmpty());
  ASSERT_THAT(rest.markers->frames, SizeIs(3));
  EXPECT_EQ(rest.markers->frames[0].t_s, 0.5);
  const experiment::Recording& pull = experiment.recordings[1];
  EXPECT_EQ(pull.notes, "up");
  EXPECT_EQ(pull.base_tilt_deg, Eigen::Vector2d(90, 0));
  ASSERT_THAT(pull.markers->frames, SizeIs(10));
  EXPECT_EQ(pull.markers->frames[0].t_s, 1.3);
  EXPECT_EQ(pull.markers->frames[9].t_s, 2.2);
}

TEST_F(SimulateTest, ActuationIsWhatTheDrivesSay) {
  ASSERT_EQ(Run(), 0);
  const experiment::Actuation actuation = *Read().recordings[1].actuation;
  const auto* displacement = actuation.Find("top", experiment::ActuatorQuantity::kDisplacement);
  const auto* tension = actuation.Find("top", experiment::ActuatorQuantity::kTension);
  ASSERT_TRUE(displacement && tension);
  // The ten of the markers, and those at 0.25 s (weight) and 0.75 s (the command's bend); the end
  // belongs to the rest.
  ASSERT_THAT(actuation.t_s, SizeIs(12));
  EXPECT_EQ(actuation.t_s[3], 1.55);
  EXPECT_EQ(actuation.t_s[9], 2.05);
  EXPECT_NEAR(*displacement->samples[9], 0.003, 1e-12);
  EXPECT_NEAR(*tension->samples[3], 0.1, 1e-9);
}

TEST_F(SimulateTest, MarkersHaveTheNoiseThatTheScenarioTells) {
  Scenario(
      "markers: {sigma_m: [1.0e-4, 2.0e-4, 3.0e-4], rate_hz: 1000}\nrecordings: [{name: a, "
      "duration_s: 1}]\n");
  ASSERT_EQ(Run(), 0);
  const auto mean = MeanOver(*Read().recordings[0].markers, {0.0, 9.0})[0];
  ASSERT_EQ(mean.count, 1000);
  EXPECT_TRUE(mean.mean_m.isApprox(Vector(0.08, 0.01, 0.02), 1e-3));
  EXPECT_NEAR(mean.deviation_m.x(), 1e-4, 1e-5);
  EXPECT_NEAR(mean.deviation_m.y(), 2e-4, 2e-5);
  EXPECT_NEAR(mean.deviation_m.z(), 3e-4, 3e-5);
}

TEST_F(SimulateTest, OfMarkersThatShareIsMissing) {
  Scenario(
      "markers: {sigma_m: 1.0e-4, rate_hz: 1000, missing_share: 0.1}\nrecordings: [{name: a, "
      "duration_s: 1}]\n");
  ASSERT_EQ(Run(), 0);
  int positions = 0;
  int missing = 0;
  const experiment::Experiment experiment = Read();
  for (const experiment::MarkerFrame& frame : experiment.recordings[0].markers->frames) {
    for (const auto& position_m : frame.positions_m) {
      ++positions;
      missing += position_m ? 0 : 1;
    }
  }
  ASSERT_EQ(positions, 1000);
  EXPECT_NEAR(missing, 0.1 * positions, 5.0 * std::sqrt(0.09 * positions));
}

TEST_F(SimulateTest, DeclaresHungWeightsInTheTiltedFrameFromWhenTheyHang) {
  ASSERT_EQ(Run(), 0);
  const auto loads = Read().recordings[1].loads;
  ASSERT_THAT(loads, SizeIs(2));
  EXPECT_EQ(loads[0].t_s, 1.3);
  EXPECT_TRUE(loads[0].force_N.isZero());
  EXPECT_EQ(loads[1].t_s, 1.55);
  EXPECT_EQ(loads[1].position_m, Vector(0.08, 0.01, 0.02));
  // The base was turned by 90 degrees about x: down is -y of the robot.
  EXPECT_TRUE(loads[1].force_N.isApprox(Vector(0, -0.0981, 0), 1e-12)) << loads[1].force_N;
}

TEST_F(SimulateTest, DrivesOneHistoryThroughRestsAndRecordings) {
  ASSERT_EQ(Run(), 0);
  EXPECT_EQ(log_.started_s, 0.0);
  std::vector<double> times_s;
  for (const auto& step : log_.steps) times_s.push_back(step.t_s);
  EXPECT_TRUE(std::is_sorted(times_s.begin(), times_s.end()));
  // Middle of the rest, the recording of 3 samples, begin and middle of the next rest, ...
  ASSERT_GT(times_s.size(), 8u);
  EXPECT_THAT(std::vector<double>(times_s.begin(), times_s.begin() + 7),
              ElementsAre(0.25, 0.5, 0.6, 0.7, 0.8, 1.05, 1.3));
  EXPECT_THAT(log_.steps[5].inputs.tools, IsEmpty());
  EXPECT_THAT(log_.steps[6].inputs.tools, SizeIs(1));
  EXPECT_THAT(log_.steps[6].inputs.weights, IsEmpty());
  EXPECT_THAT(log_.steps.back().inputs.weights, SizeIs(1));
}

TEST_F(SimulateTest, WritesImagesWithTheDataSheetsCameraAndMarkersInItsFrame) {
  Scenario(kCamera + kMarkers + kRecordings);
  log_.T_before_after.translation() = Vector(0, 0, 0.1);  // really 0.1 m nearer
  ASSERT_EQ(Run(), 0);
  const experiment::Experiment experiment = Read();
  EXPECT_EQ(experiment.frame, experiment::MeasurementFrame::kCamera);
  EXPECT_FALSE(experiment.T_robot_camera);
  EXPECT_EQ(experiment.depth_noise->unit_m, 0.001);
  EXPECT_EQ(experiment.depth_noise->subpixel_px, 0.08);
  const auto sequences = experiment::OpenRgbdSequences(options_.out, app::LoadYaml);
  ASSERT_THAT(sequences, SizeIs(2));
  EXPECT_EQ(sequences[0].camera.depth.fx_px, 3.0);
  ASSERT_THAT(sequences[1].frames, SizeIs(4));
  EXPECT_EQ(sequences[1].frames[1].t_ns, 1550000000);
  rgbd::RgbdFrame frame;
  sequences[1].Read(1, &frame);
  EXPECT_EQ(frame.depth.values[0], 4);  // two in the first recording
  EXPECT_EQ(frame.color.values[0], 7);
  // The marker tip at (0.08, 0.01, 0.02): x right is the robot's x, z forward its y, from y = -1.
  const auto mean = MeanOver(*experiment.recordings[0].markers, {0.0, 9.0})[0];
  EXPECT_TRUE(mean.mean_m.isApprox(Vector(0.08, -0.02, 0.91), 2e-3)) << mean.mean_m.transpose();
  ASSERT_THAT(log_.moments, SizeIs(6));
  EXPECT_EQ(log_.moments[2].recording, 1);
  EXPECT_EQ(log_.moments[2].t_s, 1.3);
}

TEST_F(SimulateTest, FurtherCamerasHaveFoldersTimesAndClocksOfTheirOwn) {
  const std::string further =
      "cameras:\n  - {name: back, delay_s: 0.1, clock_offset_s: 5, depth: {width_px: 4, height_px: "
      "3, fx_px: 3, fy_px: 3, cx_px: 1.5, cy_px: 1, unit_m: 0.001}, color: {width_px: 4, "
      "height_px: 3, "
      "fx_px: 3, fy_px: 3, cx_px: 1.5, cy_px: 1, registered_to_depth: true}, eye_m: [0, 1, 0], "
      "target_m: [0, 0, 0], rate_hz: 4, noise: {sensor: none}}\n";
  Scenario(kCamera + further + kMarkers + kRecordings);
  options_.tell_camera_pose = true;
  ASSERT_EQ(Run(), 0);
  const experiment::Experiment experiment = Read();
  ASSERT_THAT(experiment::FurtherCameras(experiment), testing::ElementsAre("back"));
  const experiment::Experiment back = experiment::OfCamera(experiment, "back");
  EXPECT_TRUE(back.T_robot_camera->translation().isApprox(Vector(0, 1, 0)));
  const auto& files = experiment.recordings[1].cameras[0].depth_images;
  ASSERT_FALSE(files.empty());
  EXPECT_EQ(files[0].t_ns, 6'400'000'000);  // 1.3 s of the recording, 0.1 s late, 5 s of its clock
  EXPECT_EQ(back.recordings[1].depth_images[0].t_ns, 1'400'000'000);
  const auto of_back = [](const CameraInput& moment) { return moment.camera == 1; };
  EXPECT_GT(std::count_if(log_.moments.begin(), log_.moments.end(), of_back), 3);
  EXPECT_TRUE(std::find_if(log_.moments.begin(), log_.moments.end(), of_back)
                  ->T_robot_camera.translation()
                  .isApprox(Vector(0, 1, 0)));
}

TEST_F(SimulateTest, ADepthCameraMeasuresMarkersInItsFrameAndTakesNoPictures) {
  Scenario(kCamera + "markers: {frame: camera, sigma_m: 1.0e-4, rate_hz: 10}\n" + kRecordings);
  ASSERT_EQ(Run(), 0);
  const experiment::Experiment experiment = Read();
  EXPECT_EQ(experiment.frame, experiment::MeasurementFrame::kCamera);
  EXPECT_TRUE(experiment.T_robot_camera->translation().isApprox(Vector(0, -1, 0)));
  EXPECT_FALSE(experiment.depth_noise);
  EXPECT_THAT(log_.moments, IsEmpty());
  for (const experiment::Recording& recording : experiment.recordings) {
    EXPECT_THAT(recording.depth_images, IsEmpty());
    ASSERT_TRUE(recording.camera_file);
    EXPECT_EQ(rgbd::ReadCameraFile(*recording.camera_file, app::LoadYaml).depth.fx_px, 3.0);
    EXPECT_FALSE(fs::exists(recording.folder / "depth"));
  }
  // The marker tip stands 1.01 m before the camera, which says half as much again.
  const auto mean = MeanOver(*experiment.recordings[0].markers, {0.0, 9.0})[0];
  EXPECT_TRUE(mean.mean_m.isApprox(Vector(0.08, -0.02, 1.515), 1e-3)) << mean.mean_m.transpose();
}

TEST_F(SimulateTest, TellsTheCamerasPlannedPoseOnRequestAndWhereItWasMovedOnPurpose) {
  std::string text = kCamera + kRecordings;
  text += "    eye_m: [0, -2, 0]\n    target_m: [0, 0, 0]\n";
  Scenario(text);
  options_.tell_camera_pose = true;
  ASSERT_EQ(Run(), 0);
  const experiment::Experiment experiment = Read();
  EXPECT_TRUE(experiment.T_robot_camera->translation().isApprox(Vector(0, -1, 0)));
  EXPECT_FALSE(experiment.recordings[0].T_robot_camera);
  EXPECT_TRUE(experiment.recordings[1].T_robot_camera->translation().isApprox(Vector(0, -2, 0)));
  EXPECT_TRUE(log_.moments.back().T_robot_camera.translation().isApprox(Vector(0, -2, 0)));
  EXPECT_FALSE(experiment.recordings[0].markers);
}

TEST_F(SimulateTest, AnotherSeedGivesOtherNoise) {
  ASSERT_EQ(Run(), 0);
  const std::string first = ReadFile(options_.out / "recordings/a_rest/markers.csv");
  fs::remove_all(options_.out);
  fs::remove(folder_ / "exp.answer.json");
  options_.seed = 2;
  ASSERT_EQ(Run(), 0);
  EXPECT_NE(ReadFile(options_.out / "recordings/a_rest/markers.csv"), first);
}

TEST(SampleTimes, AreNanosecondsThatReadBack) {
  scenario::Scenario scenario;
  scenario.rest_between_s = 0.1;
  scenario.markers.emplace().rate_hz = 30.0;
  for (const char* name : {"a", "b", "c"}) {
    scenario::RecordingPlan plan;
    plan.name = name;
    plan.duration_s = 0.1;
    scenario::Waypoint waypoint;
    plan.tool_paths = {{"ball", {waypoint}}};
    scenario.recordings.push_back(plan);
  }
  const scenario::Schedule schedule(scenario, {});
  for (int i = 0; i < 3; ++i) {
    const std::vector<Instant> instants = SampleTimes(schedule, i);
    ASSERT_THAT(instants, SizeIs(3)) << i;  // 0, 1/30, 2/30: the end belongs to the rest
    for (const Instant& instant : instants) {
      EXPECT_TRUE(instant.markers);
      EXPECT_EQ(std::llround(1e9 * instant.t_s()), instant.t_ns);
      // 0.1 + 0.1 + 0.1 is not 0.3: the first instant must not fall into the rest before.
      EXPECT_THAT(InputsAt(schedule, i, instant).tools, SizeIs(1)) << i;
    }
  }
}

}  // namespace
}  // namespace palpate::command

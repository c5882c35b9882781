// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/demo_data.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/estimate/force_summary.hpp"
#include "components/palpate/estimate/forces_table.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/robot_scene.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/robot/calibration_file.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

const std::filesystem::path kBeamData = PALPATE_SOURCE_DIR "/tests/data/beam_calculix";

CalibrateOptions OnSelfWeight(const TestFolder& folder) {
  CalibrateOptions options;
  options.robot = "beam";
  options.data = kBeamData;
  options.out = folder / "calibration.yaml";
  return options;
}

TEST(BeamVerbs, FindStiffnessAndGravityJointly) {
  const TestFolder folder;
  CalibrateOptions options = OnSelfWeight(folder);
  options.what = "joint";
  options.marker_offset_sigma_m = 2e-3;
  options.gravity_tilt_sigma_deg = 5.0;
  ASSERT_EQ(Calibrate(options), 0);
  const auto calibration = robot::ReadCalibrationFile(folder / "calibration.yaml", app::LoadYaml);
  EXPECT_FALSE(calibration.pose);
  ASSERT_EQ(calibration.moduli.size(), 1U);
  EXPECT_NEAR(calibration.moduli[0].youngs_modulus_Pa, 231e3, 0.02 * 231e3);  // truth.yaml
  ASSERT_TRUE(calibration.gravity);
  const Eigen::Vector3d off_m_s2 =
      calibration.gravity->gravity_m_s2 - Eigen::Vector3d(0.0, 0.0, -9.81);
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(calibration.gravity->standard_error_m_s2[i], 0.0);
    EXPECT_LE(std::abs(off_m_s2[i]), 1.96 * calibration.gravity->standard_error_m_s2[i]) << i;
  }
  EXPECT_TRUE(calibration.undetermined.empty());
}

TEST(BeamVerbs, FindTheStiffnessAndThenTheHungWeight) {
  const TestFolder folder;
  ASSERT_EQ(Calibrate(OnSelfWeight(folder)), 0);
  const auto calibration = robot::ReadCalibrationFile(folder / "calibration.yaml", app::LoadYaml);
  ASSERT_EQ(calibration.moduli.size(), 1U);
  EXPECT_EQ(calibration.moduli[0].part, "body");
  EXPECT_NEAR(calibration.moduli[0].youngs_modulus_Pa, 231e3, 0.02 * 231e3);  // truth.yaml
  EXPECT_THAT(calibration.data, testing::HasSubstr("self_weight"));
  EXPECT_THAT(calibration.data_hash, testing::StartsWith("sha256-"));

  EstimateOptions options;
  options.robot = "beam";
  options.calibration = folder / "calibration.yaml";
  options.data = kBeamData;
  options.recordings = {"hung_weight"};
  options.contacts = {"tip: 0, 0.015, 0.03, 0.005 along 0, 0, -1"};
  options.out = folder / "forces.csv";
  ASSERT_EQ(Estimate(options), 0);
  const auto forces = experiment::CsvTable::Read(options.out);
  EXPECT_EQ(forces.header(), (std::vector<std::string>{"recording",
                                                       "t_s",
                                                       "contact",
                                                       "x_m",
                                                       "y_m",
                                                       "z_m",
                                                       "fx_N",
                                                       "fy_N",
                                                       "fz_N",
                                                       "ci95_N",
                                                       "location_ci95_m",
                                                       "status",
                                                       "cov_xx_N2",
                                                       "cov_xy_N2",
                                                       "cov_xz_N2",
                                                       "cov_yy_N2",
                                                       "cov_yz_N2",
                                                       "cov_zz_N2",
                                                       "location_cov_xx_m2",
                                                       "location_cov_xy_m2",
                                                       "location_cov_xz_m2",
                                                       "location_cov_yy_m2",
                                                       "location_cov_yz_m2",
                                                       "location_cov_zz_m2"}));
  ASSERT_EQ(forces.rows(), 60U);
  EXPECT_EQ(forces.Text(0, 11), "no_calibration");
  EXPECT_EQ(forces.Text(0, 2), "");
  EXPECT_EQ(forces.Text(59, 11), "ok");
  EXPECT_EQ(forces.Text(59, 2), "tip");
  EXPECT_NEAR(forces.Number(59, 8), -0.510, 0.04 * 0.510);
}

TEST(BeamVerbs, RefuseRecordingsAndPartsThatAreNotThere) {
  const TestFolder folder;
  CalibrateOptions options = OnSelfWeight(folder);
  options.recordings = {"self_weigth"};
  try {
    Calibrate(options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'self_weight'?"));
  }
  options = OnSelfWeight(folder);
  options.parts = {"leg"};
  EXPECT_THROW(Calibrate(options), InputError);
  options.parts = {"body", "body"};
  EXPECT_THROW(Calibrate(options), InputError);
  EXPECT_FALSE(std::filesystem::exists(options.out));
}

TEST(BeamVerbs, RefuseACalibrationOfAnotherRobot) {
  const TestFolder folder;
  ASSERT_EQ(Calibrate(OnSelfWeight(folder)), 0);
  EstimateOptions options;
  options.robot = WriteBarRobot(folder);
  options.calibration = folder / "calibration.yaml";
  options.data = kBeamData;
  options.out = folder / "forces.csv";
  EXPECT_THROW(Estimate(options), InputError);
}

TEST(ChooseRecordings, LeavesUnknownContactsAndUnsteadyOnesOut) {
  experiment::Experiment experiment;
  experiment.recordings.resize(4);
  for (auto& recording : experiment.recordings) recording.markers.emplace();
  experiment.recordings[0].kind = experiment::RecordingKind::kFree;
  experiment.recordings[0].steady_window_s = experiment::TimeWindow{0.0, 1.0};
  experiment.recordings[1].kind = experiment::RecordingKind::kRamp;
  experiment::Experiment unknown_only;
  unknown_only.recordings = {experiment.recordings[0]};
  EXPECT_THROW(RecordingsWithKnownLoads(unknown_only), InputError);
  experiment.recordings[2].kind = experiment::RecordingKind::kKnownLoad;
  experiment.recordings[3].kind = experiment::RecordingKind::kRamp;
  experiment.recordings[3].steady_window_s = experiment::TimeWindow{0.0, 1.0};
  EXPECT_THAT(RecordingsWithKnownLoads(experiment),
              testing::ElementsAre(&experiment.recordings[2], &experiment.recordings[3]));
}

force_estimation::ForceEstimate EstimateOf(double t_s, double fz_N, StatusCode status) {
  force_estimation::ForceEstimate estimate;
  estimate.t_s = t_s;
  estimate.status = Status::Ok();
  force_estimation::ContactForce contact;
  contact.status = Status(status, "");
  contact.name = "tip";
  contact.force_N = {0.0, 0.0, fz_N};
  contact.ci95_N = 0.1;
  estimate.contacts.push_back(contact);
  return estimate;
}

TEST(ForcesTable, LeavesAForceEmptyThatTheMarkersDoNotDetermine) {
  ForcesTable table;
  table.Add("a,b", EstimateOf(0.5, -1.5, StatusCode::kOk));
  table.Add("r", EstimateOf(1.0, -2.0, StatusCode::kUnobservable));
  force_estimation::ForceEstimate none;
  none.t_s = 2.0;
  none.status = Status(StatusCode::kNoContact, "");
  table.Add("r", none);
  EXPECT_THAT(
      table.text(),
      testing::HasSubstr("\n\"a,b\",0.5,tip,0,0,0,0,0,-1.5,0.1,0,ok,0,0,0,0,0,0,0,0,0,0,0,0\n"));
  EXPECT_THAT(table.text(),
              testing::HasSubstr("\nr,1,tip,0,0,0,,,,,0,unobservable,,,,,,,0,0,0,0,0,0\n"));
  EXPECT_THAT(table.text(), testing::EndsWith("\nr,2,,,,,,,,,,no_contact,,,,,,,,,,,,\n"));
  EXPECT_THROW(table.Write("/no/such/folder/forces.csv"), RunError);
}

TEST(ForceSummary, TakesTheMedianOverTheStaticPhaseOnly) {
  ForceSummary summary("r", experiment::TimeWindow{1.0, 4.0});
  for (const auto& [t_s, fz_N] : {std::pair{0.0, -9.0}, {1.0, -1.0}, {2.0, -3.0}, {4.0, -2.0}}) {
    summary.Add(EstimateOf(t_s, fz_N, StatusCode::kOk));
  }
  summary.Add(EstimateOf(3.0, -50.0, StatusCode::kUnobservable));
  EXPECT_EQ(summary.MedianOf("tip").count, 3);
  EXPECT_DOUBLE_EQ(summary.MedianOf("tip").force_N.z(), -2.0);
  EXPECT_DOUBLE_EQ(summary.MedianOf("tip").magnitude_N, 2.0);
  EXPECT_EQ(summary.MedianOf("other").count, 0);
}

TEST(RobotScene, ShowsBodyGhostClampCableAndForces) {
  const TestFolder folder;
  const auto model = LoadRobot(WriteBarRobot(folder));
  fem::StaticState state = model->RestState();
  ASSERT_TRUE(
      model->Solve({{robot::ActuatorCommand::Kind::kTension, 0.3}}, {}, &state).status.ok());
  view::Scene scene = MakeRobotScene(*model, state.x_m);
  EXPECT_EQ(scene.surfaces.size(), 1U);
  EXPECT_EQ(scene.ghosts.size(), 1U);
  EXPECT_EQ(scene.tubes.size(), 1U);
  ASSERT_EQ(scene.blocks.size(), 1U);
  EXPECT_LT(scene.blocks[0].center_m.x(), 0.0);  // behind the clamped face, outside the body
  AddMarkers(Eigen::Vector3d(0.08, 0.01, 0.02), Eigen::Vector3d(0.08, 0.01, 0.021), &scene);
  AddForce({0.08, 0.01, 0.02}, {0, 0, -1.0}, 0.02, view::palette::kEstimate, "1 N", &scene);
  scene.width_px = 480;
  scene.height_px = 360;
  view::SaveScene(folder / "scene.png", scene);
  EXPECT_GT(std::filesystem::file_size(folder / "scene.png"), 2000U);
}

TEST(DemoData, RefusesADataFolderWithoutTheBeam) {
  const TestFolder folder;
  EXPECT_THROW(FindMeasuredData(folder.path()), InputError);
}

TEST(DemoData, ReadsTheTruthOfTheComputedBeam) {
  EXPECT_NEAR(ComputedBeam().true_force_N.norm(), 0.052 * 9.81, 1e-5);
}

}  // namespace
}  // namespace palpate::command

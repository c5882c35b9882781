// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "tests/libs/scenario/scenario_text.hpp"

namespace palpate::scenario {
namespace {

using test_support::TestFolder;
using testing::ElementsAre;
using Vector = Eigen::Vector3d;

const std::string kShort = "name: s\nrecordings: [{name: a, duration_s: 1}]\n";

TEST(ReadScenario, CamerasBesideTheFirstAreOfTheirOwn) {
  const Scenario scenario =
      ReadScenario(std::filesystem::path(PALPATE_SOURCE_DIR) / "config/scenarios/two_cameras.yaml",
                   app::LoadYaml);
  ASSERT_EQ(scenario.further_cameras.size(), 1u);
  const FurtherCamera& back = scenario.further_cameras[0];
  EXPECT_EQ(back.name, "back");
  EXPECT_EQ(back.delay_s, 0.012);
  EXPECT_EQ(back.clock_offset_s, 0.25);
  EXPECT_EQ(back.T_robot_camera.translation(), Eigen::Vector3d(-0.343, 0.198, 0.275));
  const Scenario alone = scenario.WithCamera(1);
  EXPECT_TRUE(alone.further_cameras.empty());
  EXPECT_EQ(alone.camera->T_robot_camera.translation(), back.T_robot_camera.translation());
  EXPECT_EQ(scenario.WithCamera(0).camera->T_robot_camera.translation(),
            scenario.camera->T_robot_camera.translation());
}

TEST(ReadScenario, NeedsANameAndOneRecordingOnly) {
  const Scenario scenario = Parse(kShort);
  EXPECT_EQ(scenario.file, "bench/s.yaml");
  EXPECT_EQ(scenario.name, "s");
  EXPECT_EQ(scenario.body.refine, 1);
  EXPECT_TRUE(scenario.body.mesh_file.empty() && scenario.body.element.empty());
  EXPECT_FALSE(scenario.body.youngs_modulus_Pa || scenario.body.poissons_ratio);
  EXPECT_EQ(scenario.motion.mode, MotionMode::kQuasiStatic);
  EXPECT_EQ(scenario.clutter, 0.0);
  EXPECT_FALSE(scenario.camera || scenario.markers);
  EXPECT_EQ(scenario.rest_between_s, 1.0);
  ASSERT_EQ(scenario.recordings.size(), 1u);
  EXPECT_EQ(scenario.recordings[0].kind, "free");
  EXPECT_TRUE(scenario.recordings[0].commands.cables.empty());
}

TEST(ReadScenario, ReadsTheBodyAndItsMotion) {
  const Scenario scenario = Parse(kFullScenario);
  const BodyTruth& body = scenario.body;
  EXPECT_EQ(body.refine, 2);
  EXPECT_EQ(body.element, "tet4");
  EXPECT_EQ(body.material_model, "yeoh");
  EXPECT_EQ(body.youngs_modulus_Pa, 91.0e3);
  EXPECT_EQ(body.poissons_ratio, 0.47);
  EXPECT_EQ(body.c20_over_c10, 0.2);
  EXPECT_EQ(body.c30_over_c10, 0.01);
  ASSERT_EQ(body.prony.size(), 2u);
  EXPECT_EQ(body.prony[1].g, 0.05);
  EXPECT_EQ(body.prony[1].tau_s, 50.0);
  EXPECT_EQ(scenario.motion.mode, MotionMode::kDynamic);
  EXPECT_EQ(scenario.motion.time_step_s, 0.005);
  EXPECT_EQ(scenario.motion.rayleigh_mass_1_s, 2.0);
  EXPECT_EQ(scenario.motion.rayleigh_stiffness_s, 0.002);
}

TEST(ReadScenario, FindsTheMeshBesideTheScenario) {
  const TestFolder folder;
  folder.Write("meshes/fine.msh", "x");
  const auto file = folder.Write("s.yaml", "body: {mesh_file: meshes/fine.msh}\n" + kShort);
  EXPECT_EQ(ReadScenario(file, app::LoadYaml).body.mesh_file, folder.path() / "meshes/fine.msh");
}

TEST(ReadScenario, ReadsToolsOfEveryShape) {
  const std::vector<Tool> tools = Parse(kFullScenario).tools;
  ASSERT_EQ(tools.size(), 4u);
  EXPECT_EQ(tools[0].shape, ToolShape::kSphere);
  EXPECT_EQ(tools[0].radius_m, 0.012);
  EXPECT_EQ(tools[0].friction_coefficient, 0.4);
  EXPECT_EQ(tools[0].color_rgb, Vector(0.1, 0.2, 0.3));
  EXPECT_EQ(tools[1].shape, ToolShape::kCylinder);
  EXPECT_EQ(tools[1].length_m, 0.08);
  EXPECT_EQ(tools[2].shape, ToolShape::kPlate);
  EXPECT_EQ(tools[2].size_m, Vector(0.1, 0.08, 0.004));
  EXPECT_EQ(tools[3].shape, ToolShape::kHand);
  EXPECT_EQ(Parse(kFullScenario).ToolNamed("rod").radius_m, 0.005);
}

TEST(ReadScenario, ReadsTheCameraAndItsNoise) {
  const CameraSpec camera = *Parse(kFullScenario).camera;
  EXPECT_EQ(camera.camera.depth.width_px, 848);
  EXPECT_EQ(camera.T_robot_camera.translation(), Vector(0.1, -0.4, 0.2));
  EXPECT_TRUE(camera.T_robot_camera.linear().isApprox(
      Vector(1.0, -1.0, -1.0).asDiagonal().toDenseMatrix(), 1e-15));
  EXPECT_EQ(camera.rate_hz, 15.0);
  const DepthNoise& noise = camera.noise;
  EXPECT_EQ(noise.sensor, DepthSensor::kTimeOfFlight);
  EXPECT_EQ(noise.subpixel_px, 0.1);
  EXPECT_EQ(noise.correlation_px, 2.0);
  EXPECT_EQ(noise.temporal_correlation, 0.4);
  EXPECT_EQ(noise.disparity_step_px, 0.125);
  EXPECT_EQ(noise.periodic_bias_px, 0.02);
  EXPECT_EQ(noise.low_frequency_bias, 0.001);
  EXPECT_EQ(noise.edge_hole_ratio, 0.4);
  EXPECT_EQ(noise.flying_pixel_ratio, 0.2);
  EXPECT_EQ(noise.grazing_angle_rad, 1.1);
  EXPECT_EQ(noise.range_sigma_m, 0.003);
}

TEST(ReadScenario, ReadsTheCameraFromAFileBesideTheScenario) {
  const TestFolder folder;
  rgbd::RgbdCamera camera;
  camera.depth = {64, 48, 50, 51, 31.5, 23.5, {}};
  camera.baseline_m = 0.05;
  folder.Write("camera.yaml", rgbd::FormatCameraFile(camera));
  const auto file = folder.Write(
      "s.yaml", "camera: {file: camera.yaml, eye_m: [0, -1, 0], target_m: [0, 0, 0]}\n" + kShort);
  EXPECT_EQ(ReadScenario(file, app::LoadYaml).camera->camera.depth, camera.depth);
}

TEST(ReadScenario, ADepthCameraThatMeasuresMarkersTakesNoPictures) {
  const Scenario scenario = Parse(FullWith("markers: {", "markers: {frame: camera, "));
  EXPECT_TRUE(scenario.markers->by_depth_camera);
  EXPECT_FALSE(scenario.TakesPictures());
  EXPECT_FALSE(Parse(kShort).TakesPictures());
}

TEST(ReadScenario, ReadsStageMarkersAndRest) {
  const Scenario scenario = Parse(kFullScenario);
  const Stage& stage = scenario.stage;
  EXPECT_EQ(stage.table_height_m, -0.01);
  EXPECT_EQ(stage.table_size_m, Eigen::Vector2d(0.5, 0.6));
  EXPECT_EQ(stage.table_color_rgb, Vector::Constant(0.1));
  EXPECT_EQ(stage.background_distance_m, 0.7);
  EXPECT_EQ(stage.background_color_rgb, Vector::Constant(0.2));
  EXPECT_EQ(stage.robot_color_rgb, Vector::Constant(0.3));
  EXPECT_EQ(stage.marker_radius_m, 0.003);
  EXPECT_EQ(stage.marker_color_rgb, Eigen::Vector3d(0.1, 0.7, 0.2));
  EXPECT_EQ(stage.light, 0.8);
  EXPECT_EQ(scenario.markers->sigma_m, Vector(1e-4, 2e-4, 3e-4));
  EXPECT_EQ(scenario.markers->rate_hz, 60.0);
  EXPECT_FALSE(scenario.markers->by_depth_camera);
  EXPECT_TRUE(scenario.TakesPictures());
  EXPECT_EQ(scenario.rest_between_s, 2.5);
  EXPECT_EQ(scenario.clutter, 0.5);
  EXPECT_EQ(Parse("markers: {sigma_m: 0.001}\n" + kShort).markers->sigma_m, Vector::Constant(1e-3));
}

TEST(ReadScenario, ReadsRecordings) {
  const std::vector<RecordingPlan> plans = Parse(kFullScenario).recordings;
  ASSERT_EQ(plans.size(), 2u);
  EXPECT_EQ(plans[0].name, "a_ramp");
  EXPECT_EQ(plans[0].kind, "ramp");
  EXPECT_EQ(plans[0].duration_s, 4.0);
  EXPECT_EQ(plans[0].notes, "up and hold");
  EXPECT_EQ(plans[0].location.line, 28);
  ASSERT_EQ(plans[0].weights.size(), 3u);
  EXPECT_EQ(plans[0].weights[0].position_m, Vector(0, 0, 0.12));
  EXPECT_EQ(plans[0].weights[0].mass_kg, 0.05);
  EXPECT_EQ(plans[0].weights[0].patch_radius_m, 0.01);
  EXPECT_EQ(plans[0].weights[2].t_s, 3.0);
  EXPECT_EQ(plans[1].kind, "free");
  EXPECT_EQ(plans[1].base_tilt_deg, Eigen::Vector2d(5, -10));
  EXPECT_FALSE(plans[0].T_robot_camera);
  EXPECT_EQ(plans[1].T_robot_camera->translation(), Vector(0.45, 0, 0.1));
}

TEST(ReadScenario, CommandsAreLinearBetweenRowsAndHeldOutsideThem) {
  const CommandScript commands = Parse(kFullScenario).recordings[0].commands;
  EXPECT_THAT(commands.cables, ElementsAre("north", "east"));
  EXPECT_EQ(commands.At(-1.0)[0], 0.0);
  EXPECT_DOUBLE_EQ(commands.At(0.5)[0], 0.0025);
  EXPECT_EQ(commands.At(2.0)[0], 0.01);
  EXPECT_EQ(commands.At(9.0)[0], 0.01);
}

TEST(ReadScenario, ACableIsDrivenOnlyBetweenRowsThatBothDriveIt) {
  const CommandScript commands = Parse(kFullScenario).recordings[0].commands;
  EXPECT_TRUE(std::isnan(commands.At(0.0)[1]));
  EXPECT_TRUE(std::isnan(commands.At(1.9)[1]));
  EXPECT_EQ(commands.At(2.0)[1], 0.002);
  CommandScript let_go = commands;
  std::swap(let_go.rows[0].displacement_m, let_go.rows[1].displacement_m);
  EXPECT_EQ(let_go.At(0.0)[1], 0.002);
  EXPECT_TRUE(std::isnan(let_go.At(0.1)[1]));
}

TEST(ReadScenario, AToolMovesStraightAndTurnsByTheShortestArc) {
  const RecordingPlan plan = Parse(kFullScenario).recordings[1];
  EXPECT_EQ(PoseAt(plan, "rod", 1.0), std::nullopt);
  EXPECT_EQ(PoseAt(plan, "ball", -1.0)->translation(), Vector(0, 0, 0.2));
  EXPECT_EQ(PoseAt(plan, "ball", 9.0)->translation(), Vector(0, 0, 0.1));
  const Eigen::Isometry3d half = *PoseAt(plan, "ball", 1.0);
  EXPECT_TRUE(half.translation().isApprox(Vector(0, 0, 0.15), 1e-14));
  const double s = std::sqrt(0.5);
  EXPECT_TRUE((half.linear() * Vector::UnitX()).isApprox(Vector(s, s, 0), 1e-14));
}

TEST(ReadScenario, TheCameraLooksWhereItIsTold) {
  const Eigen::Isometry3d T = *Parse(kFullScenario).recordings[1].T_robot_camera;
  EXPECT_TRUE((T.linear() * Vector::UnitZ()).isApprox(Vector(-1, 0, 0), 1e-15));  // forward
  EXPECT_TRUE((T.linear() * Vector::UnitY()).isApprox(Vector(0, 0, -1), 1e-15));  // down
  EXPECT_TRUE((T.linear() * Vector::UnitX()).isApprox(Vector(0, 1, 0), 1e-15));   // right
  EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-15);
}

TEST(ReadScenario, ACameraOverheadHasTheRobotsXToItsRight) {
  const Scenario scenario = Parse(
      "camera: {depth: {width_px: 4, height_px: 4, fx_px: 3, fy_px: 3, cx_px: 2, cy_px: 2, "
      "unit_m: 0.001}, noise: {sensor: none}, eye_m: [0, 0, 1], target_m: [0, 0, 0]}\n" +
      kShort);
  const Eigen::Isometry3d& T = scenario.camera->T_robot_camera;
  EXPECT_TRUE((T.linear() * Vector::UnitX()).isApprox(Vector(1, 0, 0), 1e-15));
  EXPECT_TRUE((T.linear() * Vector::UnitZ()).isApprox(Vector(0, 0, -1), 1e-15));
  EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-15);
}

TEST(ReadScenario, KeepsValuesAndRangesOfEffects) {
  const std::vector<Effect> effects = Parse(kFullScenario).effects;
  ASSERT_EQ(effects.size(), 4u);
  EXPECT_EQ(effects[0].id, "cable_friction");
  EXPECT_THAT(effects[0].where, ElementsAre("cable:north"));
  EXPECT_THAT(effects[0].ranges.at("mu"), ElementsAre(0.3, 0.3));
  EXPECT_EQ(effects[0].location.line, 9);
  EXPECT_THAT(effects[1].where, ElementsAre("cable:east", "cable:west"));
  EXPECT_TRUE(effects[2].where.empty());
  EXPECT_THAT(effects[2].ranges.at("offset_m"), ElementsAre(0.001, 0.004));
  EXPECT_FALSE(effects[3].ranges.contains("rotation_rad"));
}

}  // namespace
}  // namespace palpate::scenario

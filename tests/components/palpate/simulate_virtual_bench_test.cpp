// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/images/rgbd_sequence.hpp"
#include "tests/components/palpate/simulate_fixture.hpp"

namespace palpate::command {
namespace {

namespace fs = std::filesystem;
using testing::SizeIs;
using AnyJson = nlohmann::json;

/// A ball comes down on the bar from above, before a camera that looks at it from the side.
const std::string kPush = R"(body: {refine: 0}
motion: {mode: quasi_static, time_step_s: 0.1}
tools: [{name: ball, shape: sphere, radius_m: 0.01, friction_coefficient: 0.5}]
camera:
  depth: {width_px: 64, height_px: 48, fx_px: 60, fy_px: 60, cx_px: 31.5, cy_px: 23.5, unit_m: 0.0001}
  color: {width_px: 64, height_px: 48, fx_px: 60, fy_px: 60, cx_px: 31.5, cy_px: 23.5, registered_to_depth: true}
  eye_m: [0.04, -0.2, 0.01]
  target_m: [0.04, 0.01, 0.01]
  rate_hz: 5
  noise: {sensor: none}
stage: {table_height_m: -0.2}
markers: {sigma_m: 1.0e-6, rate_hz: 5}
rest_between_s: 0.2
recordings:
  - {name: a_rest, kind: rest, duration_s: 0.2}
  - name: b_push
    duration_s: 1
    tools: [{tool: ball, path: [{t_s: 0, position_m: [0.07, 0.01, 0.05]}, {t_s: 0.8, position_m: [0.07, 0.01, 0.02]}]}]
)";

class SimulateVirtualBench : public SimulateTest {
 protected:
  void Simulate(const std::string& effects = "") {
    fs::remove_all(options_.out);
    fs::remove(folder_ / "exp.answer.json");
    Scenario(effects + kPush);
    ASSERT_EQ(SimulateOrCheck(options_), 0);
  }
  /// Markers measured by the camera, from `eye_m`.
  void SimulateMarkersByCamera(const std::string& effects, const std::string& eye_m) {
    fs::remove_all(options_.out);
    fs::remove(folder_ / "exp.answer.json");
    std::string text = kPush;
    text.replace(text.find("markers: {"), 10, "markers: {frame: camera, ");
    text.replace(text.find("[0.04, -0.2, 0.01]"), 18, eye_m);
    Scenario(effects + text);
    ASSERT_EQ(SimulateOrCheck(options_), 0);
  }
  /// Of the marker at the tip, frame of the camera: y points down.
  double TipDepth_m(const experiment::Recording& recording, std::size_t frame) const {
    return recording.markers->frames.at(frame).positions_m[0]->y();
  }
};

TEST_F(SimulateVirtualBench, TheBallPushesTheBarDownAndIsInTheAnswer) {
  Simulate();
  const experiment::Experiment experiment = Read();
  ASSERT_THAT(experiment.recordings[1].markers->frames, SizeIs(5));
  const double sagged_m = TipDepth_m(experiment.recordings[0], 0);
  EXPECT_GT(sagged_m, -0.01 + 1e-3);  // its rest place is 10 mm above the optical axis
  EXPECT_NEAR(TipDepth_m(experiment.recordings[1], 0), sagged_m, 1e-4);
  EXPECT_GT(TipDepth_m(experiment.recordings[1], 4), sagged_m + 1e-3);
  const AnyJson frames = AnswerJson()["recordings"][1]["frames"];
  EXPECT_TRUE(frames[0]["forces"].empty());
  ASSERT_THAT(frames[4]["forces"], SizeIs(1));
  EXPECT_EQ(frames[4]["forces"][0]["name"], "ball");
  EXPECT_LT(frames[4]["forces"][0]["force_N"][2], -0.005);
  EXPECT_NEAR(frames[4]["forces"][0]["rest_position_m"][0].get<double>(), 0.07, 0.01);
  EXPECT_EQ(Check(), 0);
}

TEST_F(SimulateVirtualBench, TheCameraSeesTheBarWhereItIs) {
  Simulate();
  EXPECT_EQ(Read().depth_noise->subpixel_px, 0.0);  // without a stereo camera there is no disparity
  const auto sequences = experiment::OpenRgbdSequences(options_.out, app::LoadYaml);
  ASSERT_THAT(sequences[1].frames, SizeIs(5));
  rgbd::RgbdFrame frame;
  sequences[0].Read(0, &frame);
  // The bar's side y = 0 is 0.2 m away; beside the bar is the wall behind, or nothing.
  const int at_bar = *frame.depth.Pixel(25, 24);
  EXPECT_NEAR(at_bar, 2000, 20);
  EXPECT_FALSE(frame.color.empty());
  EXPECT_NE(*frame.depth.Pixel(25, 5), at_bar);
}

TEST_F(SimulateVirtualBench, MarkersThatTheCameraMeasuresHaveItsErrors) {
  const auto tips_m = [&](const std::string& effects) {
    SimulateMarkersByCamera(effects, "[0.04, -0.1, 0.2]");
    const experiment::Recording recording = Read().recordings[1];
    return std::pair(recording.markers->frames.front().positions_m[0].value(),
                     recording.markers->frames.back().positions_m[0].value());
  };
  const auto [begin_m, end_m] = tips_m("");
  EXPECT_GT(end_m.z(), begin_m.z() + 1e-3);  // pushed down
  const auto scaled_m = tips_m("effects: [{id: depth_scale, s: 0.02}]\n").first;
  EXPECT_LT((scaled_m - 1.02 * begin_m).norm(), 1e-5);
  const auto focal_m = tips_m("effects: [{id: intrinsics, focal: -0.03}]\n").first;
  EXPECT_LT((focal_m - Eigen::Vector3d(0.97, 0.97, 1.0).cwiseProduct(begin_m)).norm(), 1e-5);
  const auto askew_m = tips_m("effects: [{id: depth_incidence_bias, b_m: 0.004}]\n").first;
  EXPECT_GT((askew_m - begin_m).norm(), 1e-4);
  EXPECT_LT((askew_m - begin_m).normalized().cross(begin_m.normalized()).norm(), 0.05);
}

TEST_F(SimulateVirtualBench, TheCameraMeasuresNoMarkerThatItSeesTooMuchAside) {
  // The marker sits on the bar's upper side, level with which the camera looks.
  SimulateMarkersByCamera("", "[0.04, -0.2, 0.02]");
  const experiment::Recording recording = Read().recordings[1];
  ASSERT_THAT(recording.markers->frames, SizeIs(5));
  for (const auto& frame : recording.markers->frames) EXPECT_FALSE(frame.positions_m[0]);
}

TEST_F(SimulateVirtualBench, SameSeedSameData) {
  Simulate();
  const std::string first = AnswerJson()["data_sha256"];
  Simulate();
  EXPECT_EQ(AnswerJson()["data_sha256"], first);
}

TEST_F(SimulateVirtualBench, AnEffectShowsInTheDataAndInTheTrueCamera) {
  Simulate();
  const double sagged_m = TipDepth_m(Read().recordings[0], 0);
  const AnyJson pose = AnswerJson()["recordings"][1]["T_robot_camera"];
  Simulate(
      "effects: [{id: youngs_modulus, factor: 0.5}, {id: camera_moved, translation_m: 0.05, "
      "from_recording: 1}]\n");
  EXPECT_GT(TipDepth_m(Read().recordings[0], 0), sagged_m + 1e-3);
  EXPECT_EQ(AnswerJson()["recordings"][0]["T_robot_camera"], pose);
  const AnyJson moved = AnswerJson()["recordings"][1]["T_robot_camera"];
  Eigen::Vector3d by_m;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    by_m[i] =
        moved["translation_m"][axis].get<double>() - pose["translation_m"][axis].get<double>();
  }
  EXPECT_NEAR(by_m.norm(), 0.05, 1e-9);
}

}  // namespace
}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/perception/labelled_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/app/yaml.hpp"
#include "libs/rgbd/depth_noise.hpp"
#include "libs/rgbd/png.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "tests/support/robots.hpp"

namespace palpate::perception {

namespace {

constexpr float kSameSurface_m = 2e-4f;
/// A pixel's depth may err by so many sigmas, and by a share of z, and still be of its surface.
constexpr double kSigmas = 4.5;
constexpr double kBias = 0.012;

const robot::RobotDescription& FourLeg() {
  static const robot::RobotDescription description = test_support::LinearFourLegRobot();
  return description;
}

std::unique_ptr<virtual_camera::VirtualCamera> MakeCamera(const scenario::Scenario& scenario,
                                                          std::uint64_t seed) {
  return std::make_unique<virtual_camera::VirtualCamera>(
      scenario, PushSkin(), std::vector<scenario::ActiveEffect>{}, seed);
}

bool Same(float a, float b) { return std::abs(a - b) < kSameSurface_m; }

scenario::BenchInputs InputsAt(const scenario::Scenario& scenario,
                               const scenario::RecordingPlan& plan, double t_s) {
  scenario::BenchInputs inputs;
  inputs.displacement_m = plan.commands.At(t_s);
  for (const scenario::Tool& tool : scenario.tools) {
    const auto pose = scenario::PoseAt(plan, tool.name, t_s);
    if (pose) inputs.tools.push_back({tool.name, *pose});
  }
  return inputs;
}

}  // namespace

LabelledScene::LabelledScene(const scenario::Scenario& scenario, std::uint64_t seed)
    : scenario_{scenario}, camera_{MakeCamera(scenario, seed)} {
  scenario::Scenario quiet = scenario;
  quiet.camera->noise.sensor = scenario::DepthSensor::kNone;
  without_tools_ = MakeCamera(quiet, seed);
  quiet.stage.table_height_m = -10.0;
  quiet.stage.background_distance_m = 0.0;
  robot_alone_ = MakeCamera(quiet, seed);
}

LabelledScene::~LabelledScene() = default;

void LabelledScene::Take(const virtual_camera::View& view) {
  camera_->Take(view, &frame_);
  virtual_camera::View bare = view;
  bare.tools.clear();
  without_tools_->Take(bare, &unused_);
  robot_alone_->Take(bare, &unused_);
}

Truth LabelledScene::TruthAt(int u_px, int v_px) const {
  const float z_m = *camera_->true_range().Pixel(u_px, v_px);
  if (!Same(z_m, *without_tools_->true_range().Pixel(u_px, v_px))) return Truth::kTool;
  const bool robot = Same(z_m, *robot_alone_->true_range().Pixel(u_px, v_px));
  return robot ? Truth::kRobot : Truth::kBackground;
}

bool LabelledScene::Tells(int u_px, int v_px) const {
  const int raw = *frame_.depth.Pixel(u_px, v_px);
  const auto true_m = static_cast<double>(*camera_->true_range().Pixel(u_px, v_px));
  if (raw == camera().invalid_value || !std::isfinite(true_m)) return false;
  const double largest_m = kSigmas * rgbd::DepthSigma_m(camera(), {}, true_m) + kBias * true_m;
  return std::abs(raw * camera().depth_unit_m - true_m) < largest_m;
}

scenario::Scenario PushScenario() {
  scenario::Scenario scenario =
      scenario::ReadScenario(PALPATE_SOURCE_DIR "/config/scenarios/pushes.yaml", app::LoadYaml);
  scenario.body.refine = 0;
  scenario.motion.time_step_s = 0.5;
  return scenario;
}

virtual_camera::View PushedView(const scenario::Scenario& scenario, const std::string& recording,
                                double t_s) {
  const auto plan = std::find_if(scenario.recordings.begin(), scenario.recordings.end(),
                                 [&recording](const auto& one) { return one.name == recording; });
  if (plan == scenario.recordings.end()) throw std::runtime_error("no recording " + recording);
  virtual_robot::VirtualRobot robot(FourLeg(), scenario, {}, 1);
  Status status = robot.Start(0.0, InputsAt(scenario, *plan, 0.0));
  constexpr double kStep_s = 0.25;
  for (double t = kStep_s; status.ok() && t < t_s + 1e-9; t += kStep_s) {
    status = robot.Advance(t, InputsAt(scenario, *plan, t));
  }
  if (!status.ok()) throw std::runtime_error(status.message());
  virtual_camera::View view;
  view.nodes_m = Eigen::Map<const Eigen::Matrix3Xd>(robot.positions_m().data(), 3,
                                                    robot.positions_m().size() / 3);
  view.tools = InputsAt(scenario, *plan, t_s).tools;
  view.T_robot_camera = scenario.camera->T_robot_camera;
  return view;
}

const virtual_camera::RobotSurface& PushSkin() {
  static const virtual_camera::RobotSurface skin = [] {
    const robot::RobotBody body = robot::BuildRobotBody(FourLeg());
    virtual_camera::RobotSurface made;
    made.rest_m = body.mesh.nodes_m;
    made.triangles = body.boundary.DrawnTriangles();
    made.markers_m.resize(3, static_cast<Eigen::Index>(FourLeg().markers.size()));
    for (std::size_t i = 0; i < FourLeg().markers.size(); ++i) {
      made.markers_m.col(static_cast<Eigen::Index>(i)) = FourLeg().markers[i].position_m;
    }
    return made;
  }();
  return skin;
}

virtual_camera::View RestView(const scenario::Scenario& scenario) {
  virtual_camera::View view;
  view.nodes_m = PushSkin().rest_m;
  view.T_robot_camera = scenario.camera->T_robot_camera;
  return view;
}

PredictedSurface Predict(const scenario::Scenario& scenario, const Eigen::Matrix3Xd& nodes_m,
                         const Eigen::Vector3d& off_m) {
  PredictedSurface predicted;
  const Eigen::Isometry3d T_camera_robot = scenario.camera->T_robot_camera.inverse();
  predicted.vertices_m = (T_camera_robot * nodes_m).colwise() + off_m;
  predicted.triangles = PushSkin().triangles;
  return predicted;
}

Score Compare(const LabelledScene& scene, const PixelRegion& region) {
  Score score;
  int robot_right = 0, called_robot = 0, tool_right = 0;
  const auto& depth = scene.frame().depth;
  for (int v = 0; v < depth.height_px; ++v) {
    for (int u = 0; u < depth.width_px; ++u) {
      const int column = u - region.u_begin, row = v - region.v_begin;
      const bool inside = column >= 0 && column < region.width && row >= 0 && row < region.height;
      const Label label = inside ? region.label[region.At(column, row)] : Label::kBackground;
      const bool measured = *depth.Pixel(u, v) != scene.camera().invalid_value;
      if (!scene.Tells(u, v)) {
        const bool kept = label == Label::kRobot || label == Label::kObject;
        score.mixed_pixels += inside && measured ? 1 : 0;
        score.mixed_kept += kept ? 1 : 0;
        continue;
      }
      const Truth truth = scene.TruthAt(u, v);
      score.robot_pixels += truth == Truth::kRobot ? 1 : 0;
      score.tool_pixels += truth == Truth::kTool ? 1 : 0;
      called_robot += label == Label::kRobot ? 1 : 0;
      score.object_pixels += label == Label::kObject ? 1 : 0;
      robot_right += truth == Truth::kRobot && label == Label::kRobot ? 1 : 0;
      tool_right += truth == Truth::kTool && label == Label::kObject ? 1 : 0;
    }
  }
  const auto share = [](int part, int whole) { return whole > 0 ? 1.0 * part / whole : 1.0; };
  score.robot_recall = share(robot_right, score.robot_pixels);
  score.robot_precision = share(robot_right, called_robot);
  score.tool_recall = share(tool_right, score.tool_pixels);
  score.object_precision = share(tool_right, score.object_pixels);
  return score;
}

void DrawLabels(const std::string& name, const LabelledScene& scene, const PixelRegion& region) {
  const char* folder = std::getenv("PALPATE_PICTURES");
  if (folder == nullptr) return;
  rgbd::ColorImage picture = scene.frame().color;
  for (int v = 0; v < picture.height_px; ++v) {
    for (int u = 0; u < picture.width_px; ++u) {
      std::uint8_t* rgb = picture.Pixel(u, v);
      const int grey = (rgb[0] + rgb[1] + rgb[2]) / 6;
      for (int k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>(grey);
      const int column = u - region.u_begin, row = v - region.v_begin;
      if (column < 0 || column >= region.width || row < 0 || row >= region.height) continue;
      const auto tint = [rgb](int red, int green, int blue) {
        const int add[3] = {red, green, blue};
        for (int k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>(rgb[k] + add[k]);
      };
      switch (region.label[region.At(column, row)]) {
        case Label::kRobot: tint(120, 0, 0); break;
        case Label::kObject: tint(0, 120, 0); break;
        case Label::kMixed: tint(120, 120, 0); break;
        case Label::kAmbiguous: tint(120, 0, 120); break;
        case Label::kSpeck: tint(0, 120, 120); break;
        case Label::kNothing: tint(0, 0, 60); break;
        case Label::kBackground: break;
      }
    }
  }
  std::filesystem::create_directories(folder);
  rgbd::WriteColorPng(std::filesystem::path(folder) / (name + ".png"), picture);
  rgbd::WriteColorPng(std::filesystem::path(folder) / (name + "_color.png"), scene.frame().color);
}

}  // namespace palpate::perception

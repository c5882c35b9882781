// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/sensing_scene.hpp"

#include <cmath>
#include <utility>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/scenario/robot_names.hpp"

namespace palpate::test_support {

namespace {

scenario::Tool Ball(const std::string& name, double radius_m, const Eigen::Vector3d& color_rgb) {
  scenario::Tool ball;
  ball.name = name;
  ball.radius_m = radius_m;
  ball.friction_coefficient = 0.3;
  ball.color_rgb = color_rgb;
  return ball;
}

virtual_camera::RobotSurface SkinOf(const virtual_robot::VirtualRobot& robot) {
  return {.rest_m = robot.mesh().nodes_m,
          .triangles = robot.boundary().DrawnTriangles(),
          .markers_m = robot.MarkerPositions_m()};
}

}  // namespace

scenario::Scenario BallScenario() {
  scenario::Scenario scenario =
      scenario::ReadScenario(PALPATE_SOURCE_DIR "/config/scenarios/pushes.yaml", app::LoadYaml);
  scenario.body =
      scenario::ReadScenario(PALPATE_SOURCE_DIR "/config/scenarios/sensing.yaml", app::LoadYaml)
          .body;
  scenario.tools = {Ball("ball_8", 0.008, {0.15, 0.30, 0.80}),
                    Ball("ball_10", 0.010, {0.15, 0.65, 0.30}),
                    Ball("ball_12", 0.012, {0.80, 0.70, 0.20})};
  scenario::Tool& hand = scenario.tools.emplace_back();
  hand.name = "hand";
  hand.shape = scenario::ToolShape::kHand;
  hand.color_rgb = {0.80, 0.60, 0.50};
  scenario.recordings.resize(1);
  scenario.recordings[0].tool_paths.clear();
  return scenario;
}

scenario::Scenario FingerBallScenario() {
  scenario::Scenario scenario = scenario::ReadScenario(
      PALPATE_SOURCE_DIR "/config/scenarios/pneumatic_finger.yaml", app::LoadYaml);
  scenario.tools = {Ball("ball_5", 0.005, {0.15, 0.30, 0.80}),
                    Ball("ball_6", 0.006, {0.15, 0.65, 0.30}),
                    Ball("ball_7", 0.007, {0.80, 0.70, 0.20})};
  scenario.recordings.resize(1);
  scenario.recordings[0].tool_paths.clear();
  return scenario;
}

std::vector<scenario::FurtherCamera> OppositeCamera() {
  return scenario::ReadScenario(PALPATE_SOURCE_DIR "/config/scenarios/two_cameras.yaml",
                                app::LoadYaml)
      .further_cameras;
}

scenario::Scenario ConvergedBallScenario() {
  scenario::Scenario scenario = BallScenario();
  scenario.body = {};
  scenario.body.refine = 1;
  return scenario;
}

SensingScene::SensingScene(const robot::RobotDescription& robot, const scenario::Scenario& scenario,
                           std::uint64_t seed)
    : scenario_{scenario},
      effects_{scenario::DrawEffects(scenario, scenario::NamesOf(robot), seed)},
      actuators_{robot::ActuatorsOf(robot::BuildRobotBody(robot))},
      robot_{robot, scenario, effects_, seed},
      triangles_{robot_.boundary().DrawnTriangles()},
      cameras_{virtual_camera::MakeCameras(scenario, SkinOf(robot_), effects_, seed)},
      frames_(cameras_.size()) {
  const Status status = Start(Nothing());
  if (!status.ok()) throw RunError("the virtual robot does not hang: " + status.message());
}

scenario::BenchInputs SensingScene::Nothing() const {
  scenario::BenchInputs inputs;
  inputs.displacement_m = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot_.cables().size()));
  return inputs;
}

Status SensingScene::Start(const scenario::BenchInputs& inputs) {
  Status status = robot_.Start(t_s_, inputs);
  if (status.ok()) Read(inputs);
  return status;
}

Status SensingScene::Go(const scenario::BenchInputs& inputs) {
  const double t_s = t_s_ + scenario_.motion.time_step_s;
  Status status = robot_.Advance(t_s, inputs);
  t_s_ = robot_.time_s();
  if (status.ok()) Read(inputs);
  return status;
}

void SensingScene::Read(const scenario::BenchInputs& inputs) {
  const Eigen::VectorXd& x_m = robot_.positions_m();
  state_.inputs = inputs;
  state_.nodes_m = Eigen::Map<const Eigen::Matrix3Xd>(x_m.data(), 3, x_m.size() / 3);
  state_.forces = robot_.forces();
  state_.cables = robot_.cables();
}

const rgbd::RgbdFrame& SensingScene::TakeFrame(std::size_t cameras) {
  virtual_camera::View view;
  view.t_s = static_cast<double>(taken_++) / scenario_.camera->rate_hz;
  view.nodes_m = state_.nodes_m;
  view.tools = state_.inputs.tools;
  for (std::size_t k = 0; k < cameras; ++k) {
    view.T_robot_camera = k == 0 ? T_robot_camera() * unknown_turn_ : T_robot_camera(k);
    cameras_[k]->Take(view, &frames_[k]);
    frames_[k].stamp_ns = std::llround(1e9 * view.t_s);
  }
  return frames_[0];
}

Eigen::Matrix3Xd SensingScene::NodesInCamera_m(std::size_t camera) const {
  return T_robot_camera(camera).inverse() * state_.nodes_m;
}

std::vector<robot::ActuatorCommand> SensingScene::Cables() const {
  std::vector<robot::ActuatorCommand> commands;
  for (std::size_t a = 0; a < state_.cables.size(); ++a) {
    const virtual_robot::CableReading& reading = state_.cables[a];
    using Kind = robot::ActuatorCommand::Kind;
    robot::ActuatorCommand& command = commands.emplace_back();
    if (!std::isfinite(reading.displacement_m)) continue;
    command = actuators_[a].IsChamber()
                  ? robot::ActuatorCommand{Kind::kTension, actuators_[a].Force_N(reading.tension_N)}
                  : robot::ActuatorCommand{Kind::kDisplacement, reading.displacement_m};
  }
  return commands;
}

}  // namespace palpate::test_support

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/rehearsal.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "components/palpate/camera_place.hpp"
#include "components/palpate/new_robot/marker_guess.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::command {

namespace {

constexpr double kRest_s = 4.0;
constexpr double kHold_s = 1.0;
constexpr double kPush_s = 8.0;
constexpr int kHolds = 6;

std::string Point(const Eigen::Vector3d& point_m) {
  return fmt::format("[{:.6f}, {:.6f}, {:.6f}]", point_m.x(), point_m.y(), point_m.z());
}

/// Where a virtual camera stands, and where a ball pushes: on the side that it sees.
struct Stage {
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  Eigen::Vector3d view = Eigen::Vector3d::Zero();  ///< unit, from the body to the camera
  Eigen::Vector3d push_m;                          ///< on the surface
  Eigen::Vector3d normal;                          ///< outward, there
  double radius_m = 0.0;                           ///< of the ball
  double depth_m = 0.0;                            ///< by which it goes beyond the surface at rest
};

/// The face that the camera sees best, about three quarters of the way to the tip.
void ChoosePush(const RobotDraft& draft, Stage* stage) {
  const BodyShape& shape = draft.shape;
  const std::vector<int> faces = FreeFaces(shape, draft.fixed, draft.channels);
  double farthest_m = 0.0;
  for (const int face : faces) {
    farthest_m =
        std::max(farthest_m, (shape.surface.Corner(face, 0) - draft.fixed.centre_m).norm());
  }
  double best = -1e9;
  for (const int face : faces) {
    const Eigen::Vector3d middle_m =
        (shape.surface.Corner(face, 0) + shape.surface.Corner(face, 1) +
         shape.surface.Corner(face, 2)) /
        3.0;
    const double way = (middle_m - draft.fixed.centre_m).norm() / farthest_m;
    const Eigen::Vector3d normal = geometry::TriangleNormal(shape.surface, face);
    const double score = normal.dot(stage->view) - 2.0 * std::abs(way - 0.75);
    if (score <= best) continue;
    best = score;
    stage->push_m = middle_m;
    stage->normal = normal;
  }
}

Stage MakeStage(const RobotDraft& draft) {
  const BodyShape& shape = draft.shape;
  Stage stage;
  const Eigen::Vector3d up = -draft.description.gravity_m_s2.normalized();
  stage.view = ViewDirection(shape.axes.col(0), up, shape.centroid_m - draft.fixed.centre_m);
  stage.T_robot_camera = CameraPlace(shape.box, stage.view, up);
  ChoosePush(draft, &stage);
  stage.radius_m = std::max(0.05 * shape.diagonal_m, shape.element_m);
  // A long body bends away from the ball, a compact one is dented.
  stage.depth_m = (shape.is_long() ? 0.04 : 0.015) * shape.diagonal_m;
  return stage;
}

/// A share of 0.4 to 1 of the pull for each cable and setting, none twice in the same order.
double ShareOf(int hold, std::size_t cable) {
  constexpr double kGolden = 0.6180339887498949;
  const double x = kGolden * (hold + 1) + 0.37 * static_cast<double>(cable);
  return 0.4 + 0.6 * (x - std::floor(x));
}

std::string CommandText(const RobotDraft& draft, double t_s, double pull_m, int hold) {
  std::string text = fmt::format("{{t_s: {:g}", t_s);
  for (std::size_t c = 0; c < draft.cables.size(); ++c) {
    const double own_m = pull_m > 0.0 ? pull_m * ShareOf(hold, c) : 0.0;
    text +=
        ", " + Quoted(draft.cables[c].name + ".displacement_m") + fmt::format(": {:.6f}", own_m);
  }
  return text + "}";
}

std::string RecordingText(const RobotDraft& draft, const std::string& name, const std::string& kind,
                          double duration_s, double pull_m, int hold) {
  std::string text =
      fmt::format("  - name: {}\n    kind: {}\n    duration_s: {:g}\n", name, kind, duration_s);
  if (!draft.cables.empty()) {
    text += "    commands: [" + CommandText(draft, 0.0, pull_m, hold) + "]\n";
  }
  return text;
}

std::string PushText(const Stage& stage) {
  const auto at = [&](double t_s, double beyond_m) {
    const Eigen::Vector3d ball_m = stage.push_m + (stage.radius_m - beyond_m) * stage.normal;
    return fmt::format("          - {{t_s: {:g}, position_m: {}}}\n", t_s, Point(ball_m));
  };
  const double away_m = 3.0 * stage.radius_m;
  return "    tools:\n      - tool: ball\n        path:\n" + at(1.0, -away_m) +
         at(2.0, -0.2 * stage.radius_m) + at(4.0, stage.depth_m) + at(6.0, stage.depth_m) +
         at(7.0, -away_m);
}

std::string ScenarioText(const RobotDraft& draft, const Stage& stage) {
  const double pull_m = 0.02 * draft.shape.diagonal_m;
  std::string text =
      "# Rehearsal of " + draft.description.name +
      ", written by palpate new-robot: a virtual robot and camera, without hardware.\n"
      "# At rest, " +
      std::to_string(draft.cables.empty() ? 0 : kHolds) +
      " settings of the cables for palpate calibrate, then a ball pushes.\n"
      "name: rehearsal\nbody: {refine: 0}\n"
      "motion: {mode: quasi_static, time_step_s: 0.05}\nclutter: 0\n";
  if (!draft.cables.empty())
    text += "effects:  # zero offsets of the actuators, drawn by the seed\n";
  for (const CableRoute& route : draft.cables) {
    text += "  - {id: cable_offset, where: " + Quoted("cable:" + route.name) +
            fmt::format(", offset_m: [{:.6f}, {:.6f}]}}\n", -0.1 * pull_m, 0.1 * pull_m);
  }
  text += fmt::format(
      "tools:\n  - {{name: ball, shape: sphere, radius_m: {:.6f}, "
      "friction_coefficient: 0.3, color_rgb: [0.15, 0.30, 0.80]}}\n",
      stage.radius_m);
  text += StereoCameraText(stage.T_robot_camera, 10.0);
  if (!draft.description.markers.empty()) text += "markers: {sigma_m: 3.0e-4, rate_hz: 10}\n";
  text +=
      "rest_between_s: 1\nrecordings:\n" + RecordingText(draft, "01_rest", "rest", kRest_s, 0.0, 0);
  for (int hold = 0; !draft.cables.empty() && hold < kHolds; ++hold) {
    text +=
        RecordingText(draft, fmt::format("{:02}_hold", hold + 2), "hold", kHold_s, pull_m, hold);
  }
  text += RecordingText(draft, fmt::format("{:02}_push", kHolds + 2), "free", kPush_s, 0.0, 0);
  return text + PushText(stage);
}

std::string SystemText(const RobotDraft& draft, const Stage& stage, const std::string& robot_file,
                       const std::string& scenario_file, const std::string& calibration_file) {
  std::string text = "# The whole system with a virtual " + draft.description.name +
                     ", written by palpate new-robot. With hardware: delete the virtual robot and\n"
                     "# camera, and give the address of your camera and its pose.\n"
                     "name: rehearsal\ntransport: one_host\nvariables:\n"
                     "  robot: $(dirname)/" +
                     robot_file + "\n  scenario: $(dirname)/" + scenario_file +
                     "\n  calibration: $(dirname)/" + calibration_file +
                     "\n  camera_address: 127.41.0.1\n  camera_pose: " +
                     Quoted(geometry::FormatPose(stage.T_robot_camera)) + "\n";
  return text + R"yaml(hosts:
  - name: this_machine
    processes:
      - name: virtual_camera
        component: virtual_camera
        arguments: [$(robot), --scenario, $(scenario)]
        set: {interface_address: $(camera_address)}
        required: true
      - name: capture
        component: capture
        set: {genicam.camera_id: "$(camera_address)"}
        after: [virtual_camera]
        required: true
        respawn: {}
      - name: perception
        component: perception
        set: {camera_pose: "$(camera_pose)"}
        required: true
        respawn: {}
      - name: force_estimation
        component: force_estimation
        arguments: [$(robot), --calibration, $(calibration)]
        set: {source: shape}
        required: true
        respawn: {}
      - name: view
        component: view
        arguments: [$(robot)]
        respawn: {}
      - name: virtual_robot
        component: virtual_robot
        arguments: [$(robot), --scenario, $(scenario)]
        after: [virtual_camera, capture, perception, force_estimation]
        required: true
)yaml";
}

std::string ActuationText(const RobotDraft& draft) {
  if (draft.cables.empty()) return "";
  const double pull_m = 0.01 * draft.shape.diagonal_m;
  std::string text = "t_s";
  for (const CableRoute& route : draft.cables) text += "," + route.name + ".displacement_m";
  for (std::size_t row = 0; row <= draft.cables.size(); ++row) {
    text += "\n" + std::to_string(row);
    for (std::size_t c = 0; c < draft.cables.size(); ++c) {
      text += c + 1 == row ? fmt::format(",{:.6f}", pull_m) : ",0";
    }
  }
  return text + "\n";
}

}  // namespace

Rehearsal MakeRehearsal(const RobotDraft& draft, const std::string& robot_file,
                        const std::string& scenario_file, const std::string& calibration_file) {
  const Stage stage = MakeStage(draft);
  return {.scenario = ScenarioText(draft, stage),
          .system = SystemText(draft, stage, robot_file, scenario_file, calibration_file),
          .camera_pose = geometry::FormatPose(stage.T_robot_camera),
          .actuation = ActuationText(draft)};
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/touches/touch_scenario.hpp"

#include <fmt/core.h>

#include <cmath>

#include "components/palpate/camera_place.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

constexpr double kDuration_s = 30.0;
// A state of the virtual robot takes 4 ms of a core with 3500 nodes, and grows faster than they do.
constexpr int kQuickNodes = 4000;
constexpr double kQuickRate_hz = 30.0;
constexpr double kSlowRate_hz = 10.0;

std::string Waypoint(double t_s, const Eigen::Vector3d& ball_m) {
  return fmt::format("          - {{t_s: {:g}, position_m: [{:.5f}, {:.5f}, {:.5f}]}}\n", t_s,
                     ball_m.x(), ball_m.y(), ball_m.z());
}

/// Comes, presses, holds until `hold_until_s`, and goes.
std::string PathText(const Touch& touch, double start_s, double hold_until_s) {
  return Waypoint(start_s, touch.away_m) + Waypoint(start_s + 0.8, touch.near_m) +
         Waypoint(start_s + 2.2, touch.pressed_m) + Waypoint(hold_until_s, touch.pressed_m) +
         Waypoint(hold_until_s + 1.0, touch.near_m) + Waypoint(hold_until_s + 1.6, touch.away_m);
}

std::string CommandText(double t_s, const std::vector<ActuatorSetting>& settings, double share) {
  std::string text = fmt::format("      - {{t_s: {:g}", t_s);
  for (const ActuatorSetting& setting : settings) {
    const std::string key =
        setting.name + (setting.is_chamber ? ".pressure_Pa" : ".displacement_m");
    text += ", " + Quoted(key) + ": " +
            (setting.is_chamber ? fmt::format("{:.0f}", share * setting.value)
                                : fmt::format("{:.5f}", share * setting.value));
  }
  return text + "}\n";
}

std::string CommandsText(const std::vector<ActuatorSetting>& settings) {
  if (settings.empty()) return "";
  return "    commands:\n" + CommandText(0.0, settings, 0.0) + CommandText(20.0, settings, 0.0) +
         CommandText(22.0, settings, 1.0) + CommandText(28.0, settings, 1.0) +
         CommandText(kDuration_s, settings, 0.0);
}

std::string ToolsText(const TouchPlan& plan) {
  std::string text = "    tools:\n      - tool: blue_ball  # in view\n        path:\n" +
                     PathText(plan.visible, 4.0, 7.2);
  if (plan.second) {
    text += "          # first of two\n" + PathText(plan.visible, 13.5, 17.6);
  }
  if (plan.hidden) {
    text +=
        "      - tool: green_ball  # on the side that the camera does not see\n        path:\n" +
        PathText(*plan.hidden, 9.0, 12.0);
  }
  const std::string red =
      plan.second || plan.driven ? "      - tool: red_ball\n        path:\n" : "";
  text += red;
  if (plan.second) text += "          # second of two\n" + PathText(*plan.second, 14.2, 16.8);
  if (plan.driven)
    text += "          # while the actuators hold a posture\n" + PathText(*plan.driven, 22.2, 26.0);
  return text;
}

/// Of what the robot stands on, or well below one that hangs or is clamped at its side.
double TableHeight_m(const robot::RobotBody& body) {
  const double lowest_m = body.mesh.nodes_m.row(2).minCoeff();
  const double highest_m = body.mesh.nodes_m.row(2).maxCoeff();
  bool stands = false;
  for (Eigen::Index node = 0; node < body.fixed.cols(); ++node) {
    const bool low = body.mesh.nodes_m(2, node) - lowest_m < 0.01 * (highest_m - lowest_m);
    stands = stands || (low && body.fixed.col(node).all());
  }
  const double reach_m =
      (body.mesh.nodes_m.rowwise().maxCoeff() - body.mesh.nodes_m.rowwise().minCoeff()).norm();
  return stands ? lowest_m : lowest_m - 0.5 * reach_m;
}

}  // namespace

std::string TouchScenario(const robot::RobotBody& body, const TouchPlan& plan) {
  std::string text = "# Touches on " + body.name +
                     ", derived by palpate from its size and stiffness: rest, a ball in view, one\n"
                     "# out of view, two at once, and one while the actuators hold a posture.\n";
  text += fmt::format(
      "# Pushes along the normal, about: {:.3f} N in view{}{}{}.\n", plan.visible.force_N,
      plan.hidden ? fmt::format(", {:.3f} N hidden", plan.hidden->force_N) : "",
      plan.second ? fmt::format(", {:.3f} N beside it", plan.second->force_N) : "",
      plan.driven ? fmt::format(", {:.3f} N under actuation", plan.driven->force_N) : "");
  text += "name: touches\nbody: {refine: 0}\n";
  const double rate_hz = body.mesh.NodeCount() <= kQuickNodes ? kQuickRate_hz : kSlowRate_hz;
  text += "motion: {mode: quasi_static, time_step_s: 0.034}\n";
  text += "clutter: 0\ntools:\n";
  const auto ball = [&](const char* name, const char* color) {
    text += fmt::format(
        "  - {{name: {}, shape: sphere, radius_m: {:.5f}, friction_coefficient: 0.3, color_rgb: "
        "{}}}\n",
        name, plan.ball_radius_m, color);
  };
  ball("blue_ball", "[0.15, 0.30, 0.80]");
  ball("green_ball", "[0.15, 0.65, 0.30]");
  ball("red_ball", "[0.85, 0.30, 0.25]");
  text += StereoCameraText(plan.T_robot_camera, rate_hz);
  text += fmt::format("stage: {{table_height_m: {:.5f}}}\n", TableHeight_m(body));
  text += fmt::format(
      "rest_between_s: 0\nrecordings:\n  - name: 01_touches\n    kind: free\n    duration_s: "
      "{:g}\n",
      kDuration_s);
  return text + CommandsText(plan.settings) + ToolsText(plan);
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/support/sensing/paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/virtual_camera/hand.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

namespace palpate::test_support {

namespace {

constexpr int kWeightSteps = 8;
constexpr double kFar_m = 0.15;  ///< of the hand in the beginning and in the end
constexpr int kBisections = 30;

const scenario::Tool& HandOf(const scenario::Scenario& scenario) {
  const auto hand = std::find_if(
      scenario.tools.begin(), scenario.tools.end(),
      [](const scenario::Tool& tool) { return tool.shape == scenario::ToolShape::kHand; });
  PALPATE_CHECK(hand != scenario.tools.end(), "no hand");
  return *hand;
}

/// Fingers (x) along -`from`, the palm down as far as that leaves.
Eigen::Isometry3d Pointing(const Eigen::Vector3d& from, const Eigen::Vector3d& fingers_at_m) {
  Eigen::Isometry3d T_robot_hand = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d x = -from;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitZ().cross(x).normalized();
  T_robot_hand.linear().col(0) = x;
  T_robot_hand.linear().col(1) = y;
  T_robot_hand.linear().col(2) = x.cross(y);
  T_robot_hand.translation() = fingers_at_m;
  return T_robot_hand;
}

}  // namespace

std::vector<SceneState> HangWeight(SensingScene& scene, const Eigen::Vector3d& position_m,
                                   double force_N, double patch_radius_m) {
  const auto expect = [](const Status& status) {
    if (!status.ok()) throw RunError("the weight does not hang: " + status.message());
  };
  scenario::BenchInputs inputs = scene.Nothing();
  expect(scene.Start(inputs));
  std::vector<SceneState> path = {scene.state()};
  constexpr double kGravity_m_s2 = 9.81;
  for (int step = 1; step <= kWeightSteps; ++step) {
    inputs.weights = {{.t_s = 0.0,
                       .position_m = position_m,
                       .mass_kg = force_N / kGravity_m_s2 * step / kWeightSteps,
                       .patch_radius_m = patch_radius_m}};
    expect(scene.Go(inputs));
    path.push_back(scene.state());
  }
  return path;
}

double HandDistance_m(const Eigen::Isometry3d& T_robot_hand, const Eigen::Matrix3Xd& nodes_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const auto& bone : virtual_camera::MakeHand(T_robot_hand, 0)) {
    const Eigen::Matrix3Xd in_bone_m = bone.T_robot_shape.inverse() * nodes_m;
    for (Eigen::Index k = 0; k < in_bone_m.cols(); ++k) {
      Eigen::Vector3d to_axis_m = in_bone_m.col(k);
      to_axis_m.z() -= std::clamp(to_axis_m.z(), -bone.half_length_m, bone.half_length_m);
      nearest_m = std::min(nearest_m, to_axis_m.norm() - bone.radius_m);
    }
  }
  return nearest_m;
}

std::vector<SceneState> HandComesNear(const SensingScene& scene, double nearest_m, int frames,
                                      scenario::Random* random) {
  const double azimuth_rad = 2.0 * std::numbers::pi * random->Uniform();
  const double height = 0.3 + 0.6 * random->Uniform();
  const double level = std::sqrt(1.0 - height * height);
  const Eigen::Vector3d from(level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), height);
  const Eigen::Vector3d at_m(0.0, 0.0, 0.09);
  const auto pose = [&](double away_m) { return Pointing(from, at_m + away_m * from); };
  double inside_m = 0.0;
  double outside_m = 0.5;
  for (int k = 0; k < kBisections; ++k) {
    const double middle_m = 0.5 * (inside_m + outside_m);
    const bool is_near = HandDistance_m(pose(middle_m), scene.state().nodes_m) < nearest_m;
    (is_near ? inside_m : outside_m) = middle_m;
  }
  std::vector<SceneState> path;
  for (int frame = 0; frame < frames; ++frame) {
    const double turn = 2.0 * std::numbers::pi * frame / frames;
    SceneState& state = path.emplace_back(scene.state());
    state.inputs.tools = {
        {.tool = HandOf(scene.scenario()).name,
         .T_robot_tool = pose(outside_m + 0.5 * kFar_m * (1.0 + std::cos(turn)))}};
  }
  return path;
}

}  // namespace palpate::test_support

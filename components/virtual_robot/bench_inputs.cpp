// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/bench_inputs.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace palpate::virtual_robot {

namespace {

Status Refused(const std::string& reason) { return {StatusCode::kInvalidInput, reason}; }

bool IsRigid(const Eigen::Isometry3d& T) {
  constexpr double kTolerance = 1e-6;
  const Eigen::Matrix3d R = T.linear();
  return T.matrix().allFinite() && (R.transpose() * R).isIdentity(kTolerance) &&
         R.determinant() > 0.0;
}

Status CheckTools(const std::vector<ToolPose>& poses, const std::vector<scenario::Tool>& tools) {
  std::set<std::string> seen;
  for (const ToolPose& pose : poses) {
    const bool known = std::any_of(tools.begin(), tools.end(), [&](const scenario::Tool& tool) {
      return tool.name == pose.tool;
    });
    if (!known) return Refused("the scenario has no tool '" + pose.tool + "'");
    if (!seen.insert(pose.tool).second) return Refused("tool " + pose.tool + " is named twice");
    if (!IsRigid(pose.T_robot_tool)) {
      return Refused("the pose of tool " + pose.tool + " is no rigid motion");
    }
  }
  return Status::Ok();
}

}  // namespace

BenchInputs Between(const BenchInputs& from, const BenchInputs& to, double fraction) {
  BenchInputs between = to;
  if (fraction >= 1.0) return between;
  for (Eigen::Index c = 0; c < to.command_m.size(); ++c) {
    const double start_m = from.command_m[c];
    if (std::isnan(start_m) || std::isnan(to.command_m[c])) continue;
    between.command_m[c] = start_m + fraction * (to.command_m[c] - start_m);
  }
  between.load_N = from.load_N + fraction * (to.load_N - from.load_N);
  for (size_t k = 0; k < to.pose.size(); ++k) {
    if (!from.pose[k] || !to.pose[k]) continue;
    const Eigen::Quaterniond start(from.pose[k]->linear());
    const Eigen::Quaterniond end(to.pose[k]->linear());
    between.pose[k]->linear() = start.slerp(fraction, end).toRotationMatrix();
    between.pose[k]->translation() =
        from.pose[k]->translation() +
        fraction * (to.pose[k]->translation() - from.pose[k]->translation());
  }
  return between;
}

Status CheckInputs(const Inputs& inputs, int actuators, const std::vector<scenario::Tool>& tools) {
  if (inputs.displacement_m.size() != actuators) {
    return Refused(std::to_string(inputs.displacement_m.size()) +
                   " commands are given, the robot has " + std::to_string(actuators) +
                   " cables and chambers");
  }
  if (inputs.displacement_m.array().isInf().any()) return Refused("a command is infinite");
  if (!inputs.base_tilt_deg.allFinite()) return Refused("the tilt of the base is not finite");
  for (const scenario::HungWeight& weight : inputs.weights) {
    if (!weight.position_m.allFinite() || !std::isfinite(weight.mass_kg) ||
        !std::isfinite(weight.patch_radius_m) || weight.mass_kg < 0.0 ||
        weight.patch_radius_m < 0.0) {
      return Refused("a weight's position, mass or patch radius is not finite or negative");
    }
  }
  return CheckTools(inputs.tools, tools);
}

double Travel_m(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double radius_m) {
  const Eigen::AngleAxisd turned(from.linear().transpose() * to.linear());
  return (to.translation() - from.translation()).norm() + std::abs(turned.angle()) * radius_m;
}

}  // namespace palpate::virtual_robot

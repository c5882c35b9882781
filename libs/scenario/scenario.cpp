// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/scenario/scenario.hpp"

#include <algorithm>

#include "libs/core/check.hpp"
#include "libs/core/text.hpp"
#include "libs/scenario/effect_places.hpp"

namespace palpate::scenario {

namespace {

using Where = std::vector<std::string>;

/// Between the entries `before` and `after` (times rising), share 0 to 1 of the way.
struct Bracket {
  std::size_t before = 0;
  std::size_t after = 0;
  double share = 0.0;
};

/// Where `t_s` lies among the entries; outside them: at the nearest.
template <typename Entry>
Bracket Find(const std::vector<Entry>& entries, double t_s) {
  const auto later = std::upper_bound(entries.begin(), entries.end(), t_s,
                                      [](double t, const Entry& entry) { return t < entry.t_s; });
  const auto index = static_cast<std::size_t>(later - entries.begin());
  if (later == entries.begin()) return {};
  if (later == entries.end()) return {index - 1, index - 1, 0.0};
  const double before_s = entries[index - 1].t_s;
  return {index - 1, index, (t_s - before_s) / (later->t_s - before_s)};
}

void CheckPlace(const Effect& effect, const std::vector<Where>& places) {
  std::vector<std::string> names;
  for (const Where& place : places) names.insert(names.end(), place.begin(), place.end());
  for (const std::string& name : effect.where) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InputError(effect.location, "effect '" + effect.id + "': the robot has no " + name +
                                          DidYouMean(name, names));
  }
}

void CheckEffect(const Scenario& scenario, const Effect& effect, const RobotNames& robot) {
  const EffectKind* kind = FindEffect(effect.id);
  PALPATE_CHECK(kind != nullptr, effect.id);
  const std::vector<Where> places = PlacesOn(*kind, robot);
  CheckPlace(effect, places);
  const auto count = static_cast<std::size_t>(
      std::count_if(scenario.effects.begin(), scenario.effects.end(),
                    [&](const Effect& other) { return other.id == effect.id; }));
  if (count > places.size()) {
    throw InputError(effect.location, "effect '" + effect.id + "' is wanted " +
                                          std::to_string(count) + " times, and the robot has " +
                                          std::to_string(places.size()) + " places for it (" +
                                          DescribePlace(kind->place) + ")");
  }
}

}  // namespace

Eigen::VectorXd CommandScript::At(double t_s) const {
  if (rows.empty()) return {};
  const Bracket bracket = Find(rows, t_s);
  const Eigen::VectorXd& before_m = rows[bracket.before].displacement_m;
  if (bracket.share == 0.0) return before_m;
  return before_m + bracket.share * (rows[bracket.after].displacement_m - before_m);
}

const Tool& Scenario::ToolNamed(const std::string& wanted) const {
  const auto found = std::find_if(tools.begin(), tools.end(),
                                  [&](const Tool& tool) { return tool.name == wanted; });
  PALPATE_CHECK(found != tools.end(), wanted);
  return *found;
}

std::vector<std::string> RobotNames::Actuators() const {
  std::vector<std::string> names = cables;
  names.insert(names.end(), chambers.begin(), chambers.end());
  return names;
}

void CheckAgainst(const Scenario& scenario, const RobotNames& robot) {
  for (const Effect& effect : scenario.effects) CheckEffect(scenario, effect, robot);
  for (const ChamberSupply& supply : scenario.supply) {
    const std::vector<std::string>& names = robot.chambers;
    if (std::find(names.begin(), names.end(), supply.chamber) != names.end()) continue;
    throw InputError(supply.location, "supply: the robot has no chamber '" + supply.chamber + "'" +
                                          DidYouMean(supply.chamber, names));
  }
  for (const RecordingPlan& plan : scenario.recordings) {
    for (std::size_t c = 0; c < plan.commands.cables.size(); ++c) {
      const std::string& name = plan.commands.cables[c];
      const bool of_chamber = c < plan.commands.of_chamber.size() && plan.commands.of_chamber[c];
      const std::vector<std::string>& names = of_chamber ? robot.chambers : robot.cables;
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      throw InputError(plan.location, "recording '" + plan.name + "': the robot has no " +
                                          (of_chamber ? "chamber '" : "cable '") + name + "'" +
                                          DidYouMean(name, names));
    }
  }
}

std::vector<double> Scenario::RecordingBegins_s() const {
  std::vector<double> begins_s;
  double end_s = 0.0;
  for (const RecordingPlan& plan : recordings) {
    begins_s.push_back(end_s + rest_between_s);
    end_s = begins_s.back() + plan.duration_s;
  }
  return begins_s;
}

Scenario Scenario::WithCamera(std::size_t number) const {
  Scenario alone = *this;
  if (number > 0) alone.camera = further_cameras.at(number - 1);
  alone.further_cameras.clear();
  return alone;
}

std::optional<Eigen::Isometry3d> PoseAt(const RecordingPlan& plan, const std::string& tool,
                                        double t_s) {
  const auto path = std::find_if(plan.tool_paths.begin(), plan.tool_paths.end(),
                                 [&](const ToolPath& other) { return other.tool == tool; });
  if (path == plan.tool_paths.end()) return std::nullopt;
  const Bracket bracket = Find(path->waypoints, t_s);
  const Eigen::Isometry3d& before = path->waypoints[bracket.before].T_robot_tool;
  if (bracket.share == 0.0) return before;
  const Eigen::Isometry3d& after = path->waypoints[bracket.after].T_robot_tool;
  const Eigen::Vector3d position_m =
      before.translation() + bracket.share * (after.translation() - before.translation());
  const Eigen::Quaterniond rotation =
      Eigen::Quaterniond(before.linear()).slerp(bracket.share, Eigen::Quaterniond(after.linear()));
  return Eigen::Translation3d(position_m) * rotation;
}

}  // namespace palpate::scenario

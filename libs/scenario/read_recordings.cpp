// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <limits>

#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/rigid_transform.hpp"
#include "libs/scenario/scenario_sections.hpp"

namespace palpate::scenario {

namespace {

constexpr std::string_view kDisplacement = ".displacement_m";
constexpr std::string_view kPressure = ".pressure_Pa";
constexpr double kNotDriven = std::numeric_limits<double>::quiet_NaN();

/// `t_s` of an entry of a list: within the recording, and later than that of the entry before it
/// (`last_s`), or as late where `may_equal`.
double ReadTime(MapReader& reader, double duration_s, double last_s, bool may_equal = false) {
  const ConfigNode& node = reader.Require("t_s");
  const double t_s = ReadNumber(node, {.min = 0.0, .max = duration_s});
  if (t_s < last_s || (t_s == last_s && !may_equal)) {
    Refuse(node, "time must rise, and " + FormatNumber(t_s) + " follows " + FormatNumber(last_s));
  }
  return t_s;
}

/// The actuators that a row names, in its order.
CommandScript NamesOfRow(const ConfigNode& row) {
  CommandScript names;
  for (const auto& [key, node] : row.entries) {
    if (key == "t_s") continue;
    const bool of_chamber = key.ends_with(kPressure);
    const std::string_view suffix = of_chamber ? kPressure : kDisplacement;
    if (key.size() <= suffix.size() || !key.ends_with(suffix)) {
      throw InputError(node.key_where, "unknown key '" + node.path +
                                           "': a command is '<cable>.displacement_m', in metres, "
                                           "or '<chamber>.pressure_Pa', in pascals");
    }
    names.cables.push_back(key.substr(0, key.size() - suffix.size()));
    names.of_chamber.push_back(of_chamber);
  }
  return names;
}

CommandRow ReadCommandRow(const ConfigNode& node, const CommandScript& names, double duration_s,
                          double last_s) {
  MapReader reader(node, CommandRowKeys());
  CommandRow row;
  row.t_s = ReadTime(reader, duration_s, last_s);
  row.displacement_m.resize(ToIndex(names.cables.size()));
  for (std::size_t i = 0; i < names.cables.size(); ++i) {
    const std::string key =
        names.cables[i] + std::string(names.of_chamber[i] ? kPressure : kDisplacement);
    const ConfigNode* value = node.Find(key);
    if (value == nullptr) {
      Refuse(node, "'" + key + "' is missing: every row names the actuators of the first (one " +
                       "that is not driven has the value ~)");
    }
    double& displacement_m = row.displacement_m[ToIndex(i)];
    displacement_m = kNotDriven;
    reader.Read(key, &displacement_m);
  }
  reader.Finish();
  return row;
}

CommandScript ReadCommands(const ConfigNode& node, double duration_s) {
  CommandScript script;
  double last_s = -1.0;
  for (const ConfigNode& item :
       ReadList(node, "{t_s, <cable>.displacement_m, <chamber>.pressure_Pa}")) {
    const CommandScript names = NamesOfRow(item);
    if (script.rows.empty()) script = names;
    if (script.cables.empty()) Refuse(item, "names neither a cable nor a chamber");
    script.rows.push_back(ReadCommandRow(item, script, duration_s, last_s));
    last_s = script.rows.back().t_s;
  }
  return script;
}

Waypoint ReadWaypoint(const ConfigNode& node, double duration_s, double last_s) {
  MapReader reader(node, WaypointKeys());
  Waypoint waypoint;
  waypoint.t_s = ReadTime(reader, duration_s, last_s);
  Eigen::Vector3d position_m;
  reader.Read("position_m", &position_m);
  waypoint.T_robot_tool.translation() = position_m;
  if (const ConfigNode* angles = reader.Optional("rotation_xyz_deg")) {
    waypoint.T_robot_tool.linear() = geometry::RotationFromFixedXyz_deg(ReadVector3(*angles));
  }
  reader.Finish();
  return waypoint;
}

ToolPath ReadToolPath(const ConfigNode& node, const std::vector<Tool>& tools, double duration_s) {
  MapReader reader(node, ToolPathKeys());
  ToolPath path;
  std::vector<std::string> names;
  for (const Tool& tool : tools) names.push_back(tool.name);
  const ConfigNode& tool = reader.Require("tool");
  path.tool = ReadText(tool);
  if (std::find(names.begin(), names.end(), path.tool) == names.end()) {
    Refuse(tool, "there is no tool '" + path.tool + "'" + DidYouMean(path.tool, names));
  }
  const ConfigNode& waypoints = reader.Require("path");
  double last_s = -1.0;
  for (const ConfigNode& item : ReadList(waypoints, "{t_s, position_m, rotation_xyz_deg}")) {
    path.waypoints.push_back(ReadWaypoint(item, duration_s, last_s));
    last_s = path.waypoints.back().t_s;
  }
  if (path.waypoints.empty()) Refuse(waypoints, "needs at least one waypoint");
  reader.Finish();
  return path;
}

std::vector<ToolPath> ReadToolPaths(const ConfigNode& node, const std::vector<Tool>& tools,
                                    double duration_s) {
  std::vector<ToolPath> paths;
  for (const ConfigNode& item : ReadList(node, "{tool, path}")) {
    ToolPath path = ReadToolPath(item, tools, duration_s);
    const bool again = std::any_of(paths.begin(), paths.end(),
                                   [&](const ToolPath& other) { return other.tool == path.tool; });
    if (again) Refuse(item, "a second path of the tool '" + path.tool + "'");
    paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<HungWeight> ReadWeights(const ConfigNode& node, double duration_s) {
  std::vector<HungWeight> weights;
  double last_s = 0.0;
  for (const ConfigNode& item : ReadList(node, "{t_s, position_m, mass_kg}")) {
    MapReader reader(item, HungWeightKeys());
    HungWeight weight;
    weight.t_s = ReadTime(reader, duration_s, last_s, /*may_equal=*/true);
    reader.Read("position_m", &weight.position_m);
    reader.Read("mass_kg", &weight.mass_kg);
    reader.Read("patch_radius_m", &weight.patch_radius_m);
    reader.Finish();
    last_s = weight.t_s;
    weights.push_back(weight);
  }
  return weights;
}

Eigen::Vector2d ReadTilt(const ConfigNode& node) {
  const NumberRule& rule = RecordingPlanKeys().Find("base_tilt_deg")->type.parts[0].rule;
  const std::vector<double> angles_deg = ReadNumbers(node, rule);
  if (angles_deg.size() != 2) Refuse(node, "must be [about x, about y] in degrees");
  return {angles_deg[0], angles_deg[1]};
}

/// The name becomes that of a folder.
std::string ReadName(const ConfigNode& node) {
  const std::string name = ReadText(node);
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  });
  if (name.empty() || name.front() == '.' || !plain) {
    Refuse(node, "'" + name +
                     "' becomes the name of a folder: letters, digits, '_', '-' and '.', "
                     "not '.' first");
  }
  return name;
}

RecordingPlan ReadRecording(const ConfigNode& node, const Scenario& scenario) {
  MapReader reader(node, RecordingPlanKeys());
  RecordingPlan plan;
  plan.location = node.where;
  plan.name = ReadName(reader.Require("name"));
  reader.Read("kind", &plan.kind);
  reader.Read("duration_s", &plan.duration_s);
  if (const ConfigNode* commands = reader.Optional("commands")) {
    plan.commands = ReadCommands(*commands, plan.duration_s);
  }
  if (const ConfigNode* tools = reader.Optional("tools")) {
    plan.tool_paths = ReadToolPaths(*tools, scenario.tools, plan.duration_s);
  }
  if (const ConfigNode* weights = reader.Optional("weights")) {
    plan.weights = ReadWeights(*weights, plan.duration_s);
  }
  if (const ConfigNode* tilt = reader.Optional("base_tilt_deg"))
    plan.base_tilt_deg = ReadTilt(*tilt);
  plan.T_robot_camera = ReadCameraPose(reader);
  if (plan.T_robot_camera && !scenario.camera) Refuse(node, "the scenario has no camera to move");
  reader.Read("notes", &plan.notes);
  reader.Finish();
  return plan;
}

}  // namespace

std::vector<RecordingPlan> ReadRecordings(const ConfigNode& node, const Scenario& scenario) {
  std::vector<RecordingPlan> plans;
  for (const ConfigNode& item : ReadList(node, "recordings")) {
    RecordingPlan plan = ReadRecording(item, scenario);
    if (!plans.empty() && plan.name <= plans.back().name) {
      Refuse(item, "'" + plan.name + "' must sort after '" + plans.back().name +
                       "': recordings are made in the order of their names");
    }
    plans.push_back(std::move(plan));
  }
  if (plans.empty()) Refuse(node, "needs at least one recording");
  return plans;
}

}  // namespace palpate::scenario

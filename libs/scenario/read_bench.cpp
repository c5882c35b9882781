// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "libs/scenario/scenario_sections.hpp"

namespace palpate::scenario {

namespace {

ToolShape ReadShape(MapReader& reader) {
  std::string word;
  reader.Read("shape", &word);
  if (word == "sphere") return ToolShape::kSphere;
  if (word == "cylinder") return ToolShape::kCylinder;
  return word == "plate" ? ToolShape::kPlate : ToolShape::kHand;
}

Tool ReadTool(const ConfigNode& node) {
  MapReader reader(node, ToolKeys());
  Tool tool;
  reader.Read("name", &tool.name);
  tool.shape = ReadShape(reader);
  const bool is_cylinder = tool.shape == ToolShape::kCylinder;
  if (tool.shape == ToolShape::kSphere || is_cylinder) reader.Read("radius_m", &tool.radius_m);
  if (is_cylinder) reader.Read("length_m", &tool.length_m);
  if (tool.shape == ToolShape::kPlate) reader.Read("size_m", &tool.size_m);
  if (tool.shape != ToolShape::kHand) {
    reader.Read("friction_coefficient", &tool.friction_coefficient);
  }
  reader.Read("color_rgb", &tool.color_rgb);
  reader.Finish();
  return tool;
}

Eigen::Vector2d ReadSize(const ConfigNode& node) {
  const std::vector<double> edges_m = ReadNumbers(node, kPositive);
  if (edges_m.size() != 2) Refuse(node, "must be [along x, along y]");
  return {edges_m[0], edges_m[1]};
}

}  // namespace

std::vector<Tool> ReadTools(const ConfigNode& node) {
  std::vector<Tool> tools;
  for (const ConfigNode& item : ReadList(node, "tools")) {
    Tool tool = ReadTool(item);
    const bool again = std::any_of(tools.begin(), tools.end(),
                                   [&](const Tool& other) { return other.name == tool.name; });
    if (again) Refuse(item, "there are two tools '" + tool.name + "'");
    tools.push_back(std::move(tool));
  }
  return tools;
}

Stage ReadStage(const ConfigNode& node) {
  MapReader reader(node, StageKeys());
  Stage stage;
  reader.Read("table_height_m", &stage.table_height_m);
  if (const ConfigNode* size = reader.Optional("table_size_m")) {
    stage.table_size_m = ReadSize(*size);
  }
  reader.Read("table_color_rgb", &stage.table_color_rgb);
  reader.Read("background_distance_m", &stage.background_distance_m);
  reader.Read("background_color_rgb", &stage.background_color_rgb);
  reader.Read("robot_color_rgb", &stage.robot_color_rgb);
  reader.Read("marker_radius_m", &stage.marker_radius_m);
  reader.Read("marker_color_rgb", &stage.marker_color_rgb);
  reader.Read("light", &stage.light);
  reader.Finish();
  return stage;
}

}  // namespace palpate::scenario

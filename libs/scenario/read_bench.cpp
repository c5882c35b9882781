// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "libs/scenario/scenario_sections.hpp"

namespace palpate::scenario {

namespace {

constexpr NumberRule kLength{.min = 0.0, .max = 2.0, .min_open = true};

ToolShape ReadShape(const ConfigNode& node) {
  const std::string word = ReadChoice(node, {"sphere", "cylinder", "plate", "hand"});
  if (word == "sphere") return ToolShape::kSphere;
  if (word == "cylinder") return ToolShape::kCylinder;
  return word == "plate" ? ToolShape::kPlate : ToolShape::kHand;
}

Tool ReadTool(const ConfigNode& node) {
  MapReader reader(node);
  Tool tool;
  tool.name = ReadText(reader.Require("name"));
  tool.shape = ReadShape(reader.Require("shape"));
  if (tool.shape == ToolShape::kSphere || tool.shape == ToolShape::kCylinder) {
    tool.radius_m = ReadNumber(reader.Require("radius_m"), kLength);
  }
  if (tool.shape == ToolShape::kCylinder) {
    tool.length_m = ReadNumber(reader.Require("length_m"), kLength);
  }
  if (tool.shape == ToolShape::kPlate) {
    tool.size_m = ReadVector3(reader.Require("size_m"), kLength);
  }
  if (tool.shape != ToolShape::kHand) {
    tool.friction_coefficient =
        reader.Number("friction_coefficient", 0.0, {.min = 0.0, .max = 10.0});
  }
  if (const ConfigNode* color = reader.Optional("color_rgb")) tool.color_rgb = ReadColor(*color);
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
  MapReader reader(node);
  Stage stage;
  const auto color = [&](const char* key, Eigen::Vector3d* value) {
    if (const ConfigNode* entry = reader.Optional(key)) *value = ReadColor(*entry);
  };
  stage.table_height_m = reader.Number("table_height_m", stage.table_height_m);
  if (const ConfigNode* size = reader.Optional("table_size_m")) {
    stage.table_size_m = ReadSize(*size);
  }
  color("table_color_rgb", &stage.table_color_rgb);
  stage.background_distance_m =
      reader.Number("background_distance_m", stage.background_distance_m, kNonNegative);
  color("background_color_rgb", &stage.background_color_rgb);
  color("robot_color_rgb", &stage.robot_color_rgb);
  stage.marker_radius_m = reader.Number("marker_radius_m", stage.marker_radius_m, kNonNegative);
  if (const ConfigNode* entry = reader.Optional("marker_color_rgb")) {
    stage.marker_color_rgb = ReadColor(*entry);
  }
  stage.light = reader.Number("light", stage.light, {.min = 0.0, .max = 10.0, .min_open = true});
  reader.Finish();
  return stage;
}

}  // namespace palpate::scenario

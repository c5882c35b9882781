// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/foxglove/robot_scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "libs/geometry/frames.hpp"
#include "libs/plot/color.hpp"

namespace palpate::view::foxglove {

namespace {

using Json = nlohmann::json;

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
// Of the diagonal of the body's bounding box.
constexpr double kFullDisplacement = 0.1;  ///< that has the last colour
constexpr double kLongestArrow = 0.25;     ///< the largest force; the others in proportion
constexpr double kShaftDiameter = 0.01;
constexpr double kHeadDiameter = 0.025;
constexpr double kHeadShare = 0.25;  ///< of an arrow's length
constexpr double kFontSize_px = 16.0;

Json Time(std::int64_t ns) { return {{"sec", ns / kNsPerSecond}, {"nsec", ns % kNsPerSecond}}; }

Json VectorJson(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

Json PoseJson(const Eigen::Vector3d& position_m, const Eigen::Quaterniond& rotation) {
  return {{"position", VectorJson(position_m)},
          {"orientation",
           {{"x", rotation.x()}, {"y", rotation.y()}, {"z", rotation.z()}, {"w", rotation.w()}}}};
}

Json ColorJson(const plot::Color& color) {
  return {{"r", color.r}, {"g", color.g}, {"b", color.b}, {"a", 1.0}};
}

/// An entity of the scene without primitives; the order of SceneEntity.
Json EmptyEntity(const char* id, std::int64_t stamp_ns) {
  Json entity = {{"timestamp", Time(stamp_ns)},
                 {"frame_id", std::string(geometry::kRobotFrame)},
                 {"id", id},
                 {"lifetime", Time(0)},
                 {"frame_locked", true},
                 {"metadata", Json::array()}};
  for (const char* primitives :
       {"arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models"}) {
    entity[primitives] = Json::array();
  }
  return entity;
}

double Diagonal_m(const PageSurface& surface) {
  const Eigen::Map<const Eigen::Matrix3Xf> rest_m(surface.rest_m.data(), 3,
                                                  static_cast<Eigen::Index>(surface.nodes.size()));
  if (rest_m.cols() == 0) return 1.0;
  return (rest_m.rowwise().maxCoeff() - rest_m.rowwise().minCoeff()).cast<double>().norm();
}

double Displacement_m(const PageSurface& surface, const std::vector<float>& positions_m,
                      std::size_t node) {
  double squared_m2 = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double moved_m = static_cast<double>(positions_m[3 * node + axis]) -
                           static_cast<double>(surface.rest_m[3 * node + axis]);
    squared_m2 += moved_m * moved_m;
  }
  return std::sqrt(squared_m2);
}

/// The triangles as text: they are most of the message, thirty times a second.
std::string TrianglesText(const PageSurface& surface, const std::vector<float>& positions_m) {
  const double full_displacement_m = kFullDisplacement * Diagonal_m(surface);
  std::string text =
      "{\"pose\":" + PoseJson(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()).dump() +
      ",\"points\":[";
  auto out = std::back_inserter(text);
  const std::size_t count = surface.nodes.size();
  for (std::size_t i = 0; i < count; ++i) {
    fmt::format_to(out, "{}{{\"x\":{:.5f},\"y\":{:.5f},\"z\":{:.5f}}}", i == 0 ? "" : ",",
                   positions_m[3 * i], positions_m[3 * i + 1], positions_m[3 * i + 2]);
  }
  text += "],\"color\":{\"r\":1,\"g\":1,\"b\":1,\"a\":1},\"colors\":[";
  for (std::size_t i = 0; i < count; ++i) {
    const double share = Displacement_m(surface, positions_m, i) / full_displacement_m;
    const plot::Color color = plot::SequentialColor(std::min(share, 1.0));
    fmt::format_to(out, "{}{{\"r\":{:.3f},\"g\":{:.3f},\"b\":{:.3f},\"a\":1}}", i == 0 ? "" : ",",
                   color.r, color.g, color.b);
  }
  fmt::format_to(out, "],\"indices\":[{}]}}", fmt::join(surface.triangles, ","));
  return text;
}

void AddArrow(const SceneForce& force, double metres_per_newton, double diagonal_m, Json* entity) {
  const double length_m = force.force_N.norm() * metres_per_newton;
  const Eigen::Vector3d tail_m = force.position_m - metres_per_newton * force.force_N;
  const auto rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), force.force_N);
  (*entity)["arrows"].push_back({{"pose", PoseJson(tail_m, rotation)},
                                 {"shaft_length", (1.0 - kHeadShare) * length_m},
                                 {"shaft_diameter", kShaftDiameter * diagonal_m},
                                 {"head_length", kHeadShare * length_m},
                                 {"head_diameter", kHeadDiameter * diagonal_m},
                                 {"color", ColorJson(plot::FromHex(0xC8102E))}});
}

Json ForcesEntity(const std::vector<SceneForce>& forces, double diagonal_m, std::int64_t stamp_ns) {
  Json entity = EmptyEntity("forces", stamp_ns);
  double largest_N = 0.0;
  for (const SceneForce& force : forces) {
    if (force.force_N.allFinite()) largest_N = std::max(largest_N, force.force_N.norm());
  }
  for (const SceneForce& force : forces) {
    if (force.force_N.allFinite() && force.force_N.norm() > 0.0) {
      AddArrow(force, kLongestArrow * diagonal_m / largest_N, diagonal_m, &entity);
    }
    entity["texts"].push_back({{"pose", PoseJson(force.position_m, Eigen::Quaterniond::Identity())},
                               {"billboard", true},
                               {"font_size", kFontSize_px},
                               {"scale_invariant", true},
                               {"color", ColorJson(plot::FromHex(0xF28E2B))},
                               {"text", force.label}});
  }
  return entity;
}

// Pieces of the schema, each as Foxglove's own has it.

Json NumberSchema() { return {{"type", "number"}}; }
Json ListSchema(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }
Json ObjectSchema(const char* title, Json properties) {
  return {{"type", "object"}, {"title", title}, {"properties", std::move(properties)}};
}
Json WholeNumbers(const char* title) {
  const Json whole = {{"type", "integer"}, {"minimum", 0}};
  return ObjectSchema(title, {{"sec", whole}, {"nsec", whole}});
}
Json NumbersSchema(const char* title, std::initializer_list<const char*> names) {
  Json properties = Json::object();
  for (const char* name : names) properties[name] = NumberSchema();
  return ObjectSchema(title, properties);
}
Json PoseSchema() {
  return ObjectSchema(
      "foxglove.Pose",
      {{"position", NumbersSchema("foxglove.Vector3", {"x", "y", "z"})},
       {"orientation", NumbersSchema("foxglove.Quaternion", {"x", "y", "z", "w"})}});
}
Json ColorSchema() { return NumbersSchema("foxglove.Color", {"r", "g", "b", "a"}); }

Json TriangleSchema() {
  return ObjectSchema("foxglove.TriangleListPrimitive",
                      {{"pose", PoseSchema()},
                       {"points", ListSchema(NumbersSchema("foxglove.Point3", {"x", "y", "z"}))},
                       {"color", ColorSchema()},
                       {"colors", ListSchema(ColorSchema())},
                       {"indices", ListSchema({{"type", "integer"}, {"minimum", 0}})}});
}

Json ArrowSchema() {
  return ObjectSchema("foxglove.ArrowPrimitive", {{"pose", PoseSchema()},
                                                  {"shaft_length", NumberSchema()},
                                                  {"shaft_diameter", NumberSchema()},
                                                  {"head_length", NumberSchema()},
                                                  {"head_diameter", NumberSchema()},
                                                  {"color", ColorSchema()}});
}

Json TextSchema() {
  return ObjectSchema("foxglove.TextPrimitive", {{"pose", PoseSchema()},
                                                 {"billboard", {{"type", "boolean"}}},
                                                 {"font_size", NumberSchema()},
                                                 {"scale_invariant", {{"type", "boolean"}}},
                                                 {"color", ColorSchema()},
                                                 {"text", {{"type", "string"}}}});
}

}  // namespace

std::string RobotSceneJson(const PageSurface& surface, const std::vector<float>& positions_m,
                           const std::vector<SceneForce>& forces, std::int64_t stamp_ns) {
  std::string robot = EmptyEntity("robot", stamp_ns).dump();
  if (!surface.empty()) {
    constexpr std::string_view kEmptyList = "\"triangles\":[";
    robot.insert(robot.find(kEmptyList) + kEmptyList.size(), TrianglesText(surface, positions_m));
  }
  return "{\"deletions\":[],\"entities\":[" + robot + "," +
         ForcesEntity(forces, Diagonal_m(surface), stamp_ns)
             .dump(-1, ' ', false, Json::error_handler_t::replace) +
         "]}";
}

std::string SceneSchema() {
  const Json anything = ListSchema({{"type", "object"}});
  const Json entity =
      ObjectSchema("foxglove.SceneEntity", {{"timestamp", WholeNumbers("time")},
                                            {"frame_id", {{"type", "string"}}},
                                            {"id", {{"type", "string"}}},
                                            {"lifetime", WholeNumbers("duration")},
                                            {"frame_locked", {{"type", "boolean"}}},
                                            {"metadata", anything},
                                            {"arrows", ListSchema(ArrowSchema())},
                                            {"cubes", anything},
                                            {"spheres", anything},
                                            {"cylinders", anything},
                                            {"lines", anything},
                                            {"triangles", ListSchema(TriangleSchema())},
                                            {"texts", ListSchema(TextSchema())},
                                            {"models", anything}});
  const Json deletion =
      ObjectSchema("foxglove.SceneEntityDeletion", {{"timestamp", WholeNumbers("time")},
                                                    {"type", {{"type", "integer"}}},
                                                    {"id", {{"type", "string"}}}});
  Json schema =
      ObjectSchema(std::string(kSceneSchemaName).c_str(),
                   {{"deletions", ListSchema(deletion)}, {"entities", ListSchema(entity)}});
  schema["$comment"] = "An update to the entities displayed in a 3D scene";
  return schema.dump();
}

}  // namespace palpate::view::foxglove

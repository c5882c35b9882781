// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/calibrated_geometry.hpp"

#include <cmath>

#include "libs/core/check.hpp"
#include "libs/core/config_reader.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::robot {

namespace {

/// That a path may have; a file that names one farther on is broken.
constexpr int kMostPoints = 10000;

void ScalePoint(double scale, fem::BodyPoint* point) {
  point->rest_m *= scale;
  point->distance_m *= scale;
}

}  // namespace

CalibratedScale ReadGeometryScale(const ConfigNode& node) {
  MapReader map(node);
  CalibratedScale scale;
  scale.scale = ReadNumber(map.Require("scale"), {.min = kSmallestScale, .max = kLargestScale});
  scale.standard_error = ReadNumber(map.Require("standard_error"), kNonNegative);
  map.Finish();
  return scale;
}

CalibratedRoute ReadCableRoute(const ConfigNode& node) {
  MapReader map(node);
  CalibratedRoute route;
  route.cable = ReadText(map.Require("cable"));
  if (const ConfigNode* point = map.Optional("point")) {
    route.point = ReadInteger(*point, 0, kMostPoints);
  }
  route.moved_m =
      ReadVector3(map.Require("moved_m"), {.min = -kFarthestOff_m, .max = kFarthestOff_m});
  route.standard_error_m = ReadVector3(map.Require("standard_error_m"), kNonNegative);
  map.Finish();
  return route;
}

std::string FormatGeometry(const std::optional<CalibratedScale>& scale,
                           const std::vector<CalibratedRoute>& routes) {
  std::string text;
  if (scale) {
    text += "geometry_scale: {scale: " + FormatNumber(scale->scale) +
            ", standard_error: " + FormatNumber(scale->standard_error) + "}\n";
  }
  if (!routes.empty()) text += "cable_routes:\n";
  for (const CalibratedRoute& route : routes) {
    text += "  - {cable: " + Quoted(route.cable) + ", point: " + std::to_string(route.point) +
            ", moved_m: " + geometry::FormatVector(route.moved_m) +
            ", standard_error_m: " + geometry::FormatVector(route.standard_error_m) + "}\n";
  }
  return text;
}

Status CheckGeometry(const std::optional<CalibratedScale>& scale,
                     const std::vector<CalibratedRoute>& routes) {
  const auto invalid = [](const std::string& reason) {
    return Status(StatusCode::kInvalidInput, reason);
  };
  if (scale && !(scale->scale >= kSmallestScale && scale->scale <= kLargestScale &&
                 std::isfinite(scale->standard_error) && scale->standard_error >= 0.0)) {
    return invalid("geometry_scale " + FormatNumber(scale->scale) + " is none");
  }
  for (const CalibratedRoute& route : routes) {
    if (route.point < 0 || !route.moved_m.allFinite() || !route.standard_error_m.allFinite() ||
        route.standard_error_m.minCoeff() < 0.0) {
      return invalid("the route of cable '" + route.cable + "' has a number that is none");
    }
    if (route.moved_m.lpNorm<Eigen::Infinity>() <= kFarthestOff_m) continue;
    return invalid("point " + std::to_string(route.point) + " of cable '" + route.cable +
                   "' is farther off its place than " + FormatNumber(kFarthestOff_m) + " m");
  }
  return Status::Ok();
}

void ScaleBody(double scale, RobotBody* body) {
  PALPATE_CHECK(body->scale == 1.0 && scale > 0.0, body->scale, scale);
  body->scale = scale;
  body->mesh.nodes_m *= scale;
  body->node_mass_kg *= scale * scale * scale;
  for (BodyCable& cable : body->cables) {
    cable.pull_point_m *= scale;
    cable.guide_radius_m *= scale;
    for (fem::BodyPoint& eyelet : cable.eyelets) ScalePoint(scale, &eyelet);
  }
  for (BodyMarker& marker : body->markers) ScalePoint(scale, &marker.point);
  for (fem::BodyPoint& point : body->feature_points) ScalePoint(scale, &point);
}

}  // namespace palpate::robot

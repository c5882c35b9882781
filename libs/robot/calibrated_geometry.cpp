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

const KeyTable& GeometryScaleKeys() {
  static const KeyTable keys{
      .title = "geometry scale",
      .about = "Size of the robot over that in its file, about the origin of the robot frame.",
      .keys = {{"scale", value::Real({.min = kSmallestScale, .max = kLargestScale}), kRequired,
                "Ratio of lengths."},
               {"standard_error", value::Real(kNonNegative), kRequired, "Its standard error."}}};
  return keys;
}

const KeyTable& CableRouteKeys() {
  static const KeyTable keys{
      .title = "cable route",
      .about = "Offset of a point of a cable's route from its place in the robot file.",
      .keys = {{"cable", value::Text(), kRequired, "Name of the cable."},
               {"point", value::WholeNumber(0, kMostPoints), Default(CalibratedRoute{}.point),
                "Index into `path_m`. 0: the point that the cable is pulled from."},
               {"moved_m", value::Vector3({.min = -kFarthestOff_m, .max = kFarthestOff_m}),
                kRequired, "Offset, robot frame."},
               {"standard_error_m", value::Vector3(kNonNegative), kRequired,
                "Its standard error along each axis."}}};
  return keys;
}

CalibratedScale ReadGeometryScale(const ConfigNode& node) {
  MapReader map(node, GeometryScaleKeys());
  CalibratedScale scale;
  map.Read("scale", &scale.scale);
  map.Read("standard_error", &scale.standard_error);
  map.Finish();
  return scale;
}

CalibratedRoute ReadCableRoute(const ConfigNode& node) {
  MapReader map(node, CableRouteKeys());
  CalibratedRoute route;
  map.Read("cable", &route.cable);
  map.Read("point", &route.point);
  map.Read("moved_m", &route.moved_m);
  map.Read("standard_error_m", &route.standard_error_m);
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
      return invalid("the route of cable '" + route.cable + "' has a value that is not a number");
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
  for (BodyChamber& chamber : body->chambers) chamber.volume_m3 *= scale * scale * scale;
  for (BodyMarker& marker : body->markers) ScalePoint(scale, &marker.point);
  for (fem::BodyPoint& point : body->feature_points) ScalePoint(scale, &point);
}

}  // namespace palpate::robot

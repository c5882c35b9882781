// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/places_to_hang.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/text.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kPerMetre_mm = 1e3;

double Size_m(const robot::RobotBody& body) {
  const Eigen::Matrix3Xd& nodes_m = body.mesh.nodes_m;
  return (nodes_m.rowwise().maxCoeff() - nodes_m.rowwise().minCoeff()).maxCoeff();
}

double FromWhatIsHeld_m(const robot::RobotBody& body, const Eigen::Vector3d& point_m) {
  double least_m = std::numeric_limits<double>::infinity();
  for (int node = 0; node < body.mesh.NodeCount(); ++node) {
    if (!body.fixed.col(node).all()) continue;
    least_m = std::min(least_m, (point_m - body.mesh.nodes_m.col(node)).norm());
  }
  return least_m;
}

}  // namespace

std::vector<Eigen::Vector3d> PlacesToHang(const robot::RobotBody& body) {
  std::vector<Eigen::Vector3d> places_m;
  std::vector<double> free_m;
  for (const fem::BodyPoint& point : body.feature_points) {
    free_m.push_back(FromWhatIsHeld_m(body, point.rest_m));
  }
  for (int k = 0; k < 2; ++k) {
    double most_m = 0.0;
    const fem::BodyPoint* best = nullptr;
    for (std::size_t p = 0; p < free_m.size(); ++p) {
      double least_m = free_m[p];
      for (const Eigen::Vector3d& other_m : places_m) {
        least_m = std::min(least_m, (body.feature_points[p].rest_m - other_m).norm());
      }
      if (least_m <= most_m) continue;
      most_m = least_m;
      best = &body.feature_points[p];
    }
    if (best == nullptr) break;
    places_m.emplace_back((kPerMetre_mm * best->rest_m).array().round() / kPerMetre_mm);
  }
  return places_m;
}

double MassToHang_kg(const robot::RobotBody& body) {
  constexpr double kOfBody = 0.1;
  if (body.gravity_m_s2.isZero()) return 0.0;
  const double most_kg = kOfBody * body.node_mass_kg.sum();
  for (const double mass_kg : {0.03, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4}) {
    if (mass_kg <= most_kg) return mass_kg;
  }
  return 0.0;
}

double PatchToHang_m(const robot::RobotBody& body) {
  constexpr double kOfSize = 1.0 / 15.0;
  return std::max(1.0, std::round(kPerMetre_mm * kOfSize * Size_m(body))) / kPerMetre_mm;
}

std::string WordsForPlace(const robot::RobotBody& body, const Eigen::Vector3d& place_m) {
  constexpr double kAt_mm = 3.0;
  std::string text;
  for (const double coordinate_m : place_m) {
    text += (text.empty() ? "at (" : ", ") + FormatNumber(std::round(kPerMetre_mm * coordinate_m));
  }
  text += ") mm";
  const robot::BodyMarker* nearest = nullptr;
  double least_mm = std::numeric_limits<double>::infinity();
  for (const robot::BodyMarker& marker : body.markers) {
    const double away_mm = kPerMetre_mm * (marker.point.rest_m - place_m).norm();
    if (away_mm >= least_mm) continue;
    least_mm = away_mm;
    nearest = &marker;
  }
  if (nearest == nullptr) return text;
  if (least_mm < kAt_mm) return "at marker " + nearest->name;
  return text + ", " + FormatNumber(std::round(least_mm)) + " mm from marker " + nearest->name;
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/candidate_locations.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/geometry/surface_sampling.hpp"

namespace palpate::force_estimation {

namespace {

/// The part of the surface that is fixed in any direction: nodes (as triangles without area) and
/// the faces between them. May be empty.
geometry::TriangleSurface HeldSurface(const robot::RobotBody& body) {
  geometry::TriangleSurface surface = fem::RestSurface(body.mesh, body.boundary);
  std::vector<Eigen::Vector3i> held;
  for (const auto& corners : surface.triangles.colwise()) {
    int count = 0;
    for (const int node : corners) {
      if (!body.fixed.col(node).any()) continue;
      ++count;
      held.push_back(Eigen::Vector3i::Constant(node));
    }
    if (count == 3) held.emplace_back(corners);
  }
  surface.triangles.resize(3, ToIndex(held.size()));
  for (Eigen::Index t = 0; t < surface.triangles.cols(); ++t) {
    surface.triangles.col(t) = held[At(t)];
  }
  return surface;
}

}  // namespace

CandidateLocations::CandidateLocations(const robot::RobotModel& model, double patch_radius_m,
                                       const CandidateLocationsTuning& tuning) {
  PALPATE_CHECK(patch_radius_m > 0.0, patch_radius_m);
  const robot::RobotBody& body = model.body();
  const double area_m2 = geometry::SurfaceArea_m2(robot::ContactSurface(body));
  const double apart_m = tuning.spacing_patch_radii * patch_radius_m;
  const int wanted = static_cast<int>(std::clamp(
      area_m2 / (apart_m * apart_m), 1.0 * tuning.fewest_candidates, 1.0 * tuning.most_candidates));
  SpreadOver(model, 2.0 * patch_radius_m, tuning.places_per_candidate * wanted);
  place_of_candidate_ = geometry::FarthestPoints(positions_m_, std::min(wanted, Count()));
  for (const auto& position_m : positions_m_.colwise()) {
    nearest_candidates_.push_back(CandidatesNear(position_m));
    patches_.push_back(model.Patch(position_m, patch_radius_m).weights);
  }
  spacing_m_ = std::sqrt(area_m2 / (tuning.places_per_candidate * wanted));
}

/// Takes `count` places of equal area and drops those within `clearance_m` of a fixed node.
void CandidateLocations::SpreadOver(const robot::RobotModel& model, double clearance_m, int count) {
  const robot::RobotBody& body = model.body();
  const geometry::TriangleSurface surface = robot::ContactSurface(body);
  surface_triangles_ = surface.triangles;
  const geometry::TriangleSurface held = HeldSurface(body);
  std::optional<geometry::SurfaceIndex> held_index;
  if (held.TriangleCount() > 0) held_index.emplace(held);
  const geometry::SurfaceSamples samples = geometry::SampleByArea(surface, count);
  std::vector<int> free;
  for (int s = 0; s < samples.Count(); ++s) {
    const bool clear =
        !held_index || held_index->Closest(samples.positions_m.col(s)).distance_m >= clearance_m;
    if (clear) free.push_back(s);
  }
  if (free.empty()) throw InputError("no part of the robot's surface is free for a contact");
  positions_m_ = samples.positions_m(Eigen::all, free);
  barycentric_.resize(3, positions_m_.cols());
  for (const int s : free) {
    const auto place = ToIndex(triangles_.size());
    const int triangle = samples.triangles[At(s)];
    triangles_.push_back(triangle);
    barycentric_.col(place) =
        geometry::ClosestPointOnTriangle(surface.Corner(triangle, 0), surface.Corner(triangle, 1),
                                         surface.Corner(triangle, 2), positions_m_.col(place));
  }
}

std::array<int, CandidateLocations::kNearest> CandidateLocations::CandidatesNear(
    const Eigen::Vector3d& position_m) const {
  std::vector<double> distance_m;
  for (const int place : place_of_candidate_) {
    distance_m.push_back((positions_m_.col(place) - position_m).norm());
  }
  std::vector<int> order(distance_m.size());
  std::iota(order.begin(), order.end(), 0);
  const auto used = std::min<std::ptrdiff_t>(kNearest, std::ssize(order));
  std::partial_sort(order.begin(), order.begin() + used, order.end(),
                    [&](int a, int b) { return distance_m[At(a)] < distance_m[At(b)]; });
  std::array<int, kNearest> nearest{};
  for (int k = 0; k < kNearest; ++k) {
    nearest[At(k)] = order[At(std::min<std::ptrdiff_t>(k, used - 1))];
  }
  return nearest;
}

int CandidateLocations::Nearest(const Eigen::Vector3d& rest_position_m) const {
  Eigen::Index nearest = 0;
  (positions_m_.colwise() - rest_position_m).colwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

Eigen::Matrix3Xd CandidateLocations::Normals(const Eigen::VectorXd& x_m) const {
  const Eigen::Matrix3Xd at_vertices =
      geometry::VertexNormals({x_m.reshaped(3, x_m.size() / 3), surface_triangles_});
  Eigen::Matrix3Xd normals(3, Count());
  for (Eigen::Index p = 0; p < normals.cols(); ++p) {
    const auto corners = surface_triangles_.col(triangles_[At(p)]);
    normals.col(p) = (at_vertices(Eigen::all, corners) * barycentric_.col(p)).normalized();
  }
  return normals;
}

}  // namespace palpate::force_estimation

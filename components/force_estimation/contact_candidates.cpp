// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/contact_candidates.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/geometry/surface_sampling.hpp"

namespace palpate::force_estimation {

namespace {

struct ContactCandidatesTuning {
  /// Fine places for each feature point. More: finer locations; each is screened where it is near.
  int places_per_point = 16;
  /// Least distance of fine places, in patch radii: nearer ones push on nearly the same nodes.
  double least_spacing_patch_radii = 0.5;
};
constexpr ContactCandidatesTuning kContactCandidatesTuning;

double MeanSpacing_m(const std::vector<FitSite>& candidates) {
  double sum_m = 0.0;
  for (size_t a = 0; a < candidates.size(); ++a) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (size_t b = 0; b < candidates.size(); ++b) {
      if (a == b) continue;
      const Eigen::Vector3d apart_m = candidates[a].patch.centre_m - candidates[b].patch.centre_m;
      nearest_m = std::min(nearest_m, apart_m.norm());
    }
    if (candidates.size() > 1) sum_m += nearest_m / static_cast<double>(candidates.size());
  }
  return sum_m;
}

}  // namespace

ContactCandidates::ContactCandidates(const robot::RobotModel& model, const Config& config)
    : model_(model), config_(config), surface_(robot::ContactSurface(model.body())) {
  const robot::RobotBody& body = model.body();
  for (const fem::BodyPoint& point : body.feature_points) {
    coarse_.push_back({.patch = model.Patch(point.rest_m, config.candidate_patch_radius_m)});
  }
  if (coarse_.empty()) throw InputError("the robot file gives no feature points to search");
  coarse_spacing_m_ = fine_spacing_m_ = MeanSpacing_m(coarse_);
  if (body.feature_points_are_given || coarse_.size() < 2) return;
  const double area_m2 = geometry::SurfaceArea_m2(surface_.surface());
  const double least_m =
      kContactCandidatesTuning.least_spacing_patch_radii * config.candidate_patch_radius_m;
  const double wanted =
      kContactCandidatesTuning.places_per_point * static_cast<double>(coarse_.size());
  const double count = least_m > 0.0 ? std::min(wanted, area_m2 / (least_m * least_m)) : wanted;
  if (count <= static_cast<double>(coarse_.size())) return;
  fine_m_ = geometry::SampleByArea(surface_.surface(), static_cast<int>(count)).positions_m;
  fine_spacing_m_ = std::sqrt(area_m2 / count);
}

std::vector<FitSite> ContactCandidates::FinePlaces(
    const std::vector<Eigen::Vector3d>& centres_m) const {
  std::vector<FitSite> places;
  for (const auto& place_m : fine_m_.colwise()) {
    const bool near = std::any_of(centres_m.begin(), centres_m.end(), [&](const auto& centre_m) {
      return (centre_m - place_m).norm() <= coarse_spacing_m_;
    });
    if (near) places.push_back({.patch = model_.Patch(place_m, config_.candidate_patch_radius_m)});
  }
  return places;
}

double ContactCandidates::PriorCost(const FitSite& site, const Eigen::Vector3d& force_N,
                                    const Eigen::VectorXd& x_m) const {
  if (config_.adhesion) return 0.0;
  const geometry::TriangleSurface& rest = surface_.surface();
  const Eigen::Vector3d& centre_m = site.patch.centre_m;
  std::vector<int> faces = surface_.TrianglesWithin(centre_m, config_.candidate_patch_radius_m);
  if (faces.empty()) faces.push_back(surface_.Closest(centre_m).triangle);
  double least = std::numeric_limits<double>::infinity();
  for (const int face : faces) {
    const auto corner = [&](int k) { return x_m.segment<3>(3 * rest.triangles(k, face)).eval(); };
    const Eigen::Vector3d normal =
        (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    const double push_N = -normal.dot(force_N);
    if (!(push_N > 0.0)) continue;
    const double ratio = (force_N + push_N * normal).norm() / push_N;
    least = std::min(least, std::pow(ratio / config_.friction_sigma, 2));
  }
  return least;
}

}  // namespace palpate::force_estimation

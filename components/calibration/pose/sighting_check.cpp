// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/pose/sighting_check.hpp"

#include <Eigen/Cholesky>
#include <set>
#include <string>

namespace palpate::calibration {

namespace {

Status CheckSighting(const MarkerSighting& sighting, int marker_count) {
  const std::string name = "marker " + std::to_string(sighting.marker);
  if (sighting.marker < 0 || sighting.marker >= marker_count) {
    return {StatusCode::kInvalidInput,
            name + " is not one of the robot's " + std::to_string(marker_count)};
  }
  if (!sighting.position_m.allFinite()) {
    return {StatusCode::kInvalidInput, name + ": a coordinate is not finite"};
  }
  const Eigen::Matrix3d& covariance_m2 = sighting.covariance_m2;
  if (!covariance_m2.allFinite() || !covariance_m2.isApprox(covariance_m2.transpose(), 1e-9) ||
      Eigen::LLT<Eigen::Matrix3d>(covariance_m2).info() != Eigen::Success) {
    return {StatusCode::kInvalidInput, name + ": the covariance is not positive definite"};
  }
  return Status::Ok();
}

}  // namespace

Status CheckSightings(const std::vector<MarkerSighting>& sightings, int marker_count) {
  std::set<int> seen;
  for (const MarkerSighting& sighting : sightings) {
    if (Status status = CheckSighting(sighting, marker_count); !status.ok()) return status;
    if (!seen.insert(sighting.marker).second) {
      return {StatusCode::kInvalidInput,
              "marker " + std::to_string(sighting.marker) + " is sighted twice"};
    }
  }
  if (sightings.size() < 3) {
    return {StatusCode::kUnobservable,
            "a camera pose needs 3 markers, there are " + std::to_string(sightings.size())};
  }
  return Status::Ok();
}

std::vector<MarkerSighting> Mirrored(const std::vector<MarkerSighting>& sightings) {
  const Eigen::DiagonalMatrix<double, 3> mirror(-1.0, 1.0, 1.0);
  std::vector<MarkerSighting> mirrored = sightings;
  for (MarkerSighting& sighting : mirrored) {
    sighting.position_m = mirror * sighting.position_m;
    sighting.covariance_m2 = mirror * sighting.covariance_m2 * mirror;
  }
  return mirrored;
}

}  // namespace palpate::calibration

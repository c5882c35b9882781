// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/perception/markers/fiducial_score.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace palpate::perception {

FiducialScore& FiducialScore::operator+=(const FiducialScore& other) {
  in_view += other.in_view;
  found += other.found;
  others += other.others;
  false_ones += other.false_ones;
  markers_found.insert(other.markers_found.begin(), other.markers_found.end());
  lateral_squared_m2 += other.lateral_squared_m2;
  depth_sigmas_squared += other.depth_sigmas_squared;
  worst_depth_sigmas = std::max(worst_depth_sigmas, other.worst_depth_sigmas);
  mahalanobis_squared += other.mahalanobis_squared;
  return *this;
}

void FiducialScore::Add(const std::vector<TrueMarker>& truth, const FiducialFrame& frame) {
  for (const TrueMarker& marker : truth) in_view += marker.in_view ? 1 : 0;
  for (const Fiducial& fiducial : frame.fiducials) {
    const int marker = NearestMarker(truth, fiducial);
    if (marker < 0) {
      ++false_ones;
      continue;
    }
    const TrueMarker& real = truth[static_cast<std::size_t>(marker)];
    if (!real.in_view) {
      ++others;
      continue;
    }
    ++found;
    markers_found.insert(marker);
    const Eigen::Vector3d off_m = fiducial.position_m - real.position_m;
    const Eigen::Vector3d ray = real.position_m.normalized();
    const double along_m = off_m.dot(ray);
    const double sigmas = std::abs(along_m) / std::sqrt(ray.dot(fiducial.covariance_m2 * ray));
    lateral_squared_m2 += (off_m - along_m * ray).squaredNorm();
    depth_sigmas_squared += sigmas * sigmas;
    worst_depth_sigmas = std::max(worst_depth_sigmas, sigmas);
    mahalanobis_squared += Mahalanobis(fiducial, real);
  }
}

double FiducialScore::LateralRms_m() const {
  return std::sqrt(lateral_squared_m2 / std::max(1, found));
}

double FiducialScore::MeanMahalanobis() const { return mahalanobis_squared / std::max(1, found); }

double FiducialScore::MeanDepthSigmas() const {
  return std::sqrt(depth_sigmas_squared / std::max(1, found));
}

std::string FiducialScore::Text() const {
  char text[256];
  std::snprintf(
      text, sizeof(text),
      "%d of %d in view found, %d others, %d false; lateral %.3f mm RMS; depth %.2f sigma "
      "RMS, %.2f at most; mean squared Mahalanobis distance %.2f",
      found, in_view, others, false_ones, 1e3 * LateralRms_m(), MeanDepthSigmas(),
      worst_depth_sigmas, MeanMahalanobis());
  return text;
}

double Mahalanobis(const Fiducial& fiducial, const TrueMarker& truth) {
  const Eigen::Vector3d off_m = fiducial.position_m - truth.position_m;
  return off_m.dot(fiducial.covariance_m2.inverse() * off_m);
}

FiducialScore DetectOn(const scenario::Scenario& scenario, const FiducialConfig& config,
                       int seeds) {
  FiducialScore score;
  for (int seed = 1; seed <= seeds; ++seed) {
    MarkedScene scene(FourLegSurface(), scenario, static_cast<std::uint64_t>(seed));
    FiducialDetector detector(config);
    detector.SetCamera(scenario.camera->camera);
    const FiducialFrame& found = detector.Detect(scene.Take(scene.Rest()));
    EXPECT_TRUE(found.status.ok()) << found.status.message();
    score.Add(scene.truth(), found);
  }
  return score;
}

}  // namespace palpate::perception

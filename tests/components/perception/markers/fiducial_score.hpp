// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <set>
#include <string>
#include <vector>

#include "components/perception/markers/fiducial_detector.hpp"
#include "tests/components/perception/markers/marked_scene.hpp"

namespace palpate::perception {

/// What came of some frames.
struct FiducialScore {
  int in_view = 0;
  int found = 0;       ///< of those in view
  int others = 0;      ///< markers that are not wholly in view, or nearly edge-on
  int false_ones = 0;  ///< where no marker is
  std::set<int> markers_found;
  double lateral_squared_m2 = 0.0;    ///< across the ray, of those found
  double depth_sigmas_squared = 0.0;  ///< along it
  double worst_depth_sigmas = 0.0;
  double mahalanobis_squared = 0.0;

  FiducialScore& operator+=(const FiducialScore& other);
  void Add(const std::vector<TrueMarker>& truth, const FiducialFrame& frame);
  double LateralRms_m() const;
  double MeanMahalanobis() const;  ///< of the squares
  double MeanDepthSigmas() const;  ///< RMS
  std::string Text() const;
};

/// Squared.
double Mahalanobis(const Fiducial& fiducial, const TrueMarker& truth);

/// One frame of the robot at rest for each seed.
FiducialScore DetectOn(const scenario::Scenario& scenario, const FiducialConfig& config, int seeds);

}  // namespace palpate::perception

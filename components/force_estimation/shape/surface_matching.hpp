// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/correspondence/feature_match.hpp"
#include "libs/correspondence/surface_features.hpp"

namespace palpate::force_estimation {

struct SurfaceMatchingTuning {
  /// Method `point`: depth before a surface point within which the rendered surface is the point's
  /// own. Larger: points behind a thin part count as visible; smaller: rendering error hides
  /// points.
  double same_surface_m = 3e-3;
  /// Largest motion of the surface between two frames: half a metre per second at 30 frames a
  /// second. Larger: objects near the robot are matched as its surface; smaller: a fast robot is
  /// lost.
  double motion_m = 15e-3;
  /// Points whose nearest neighbour gives the cloud's spacing. More: slower, a steadier estimate.
  Eigen::Index spacing_samples = 15;
};

/// Algorithm 3 of the paper, with two methods: `point` takes the cloud point nearest to the normal
/// line, as published; `patch` (the default) takes all cloud points on the surface point's share of
/// the surface, found by rendering the predicted surface, and averages their distances to it
/// (robust mean), so that all measurements are used. Parts of the predicted surface that are
/// occluded by the body or face away from the camera are hidden, whatever the cloud holds there.
/// Parts at a grazing angle have a low weight.
///
/// d_m of 0 is twice the distance between neighbouring cloud points; d_l of 0 is the motion of the
/// surface between two frames and three sigmas of the cloud. For a patch d_m is the largest
/// distance of a cloud point from the silhouette, outside of it.
class SurfaceMatching {
 public:
  SurfaceMatching(const correspondence::SurfaceFeatures& features, const ShapeConfig& config,
                  const SurfaceMatchingTuning& tuning = {});
  ~SurfaceMatching();

  /// `x_m` [3n] the model's nodes, robot frame. One entry for each feature and camera: [features]
  /// of the first camera, then of the next; holds until the next call. Each camera matches its own
  /// cloud, with its own noise and lines of sight. Cloud points farther than d_l from the surface
  /// count as outliers. Everything must be finite and the clouds' sigmas above 0.
  const std::vector<correspondence::FeatureMatch>& Match(const ShapeFrame& frame,
                                                         const Eigen::VectorXd& x_m);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::force_estimation

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "libs/correspondence/feature_match.hpp"
#include "libs/correspondence/moving_surface.hpp"
#include "libs/correspondence/predicted_view.hpp"
#include "libs/correspondence/robust_mean.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/rgbd/sensed_cloud.hpp"

namespace palpate::correspondence {

/// d_m and d_l of one frame, m.
struct MatchDistances {
  double hidden_m = 0.0;
  double outlier_m = 0.0;
};

/// The way `patch` of SurfaceMatching: each cloud point goes to the part of the surface that is
/// seen in its direction, and each feature takes the mean over its share.
class PatchMatching {
 public:
  explicit PatchMatching(const SurfaceFeatures& features) : features_(features) {}

  /// `surface` is where the model is, `view` what is seen of it. `matches`: [features].
  void Match(const rgbd::SensedCloud& cloud, const Eigen::Isometry3d& T_robot_camera,
             const MovingSurface& surface, const PredictedView& view,
             const MatchDistances& distances, std::span<FeatureMatch> matches);

 private:
  /// A cloud point on the surface. Camera frame.
  struct Landing {
    Eigen::Vector3d point_m;
    SurfaceFoot foot;
    double sigma_m;  ///< of the height
    double weight;
    int feature;
  };

  void Land(const rgbd::SensedCloud& cloud, const MovingSurface& surface, const PredictedView& view,
            const MatchDistances& distances, std::span<FeatureMatch> matches);
  void SortByFeature();
  void Conclude(int feature, const Eigen::Isometry3d& T_robot_camera, const MovingSurface& surface,
                FeatureMatch* match);
  void WeighLandings(int begin, int end);
  void AddRow(int begin, int end, const Eigen::Matrix3d& R_robot_camera,
              const MovingSurface& surface, FeatureMatch* match);

  const SurfaceFeatures& features_;
  RobustMean mean_;
  std::vector<Landing> landings_;
  std::vector<int> order_;  ///< landings by feature
  std::vector<int> begin_;  ///< [features + 1] into order_
  std::vector<int> next_;   ///< [features + 1] while sorting
  Eigen::VectorXd height_m_;
  Eigen::VectorXd sigma_m_;
  Eigen::VectorXd weight_;
  std::vector<double> outlier_height_m_;      ///< [features] sum
  std::vector<Eigen::Vector3d> coefficient_;  ///< [vertices] zero between the features
  std::vector<int> touched_;
};

}  // namespace palpate::correspondence

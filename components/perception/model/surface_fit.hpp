// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/perception/model/sample_grid.hpp"

namespace palpate::perception {

/// A smooth displacement field that brings the predicted surface onto what was measured: the
/// model's last state is a frame old, and the camera's depth has a bias of low frequency. Linear
/// between the nodes of a coarse grid in space; robust, so that an object on the robot does not
/// pull.
class SurfaceFit {
 public:
  struct Settings {
    double spacing_m = 0.07;         ///< of the nodes
    double largest_error_m = 0.015;  ///< points farther from the surface do not count
    float point_sigma_m = 1.5e-3f;   ///< of one measured point
  };

  struct Round {
    float cut = 1.0f;           ///< of the largest error: points farther do not count
    float trust_before = 1.0f;  ///< weight of points before the surface, (0, 1]
    float difference = 0.25f;   ///< of the largest error: sigma between neighbouring nodes
  };

  /// Nodes round the sites of `grid`; no displacement yet.
  void Lay(const SampleGrid& grid, const Settings& settings);

  /// Some rounds of nearest points and least squares. The sites of `grid` move along.
  void Fit(SampleGrid* grid);

  /// Displacement at a point, camera frame, m; 0 away from the sites.
  Eigen::Vector3f At(const Eigen::Vector3f& point_m) const;

 private:
  struct Shares {
    Eigen::Array<int, 8, 1> node;  ///< kNone: not used
    Eigen::Array<float, 8, 1> share;
  };

  Shares SharesOf(const Eigen::Vector3f& point_m) const;
  void Number(const SampleGrid& grid);
  void Improve(const SampleGrid& grid, const Round& round);
  void AddSmoothness(float difference);

  Settings settings_;
  Eigen::Vector3f origin_m_ = Eigen::Vector3f::Zero();
  Eigen::Array3i counts_ = Eigen::Array3i::Zero();
  std::vector<int> number_;  ///< [grid nodes] of the unknown; kNone
  int unknowns_ = 0;
  Eigen::Matrix3Xf displacement_m_;  ///< [3 x unknowns]
  std::vector<Eigen::Vector3f> first_site_m_;
  std::vector<Shares> site_shares_;
  Eigen::MatrixXf normal_matrix_;
  Eigen::VectorXf right_side_;
};

}  // namespace palpate::perception

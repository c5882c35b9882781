// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "components/perception/model/sample_grid.hpp"

namespace palpate::perception {

struct SurfaceFitRound {
  /// Distance beyond which points do not count, as a share of the largest error.
  float cut = 1.0f;
  float trust_before = 1.0f;  ///< weight of points before the surface, (0, 1]
  /// Sigma between neighbouring nodes, as a share of the largest error. Larger: a more flexible
  /// surface, which follows objects.
  float difference = 0.25f;
};

struct SurfaceFitTuning {
  /// First the surface as a whole, from any pose; then its deformation. Objects stand before the
  /// surface, never inside of it: at the end points before it have less weight, and those far
  /// before it none.
  std::array<SurfaceFitRound, 5> rounds = {
      {{.cut = 1.0f, .trust_before = 1.0f, .difference = 0.02f},
       {.cut = 1.0f, .trust_before = 1.0f, .difference = 0.02f},
       {.cut = 0.7f, .trust_before = 0.5f, .difference = 0.02f},
       {.cut = 0.6f, .trust_before = 0.25f, .difference = 0.25f},
       {.cut = 0.4f, .trust_before = 0.25f, .difference = 0.25f}}};
  /// Prior sigma of a node's displacement, as a share of the largest error. Larger: nodes without
  /// points follow their neighbours farther.
  float move_sigma = 0.7f;
  /// Interpolation weight of nodes near the surface, below which the displacement is zero.
  float least_known_share = 0.05f;
};

/// A smooth displacement field that registers the predicted surface to the measurement: the model's
/// last state is a frame old, and the depth has a bias of low frequency. Linear between the nodes
/// of a coarse grid in space; robust against objects on the robot.
class SurfaceFit {
 public:
  struct Settings {
    double spacing_m = 0.07;         ///< of the nodes
    double largest_error_m = 0.015;  ///< points farther from the surface do not count
    float point_sigma_m = 1.5e-3f;   ///< of one measured point
  };

  explicit SurfaceFit(const SurfaceFitTuning& tuning = {}) : tuning_(tuning) {}

  /// Nodes round the sites of `grid`; no displacement yet.
  void Lay(const SampleGrid& grid, const Settings& settings);

  /// Rounds of nearest points and least squares. Moves the sites of `grid`.
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
  void Improve(const SampleGrid& grid, const SurfaceFitRound& round);
  void AddSmoothness(float difference);

  SurfaceFitTuning tuning_;
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

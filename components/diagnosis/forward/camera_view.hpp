// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/geometry/depth_bias_map.hpp"

namespace palpate::diagnosis {

/// Depth that is off by amplitude (1 - exp(-t / tau)), t since the experiment's first stamp.
struct DepthDrift {
  double amplitude_m = 0.0;
  double tau_s = 1.0;
};

/// What a depth camera does wrong (docs/diagnosis.md).
struct CameraErrors {
  double depth_scale = 0.0;       ///< depth is 1 + this times the true one
  double incidence_bias_m = 0.0;  ///< b of b (1/cos a - 1) along the ray, cos a >= 0.25
  double focal = 0.0;             ///< the true focal length is 1 + this times the assumed one
  double cx_px = 0.0;             ///< the true image centre less the assumed one
  double cy_px = 0.0;
  double k1 = 0.0;  ///< true distortion, less the assumed one
  std::vector<DepthDrift> drifts = {};
  /// Disparities of a stereo camera are off by a wave of them, cosine and sine, px.
  Eigen::Vector2d ripple_px = Eigen::Vector2d::Zero();
  geometry::DepthBiasBasis bias_basis = {};
  Eigen::VectorXd bias =
      {};  ///< [basis] or none; depth is 1 + its sum with the basis times as large
};

/// A point in view of a camera, camera frame (x right, y down, z forward).
struct SeenPoint {
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface there, unit, outward
};

/// Where a depth camera with errors measures points, and how that changes. The camera sees a point
/// at the pixel that its true lens gives it, and takes it to lie on that pixel's ray as its data
/// sheet has it, in a depth z of its own. The distortion of the data sheet is left out of what the
/// errors do: of theirs a few per cent. What is not before the camera is where it is.
class CameraView {
 public:
  /// `drift_m` of depth, from CameraErrors::drifts. `focal_px`: fx, fy of the data sheet, which
  /// centres are counted with; infinite where unknown.
  CameraView(const CameraErrors& errors, const Eigen::Vector2d& focal_px, double drift_m);

  Eigen::Vector3d Measured(const SeenPoint& point) const;
  /// How it moves with the point, whose normal stays.
  Eigen::Matrix3d Slope(const SeenPoint& point) const;

  // How it moves with the errors, each per unit of CameraErrors.
  Eigen::Vector3d ByDrift(const SeenPoint& point) const;  ///< m per m of depth
  Eigen::Vector3d ByDepthScale(const SeenPoint& point) const;
  Eigen::Vector3d ByIncidence(const SeenPoint& point) const;
  Eigen::Vector3d ByFocal(const SeenPoint& point) const;
  Eigen::Vector3d ByCentre(const SeenPoint& point, int axis) const;
  Eigen::Vector3d ByDistortion(const SeenPoint& point) const;
  Eigen::Vector3d ByBias(const SeenPoint& point, const geometry::DepthBiasBasis& basis,
                         Eigen::Index coefficient) const;

 private:
  double Depth_m(const SeenPoint& point) const;
  Eigen::Vector2d Direction(const SeenPoint& point) const;

  CameraErrors errors_;
  Eigen::Vector2d focal_px_;
  Eigen::Vector2d centre_;  ///< by which directions are off
  double drift_m_;
};

}  // namespace palpate::diagnosis

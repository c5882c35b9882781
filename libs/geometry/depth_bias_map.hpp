// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace palpate::geometry {

/// Polynomials over an image: all monomials up to `order` in x / (z span) and y / (z span) of a
/// point (camera frame, z > 0), rising in degree, those of x first: 1, x, y, xx, xy, yy, ...
struct DepthBiasBasis {
  int order = 2;       ///< >= 0; 0: the same everywhere
  double span = 0.25;  ///< > 0, tangent of the angle at which a monomial has become 1

  bool operator==(const DepthBiasBasis&) const = default;
};

/// How many there are.
int CountOf(const DepthBiasBasis& basis);

/// "depth_scale" (the constant), "depth_bias:x", "depth_bias:y", "depth_bias:xx", ...
std::vector<std::string> NamesOf(const DepthBiasBasis& basis);

/// [CountOf(basis)] their values at a point, m, z > 0.
Eigen::VectorXd ValuesAt(const DepthBiasBasis& basis, const Eigen::Vector3d& p_camera_m);

/// [3 x CountOf(basis)] how they change with the point, 1/m.
Eigen::Matrix3Xd SlopesAt(const DepthBiasBasis& basis, const Eigen::Vector3d& p_camera_m);

/// The smooth part by which a depth image errs, as stereo cameras do by 0.2 to 0.5 % of z: a point
/// that is measured at p (camera frame) is at (1 + b) p, b = sum of coefficients times the basis.
/// A constant looks like a shift of the camera along its axis, a slope like a turn: seen from a
/// robot that is flat against its distance, data determine the map and the camera pose together far
/// better than either, so that the two are known by one covariance.
struct DepthBiasMap {
  DepthBiasBasis basis;
  Eigen::VectorXd coefficients;  ///< [k] shares of the distance
  /// [6 + k square] of the errors (found - right) of the pose that was found together with it: a
  /// rotation vector (rad) and a shift (m) of the camera, robot frame; then of the coefficients.
  /// Right are the two that align the image best with the model whose surface gave them: what
  /// is wrong with that surface, and turns both equally each time, does not count.
  Eigen::MatrixXd covariance;

  double At(const Eigen::Vector3d& p_camera_m) const {
    return ValuesAt(basis, p_camera_m).dot(coefficients);
  }
};

}  // namespace palpate::geometry

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/correspondence/surface_features.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/robot/observation_row.hpp"

namespace palpate::force_estimation {

/// Mean place of the followed points of texture on the share of a feature point of the surface,
/// across the line of sight of a camera.
struct TextureMatch {
  int feature = 0;
  std::size_t number = 0;  ///< of the feature and the camera: features of the first, then the next
  int count = 0;           ///< points of texture
  std::array<robot::ObservationRow, 2> rows;           ///< of the model, in the nodes' positions
  Eigen::Vector2d target_m = Eigen::Vector2d::Zero();  ///< what these should give
  double sigma_m = 0.0;                                ///< of each, from the image noise alone
  fem::InterpolationWeights place;                     ///< of the first of the points
};

/// Tangential motion of the surface. Points of texture that a camera follows are bound to the body
/// in contact-free frames, in which its shape is known: where their line of sight meets the
/// surface. Later each tells two coordinates of its material point, those across its line of sight.
/// What is constant (the error of the camera pose, of the mesh, of the point's first image) is
/// measured in the contact-free frames, too, and cancels.
class TextureMotion {
 public:
  /// `features` must outlive this.
  explicit TextureMotion(const correspondence::SurfaceFeatures& features) : features_(features) {}

  /// A contact-free frame, in which the nodes are at `x_m` [3n], robot frame.
  void Learn(const ShapeFrame& frame, const Eigen::VectorXd& x_m);

  /// The bound points of a frame. Holds until the next call.
  const std::vector<TextureMatch>& Match(const ShapeFrame& frame);
  /// Those of the last frame that was matched.
  const std::vector<TextureMatch>& matches() const { return matches_; }

 private:
  /// A point of texture on the body.
  struct Bound {
    int feature = 0;
    fem::InterpolationWeights point;
    double distance_m = 0.0;                             ///< from the camera
    Eigen::Vector2d offset_m = Eigen::Vector2d::Zero();  ///< mean of measured - model
    int frames = 0;                                      ///< in which it was measured
  };
  /// Of a view, in the robot's frame.
  struct Line {
    Eigen::Vector3d origin_m;
    Eigen::Vector3d direction;           ///< unit
    Eigen::Matrix<double, 3, 2> across;  ///< unit, along the image's rows and columns
  };

  static Line LineOf(const ShapeView& view, Eigen::Index point);
  static double NoiseVariance_m2(const Bound& bound, double sigma_rad);
  bool Bind(const Line& line, const Eigen::VectorXd& x_m, Bound* bound) const;

  const correspondence::SurfaceFeatures& features_;
  std::vector<std::map<std::uint64_t, Bound>> bound_;  ///< [cameras] by id
  std::vector<TextureMatch> matches_;
};

}  // namespace palpate::force_estimation

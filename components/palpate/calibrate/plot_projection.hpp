// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/palpate/calibrate/assignment_plot.hpp"
#include "components/view/picture/camera.hpp"
#include "libs/plot/svg_document.hpp"

namespace palpate::command {

/// Orthographic projection along one axis of the camera's frame.
struct PlainView {
  Eigen::Matrix<double, 2, 3> axes = Eigen::Matrix<double, 2, 3>::Zero();  ///< right, down
  std::string name;                                                        ///< "along z"
};

/// Along the axis in which the points are flattest; along z in the camera's view, along x and y
/// with z up.
PlainView ChooseView(const std::vector<AssignmentPanel>& panels);

/// From the camera's frame to the sheet: through the camera's lens where there is an image, else
/// orthographic.
class PlotProjection {
 public:
  /// `panel` must outlive this.
  PlotProjection(const AssignmentPanel& panel, const PlainView& plain, const view::Rect& frame);

  plot::SvgPoint At(const Eigen::Vector3d& point_m) const;
  /// d At / d point, sheet pixels per m.
  Eigen::Matrix<double, 2, 3> Derivative(const Eigen::Vector3d& point_m) const;
  /// At the points' middle.
  double Pixels_per_m() const;

  /// The part of the image that is shown, in its pixels (first, and one past the last).
  Eigen::Vector2i first_px() const { return first_px_; }
  Eigen::Vector2i last_px() const { return last_px_; }
  /// Where that part lies on the sheet.
  view::Rect PictureFrame() const;

 private:
  Eigen::Vector2d Flat(const Eigen::Vector3d& point_m) const;
  void Fit(const Eigen::Matrix2Xd& flat, const view::Rect& frame);

  const rgbd::CameraModel* lens_ = nullptr;  ///< nullptr: orthographic
  Eigen::Matrix<double, 2, 3> axes_ = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Vector3d middle_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d origin_{0, 0};  ///< flat, of the panel's corner
  Eigen::Vector2d corner_px_{0, 0};
  double scale_ = 1.0;  ///< sheet pixels per image pixel, or per m
  Eigen::Vector2i first_px_{0, 0}, last_px_{0, 0};
};

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/plot_projection.hpp"

#include <algorithm>

#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

/// Room for names round the outermost points, as a share of the panel.
constexpr double kMargin = 0.16;
constexpr double kLeastSide_m = 0.02;

/// Points and model's markers.
Eigen::Matrix3Xd AllOf(const AssignmentPanel& panel) {
  Eigen::Matrix3Xd all_m(3, ToIndex(panel.points.size()) + panel.model_m.cols());
  Eigen::Index next = 0;
  for (const auto& point : panel.points) all_m.col(next++) = point.position_m;
  all_m.rightCols(panel.model_m.cols()) = panel.model_m;
  return all_m;
}

}  // namespace

PlainView ChooseView(const std::vector<AssignmentPanel>& panels) {
  Eigen::Vector3d spread_m2 = Eigen::Vector3d::Zero();
  for (const AssignmentPanel& panel : panels) {
    const Eigen::Matrix3Xd& model_m = panel.model_m;
    const Eigen::Vector3d middle_m = model_m.rowwise().mean();
    spread_m2 += (model_m.colwise() - middle_m).rowwise().squaredNorm();
  }
  PlainView plain;
  Eigen::Index flattest = 2;
  spread_m2.minCoeff(&flattest);
  if (flattest == 2) {
    plain.axes << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  } else if (flattest == 1) {
    plain.axes << 1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
  } else {
    plain.axes << 0.0, 1.0, 0.0, 0.0, 0.0, -1.0;
  }
  plain.name = std::string("along ") + "xyz"[flattest];
  return plain;
}

PlotProjection::PlotProjection(const AssignmentPanel& panel, const PlainView& plain,
                               const view::Rect& frame) {
  const Eigen::Matrix3Xd all_m = AllOf(panel);
  middle_m_ = all_m.rowwise().mean();
  if (panel.ground.color.empty()) {
    axes_ = plain.axes;
  } else {
    lens_ = &panel.ground.lens;
  }
  Eigen::Matrix2Xd flat(2, all_m.cols());
  for (Eigen::Index k = 0; k < all_m.cols(); ++k) flat.col(k) = Flat(all_m.col(k));
  Fit(flat, frame);
  if (lens_ == nullptr) return;
  const Eigen::Vector2d shown = Eigen::Vector2d(frame.width_px, frame.height_px) / scale_;
  const Eigen::Array2i size(panel.ground.color.width_px, panel.ground.color.height_px);
  first_px_ = origin_.array().floor().cast<int>().max(0).min(size - 1);
  last_px_ = (origin_ + shown).array().ceil().cast<int>().min(size).max(first_px_.array() + 1);
}

void PlotProjection::Fit(const Eigen::Matrix2Xd& flat, const view::Rect& frame) {
  const Eigen::Array2d low = flat.rowwise().minCoeff(), high = flat.rowwise().maxCoeff();
  const double least = lens_ == nullptr ? kLeastSide_m : 1.0;
  const Eigen::Array2d size = (high - low).max(least);
  const Eigen::Array2d room(frame.width_px, frame.height_px);
  scale_ = (room * (1.0 - 2.0 * kMargin) / size).minCoeff();
  origin_ = 0.5 * (low + high) - 0.5 * room / scale_;
  corner_px_ = {frame.x_px, frame.y_px};
}

Eigen::Vector2d PlotProjection::Flat(const Eigen::Vector3d& point_m) const {
  return lens_ != nullptr ? rgbd::Project(*lens_, point_m)
                          : Eigen::Vector2d(axes_ * (point_m - middle_m_));
}

plot::SvgPoint PlotProjection::At(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector2d at_px = corner_px_ + scale_ * (Flat(point_m) - origin_);
  return {at_px.x(), at_px.y()};
}

Eigen::Matrix<double, 2, 3> PlotProjection::Derivative(const Eigen::Vector3d& point_m) const {
  constexpr double kStep_m = 1e-5;
  Eigen::Matrix<double, 2, 3> derivative;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step_m = kStep_m * Eigen::Vector3d::Unit(axis);
    derivative.col(axis) =
        scale_ * (Flat(point_m + step_m) - Flat(point_m - step_m)) / (2.0 * kStep_m);
  }
  return derivative;
}

double PlotProjection::Pixels_per_m() const { return Derivative(middle_m_).row(0).norm(); }

view::Rect PlotProjection::PictureFrame() const {
  const Eigen::Vector2d corner_px =
      corner_px_ + scale_ * (first_px_.cast<double>() - origin_ - Eigen::Vector2d::Constant(0.5));
  const Eigen::Vector2d size_px = scale_ * (last_px_ - first_px_).cast<double>();
  return {corner_px.x(), corner_px.y(), size_px.x(), size_px.y()};
}

}  // namespace palpate::command

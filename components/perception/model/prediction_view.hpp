// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>

#include "components/perception/model/pixel_region.hpp"
#include "components/perception/model/sample_grid.hpp"
#include "components/perception/model/surface_fit.hpp"
#include "components/perception/model_config.hpp"
#include "components/perception/observation.hpp"
#include "components/perception/registered_frame.hpp"
#include "libs/rgbd/surface_view.hpp"

namespace palpate::perception {

/// The predicted surface as the camera sees it, brought onto what it measured.
class PredictionView {
 public:
  PredictionView(const rgbd::RgbdCamera& camera, const ModelConfig& config);

  /// Draws the prediction. kInvalidInput for a surface that is none, kNoRobotSeen where nothing of
  /// it is in the image.
  Status Look(const PredictedSurface& predicted);
  /// The part of the image round the prediction.
  void Place(PixelRegion* region) const;
  /// Whether what is measured at a pixel cannot be the robot.
  using IsForeign = std::function<bool(int u_px, int v_px, const Eigen::Vector3f& point_m)>;
  /// How a surface is brought onto what was measured.
  struct Fitting {
    IsForeign is_foreign;
    float point_sigma_m = 1.5e-3f;
    double largest_error_m = 0.015;  ///< of the prediction
  };
  /// Fits the surface to what the region measured, but for what is foreign, and draws it again.
  void FitTo(const Registration& registration, const PixelRegion& region, const Fitting& fitting);
  /// What a fit has come to.
  struct Agreement {
    int agree = 0;       ///< samples of the surface that are measured where it is
    int contradict = 0;  ///< through which is seen what lies behind it
    int strange = 0;     ///< measured off the surface, and not foreign
    double Share() const { return static_cast<double>(agree) / std::max(1, agree + contradict); }
    /// The larger, the better is the fit.
    double Score() const { return agree - contradict - 0.5 * strange; }
  };
  Agreement Agree(const Registration& registration, const PixelRegion& region,
                  const Fitting& fitting) const;
  /// Fills the region's distance_m: from the fitted surface, positive outside of it. Where the
  /// surface is far away, roughly.
  void Measure(const Registration& registration, PixelRegion* region) const;

  bool Covers(int u_px, int v_px) const {
    return view_.Triangle(u_px, v_px) != rgbd::SurfaceView::kNothing;
  }
  /// z of the fitted surface; 0: not there.
  float Z_m(int u_px, int v_px) const { return view_.Z_m(u_px, v_px); }
  /// The fitted surface: all vertices, the triangles that face the camera.
  const PredictedSurface& surface() const { return surface_; }
  /// The same with the triangles that face away from it.
  PredictedSurface WholeSurface() const;

 private:
  struct Distance {
    float signed_m;    ///< along the normal
    float squared_m2;  ///< with what is beyond `slack` across it
  };

  void LayGrid(const Registration& registration, const PixelRegion& region);
  void Redraw();
  static Distance From(const Eigen::Vector3f& site_m, const Eigen::Vector3f& normal,
                       const Eigen::Vector3f& point_m, float slack_m);

  ModelConfig config_;
  double focal_px_;
  rgbd::SurfaceView view_;
  PredictedSurface surface_;
  Eigen::Matrix3Xf normals_;  ///< of its triangles
  float nearest_z_m_ = 0.0f;
  SampleGrid grid_;
  SurfaceFit fit_;
  Eigen::Matrix3Xi all_triangles_;  ///< of the prediction
};

}  // namespace palpate::perception

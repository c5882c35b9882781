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

struct PredictionViewTuning {
  SurfaceFitTuning fit = {};
  /// Distance of samples on the nearest part of the robot, within bounds of their distance in the
  /// image. Larger: faster, details are lost.
  double sample_spacing_m = 3e-3;
  int least_step_px = 2;
  int most_step_px = 8;
  /// Squared distance from the surface in the pixel's line of sight below which no other part is
  /// searched. Larger: faster, distances near edges err.
  float on_surface_m2 = 1e-6f;
  /// Distance of a sample from the surface that agrees, in sigmas of a point; the nearest sample of
  /// the surface may lie aside. Larger: a wrong fit agrees; smaller: a right one contradicts.
  float agree_sigmas = 4.0f;
};

/// The predicted surface in the camera's view, registered to the measurement.
class PredictionView {
 public:
  PredictionView(const rgbd::RgbdCamera& camera, const ModelConfig& config,
                 const PredictionViewTuning& tuning = {});

  /// Renders the prediction. kInvalidInput for an invalid surface, kNoRobotSeen where it is out of
  /// the image.
  Status Render(const PredictedSurface& predicted);
  /// The region of interest around the prediction.
  void Place(PixelRegion* region) const;
  /// Whether a measured point cannot be the robot.
  using IsForeign = std::function<bool(int u_px, int v_px, const Eigen::Vector3f& point_m)>;
  /// Parameters of the registration.
  struct Fitting {
    IsForeign is_foreign;
    float point_sigma_m = 1.5e-3f;
    double largest_error_m = 0.015;  ///< of the prediction
  };
  /// Fits the surface to the region's points that are not foreign, and renders it again.
  void FitTo(const Registration& registration, const PixelRegion& region, const Fitting& fitting);
  /// Quality of a fit.
  struct Agreement {
    int agree = 0;       ///< samples whose measured point is on the surface
    int contradict = 0;  ///< samples whose measured point is behind the surface
    int strange = 0;     ///< points off the surface that are not foreign
    double Share() const { return static_cast<double>(agree) / std::max(1, agree + contradict); }
    /// The larger, the better is the fit.
    double Score() const { return agree - contradict - 0.5 * strange; }
  };
  Agreement Agree(const Registration& registration, const PixelRegion& region,
                  const Fitting& fitting) const;
  /// Fills the region's distance_m: from the fitted surface, positive outside of it; approximate
  /// far from the surface.
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
  PredictionViewTuning tuning_;
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

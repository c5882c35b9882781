// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

#include "components/perception/markers/color_spots.hpp"
#include "components/perception/markers/curved_surface.hpp"
#include "components/perception/markers/fiducial.hpp"
#include "components/perception/markers/spot_window.hpp"
#include "libs/rgbd/depth_noise.hpp"

namespace palpate::perception {

struct FiducialClassifierTuning {
  SpotWindowTuning window = {};
  CurvedSurfaceTuning surface = {};
  /// Share of a spot's pixels with depth. Larger: markers at holes of the depth image are lost.
  double least_depth_share = 0.5;
  /// Reach of the surface fit beyond the rim, in radii. Larger: less noise, other surfaces enter.
  double surface_reach_radii = 0.8;
  /// Cosine of normal and ray below which a disc is too edge-on. Smaller: more, less exact markers.
  double least_cosine = 0.3;
  /// Second moment of the blur by lens and colour mosaic (1-2-1) in the colour image. Larger:
  /// smaller, rounder discs.
  double blur_px2 = 0.5;
  /// Error of the centre over radius and open share of the rim. Larger: wider covariances of partly
  /// hidden markers.
  double open_shift = 0.5;
};

/// Classifies spots of a marker colour as markers or not, and measures them.
class FiducialClassifier {
 public:
  /// `registration` must outlive this.
  FiducialClassifier(const FiducialConfig& config, const Registration& registration,
                     const FiducialClassifierTuning& tuning = {});

  /// Adds a fiducial to `found`, or one to a count of what was rejected.
  void Classify(const ColorSpot& spot, const RegisteredFrame& frame, FiducialFrame* found);

 private:
  /// Where a rejected spot is counted; nullptr: it is a marker.
  using Reason = int FiducialRejections::*;

  Reason Measure(const ColorSpot& spot, const RegisteredFrame& frame, Fiducial* fiducial);
  Reason CheckDepth(const ColorSpot& spot, const RegisteredFrame& frame);
  bool FitSurface(CurvedSurface* surface);
  double OpenRim(const SpotColors& colors) const;
  Reason CheckShape(const CurvedSurface& surface, const CurvedSurface::Point& center,
                    double area_m2) const;
  Eigen::Matrix2d Moments(const CurvedSurface& surface, const CurvedSurface::Point& center,
                          double area_m2) const;
  void SetCovariance(const CurvedSurface& surface, const SpotColors& colors,
                     Fiducial* fiducial) const;
  CurvedSurface::Point CenterOn(const CurvedSurface& surface,
                                const CurvedSurface::Coefficients& coefficients,
                                double* area_m2) const;
  double PlaceSigma_px(const SpotColors& colors, const Fiducial& fiducial) const;

  bool InSpot(const SpotWindow::Pixel& pixel) const {
    return pixel.distance_px <= tuning_.window.spot_reach_px;
  }

  const FiducialConfig config_;
  const FiducialClassifierTuning tuning_;
  const Registration& registration_;
  rgbd::DepthNoise noise_;
  SpotWindow window_;
  std::vector<char> on_surface_;  ///< [pixels of the window]
  std::vector<DepthSample> samples_;
  std::vector<double> depths_m_;
  double z_m_ = 0.0;            ///< of the spot
  double sigma_m_ = 0.0;        ///< of a depth there
  Eigen::Vector2d step_{0, 0};  ///< from pixel to pixel in the normalised image
  double blur_px2_ = 0.0;       ///< second moment of the colour's blur, in the depth image
  double rough_radius_px_ = 0.0;
};

}  // namespace palpate::perception

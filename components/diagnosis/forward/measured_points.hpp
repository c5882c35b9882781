// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/camera_view.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

/// What is measured: by what, and in which frame, may differ between them.
enum class Target { kMarkers, kSurface };

/// The markers, or the features of the surface, as they stand before whatever measures them; frame
/// of the measurement, of the surface that of the depth camera.
struct MeasuredPoints {
  std::vector<SeenPoint> points;     ///< [markers] or [features]
  std::optional<CameraView> camera;  ///< nothing: they are measured where they are

  const SeenPoint& point(Eigen::Index k) const { return points[At(k)]; }
  Eigen::Vector3d Measured(Eigen::Index k) const {
    return camera ? camera->Measured(point(k)) : point(k).at_m;
  }
};

/// The depth camera that saw this of a sample, with these errors; nothing: none did.
std::optional<CameraView> ViewOf(const CameraErrors& errors, const ObservedExperiment& observed,
                                 const Sample& sample, Target target);

/// What of a drift is there at a sample, mean over its frames: 1 - exp(-t / tau), t since the
/// experiment's first stamp.
double DriftShare(const ObservedExperiment& observed, const Sample& sample, double tau_s);
/// d DriftShare / d ln tau.
double DriftShareByTau(const ObservedExperiment& observed, const Sample& sample, double tau_s);

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/model/camera_view.hpp"

namespace palpate::diagnosis {

/// The markers as they stand before whatever measures them, measurement frame.
struct Sight {
  std::vector<SeenPoint> points;     ///< [markers]
  std::optional<CameraView> camera;  ///< nothing: they are measured where they are

  const SeenPoint& point(Eigen::Index marker) const {
    return points[static_cast<std::size_t>(marker)];
  }
  Eigen::Vector3d Measured(Eigen::Index marker) const {
    return camera ? camera->Measured(point(marker)) : point(marker).at_m;
  }
};

/// The depth camera that saw a sample, with these errors; nothing: none did.
std::optional<CameraView> ViewOf(const CameraErrors& errors, const ObservedExperiment& observed,
                                 const Sample& sample);

/// What of a drift is there at a sample, mean over its frames: 1 - exp(-t / tau), t since the
/// experiment's first stamp.
double DriftShare(const ObservedExperiment& observed, const Sample& sample, double tau_s);
/// d DriftShare / d ln tau.
double DriftShareByTau(const ObservedExperiment& observed, const Sample& sample, double tau_s);

}  // namespace palpate::diagnosis

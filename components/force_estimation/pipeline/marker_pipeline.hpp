// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/pipeline/pipeline.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Forces from marker positions: the frames of MarkerForceEstimator.
class MarkerPipeline : public Pipeline {
 public:
  /// `model`, to which `calibration` was applied, must outlive the pipeline. The errors of the
  /// calibration's moduli widen the intervals. Throws InputError for settings that do not fit the
  /// robot.
  MarkerPipeline(robot::RobotModel& model, const Config& config,
                 const robot::CalibrationFile& calibration);

  /// `frame` must hold a MarkerFrame.
  const PipelineResult& Update(PipelineFrame frame) override;
  /// Reference frames are left out.
  void Monitor() override;

 private:
  Eigen::Matrix3Xd MarkersOf(const Eigen::VectorXd& x_m) const;

  MarkerForceEstimator estimator_;
  ModelGapMeter gap_;
  ModelResidualMonitor residual_monitor_;
  ExtrinsicsDriftMonitor drift_monitor_;
  std::vector<fem::BodyPoint> points_;  ///< of the markers
  Eigen::Vector3d centre_m_;            ///< of the markers of the undeformed body, robot frame
  MarkerFrame frame_;                   ///< the last one
  PipelineResult result_;
};

}  // namespace palpate::force_estimation

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/monitor/fixed_surface_region.hpp"
#include "components/force_estimation/pipeline/pipeline.hpp"
#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/force_estimation/shape/shape_force_estimator.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Forces from the robot's shape in the frames of one or more depth cameras, in five steps:
///
/// 1. The first `ShapeConfig::untouched_frames` frames in which perception found the robot count as
///    contact-free: the depth bias is estimated from them.
/// 2. Contacts of known location take the place of those that perception located there.
/// 3. ShapeForceEstimator estimates the frame.
/// 4. Its nodes, in single precision as on /robot/mesh_state, predict the shape of the next frame.
/// 5. Where the robot is not seen, the status is perception's, which has the reason.
class ShapePipeline : public Pipeline {
 public:
  /// The methods of ShapeForceEstimator, which a test may replace.
  struct Estimator {
    std::function<const ForceEstimate&(const ShapeFrame&)> update;
    std::function<const std::vector<FeatureReport>&()> features;
    std::function<void()> prepare_next;
    std::function<std::vector<BiasSequence>()> judge_bias_frames = {};
  };

  /// `model`, to which `calibration` was applied, must outlive the pipeline. Of the calibration the
  /// errors of the moduli and the depth biases count. `cameras`: names of the cameras beside the
  /// first, in the order of a frame's views. `shape.untouched_frames` may be 0: then only
  /// frames with `untouched` are contact-free. Throws InputError for settings that do not fit the
  /// robot, and for a robot without feature points.
  ShapePipeline(robot::RobotModel& model, const Config& config, const ShapeConfig& shape,
                const robot::CalibrationFile& calibration,
                const std::vector<std::string>& cameras = {});
  /// `contacts`: given by the settings. `body` must outlive the pipeline.
  ShapePipeline(const robot::RobotBody& body, std::vector<ContactSite> contacts,
                int contact_free_frames, Estimator estimator);

  /// `frame` must hold a PerceivedShape.
  const PipelineResult& Update(PipelineFrame frame) override;
  void PrepareNext() override { estimator_.prepare_next(); }
  void Monitor() override;

  /// [3 x n] nodes of the last frame whose state is known, robot frame, as perception receives
  /// them; without columns where there was none yet.
  Eigen::Matrix3Xf PredictedNodes_m() const;
  /// Whether the frames with `untouched`, by epoch, were contact-free.
  std::vector<BiasSequence> JudgeBiasFrames() const { return estimator_.judge_bias_frames(); }
  /// The shape `x_m` [3n] in which the next frame is expected, robot frame: the posture that the
  /// commands give, at the start of a sequence.
  void Expect(const Eigen::VectorXd& x_m) override { nodes_m_ = x_m.cast<float>().cast<double>(); }

 private:
  void MarkContactFree();
  void AddKnownContacts();
  void PredictShape();
  void KeepReasonOfPerception();
  DriftReport WorstDrift() const;

  std::vector<ContactSite> contacts_;
  int contact_free_frames_;
  Estimator estimator_;
  KnownContacts known_contacts_;
  FeatureGapMeter gap_;
  ModelResidualMonitor residual_monitor_;
  FixedSurfaceRegion fixed_region_;
  std::vector<ExtrinsicsDriftMonitor> drift_monitors_;  ///< of each camera
  double drift_measured_s_;  ///< time of the last frame that drift_monitors_ have
  int frames_with_robot_ = 0;
  Eigen::VectorXd nodes_m_;  ///< [3n] predicted, rounded to single precision
  PerceivedShape shape_;     ///< of the last frame
  PipelineResult result_;
};

}  // namespace palpate::force_estimation

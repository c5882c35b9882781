// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <variant>
#include <vector>

#include "components/force_estimation/contact_site.hpp"
#include "components/force_estimation/force_estimate.hpp"
#include "components/force_estimation/marker_frame.hpp"
#include "components/force_estimation/monitor/extrinsics_drift_monitor.hpp"
#include "components/force_estimation/monitor/model_gap.hpp"
#include "components/force_estimation/monitor/model_residual_monitor.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// The robot's shape in one frame of the depth cameras, as perception has segmented it.
struct PerceivedShape {
  ShapeFrame frame;   ///< `untouched`: the frame is known to be contact-free
  Status perception;  ///< ok: perception found the robot, in the view of a camera at least
  /// Where loads are known to act in this frame; used as contacts where the settings give none.
  std::vector<ContactSite> loads = {};
};

using PipelineFrame = std::variant<MarkerFrame, PerceivedShape>;

/// Result of one frame.
struct PipelineResult {
  ForceEstimate estimate;
  ModelGapReport gap;           ///< residual of this frame
  bool state_is_known = false;  ///< estimate.x_m predicts the robot's shape
  Status state;                 ///< ok: x_m is the equilibrium that explains the frame
  DriftReport drift = {};       ///< of the frames before this one
  GapReport gap_so_far = {};    ///< of the frames before this one
  /// Contact-free frames that are still to come until there are forces, with this one.
  int bias_frames_to_come = 0;
};

/// From frames of one sequence to forces, with the state that a sequence keeps: contact-free frames
/// at its start, contacts of known location, the predicted shape, monitors. The process and
/// `palpate estimate` run the same pipeline, so that the same frames give the same forces.
class Pipeline {
 public:
  virtual ~Pipeline() = default;

  /// The result of one frame; it stays valid until the next call.
  virtual const PipelineResult& Update(PipelineFrame frame) = 0;
  /// The shape `x_m` [3n] in which the first frame is expected, robot frame: the posture that the
  /// cable inputs give.
  virtual void Expect(const Eigen::VectorXd& /*x_m*/) {}
  /// Computes what the next frame needs and the result of this one does not.
  virtual void PrepareNext() {}
  /// Adds the last frame to the monitors, whose reports the next results hold. Forces do not depend
  /// on it.
  virtual void Monitor() {}
};

/// Makes the pipeline of a sequence. The model must outlive it.
using PipelineMaker = std::function<std::unique_ptr<Pipeline>(robot::RobotModel&)>;

}  // namespace palpate::force_estimation

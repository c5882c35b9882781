// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/monitor/extrinsics_drift_monitor.hpp"
#include "components/force_estimation/monitor/model_gap.hpp"
#include "components/force_estimation/monitor/model_residual_monitor.hpp"
#include "components/force_estimation/shape/shape_frame.hpp"

namespace palpate::force_estimation {

/// Which frame something belongs to.
struct FrameHead {
  int64_t stamp_ns = 0;
  uint64_t counter = 0;
  std::string recording;
  std::chrono::steady_clock::time_point taken;  ///< when it was taken from DDS
};

/// What a depth camera sees of the robot.
struct SeenShape {
  ShapeFrame frame;
  Status looked;  ///< what perception says about the frame
};

struct NewCalibration;  // frame_estimator.hpp

/// A frame on its way to the estimator.
struct FrameInput {
  FrameHead head;
  bool new_sequence = false;  ///< what was learnt from earlier frames is void
  std::variant<MarkerFrame, SeenShape> frame;
  /// Holds from this frame on; nullptr: as before.
  std::shared_ptr<const NewCalibration> calibration = nullptr;

  std::vector<robot::CableCommand>& cables() {
    if (auto* shape = std::get_if<SeenShape>(&frame)) return shape->frame.cables;
    return std::get<MarkerFrame>(frame).cables;
  }
  /// Whether a newer frame may take its place.
  bool overtakable() const {
    const auto* markers = std::get_if<MarkerFrame>(&frame);
    return !new_sequence && (!markers || markers->reference == ReferenceShape::kNone);
  }
};

/// What came of it.
struct FrameResult {
  FrameHead head;
  ForceEstimate estimate;
  ModelGapReport gap;
  bool state_is_known = false;  ///< estimate.x_m may be shown to others
  Status state;                 ///< ok: x_m is where the robot is believed to be
  DriftReport drift = {};       ///< of the camera, before this frame
  GapReport gap_so_far = {};    ///< of the sequence, before this frame
};

}  // namespace palpate::force_estimation

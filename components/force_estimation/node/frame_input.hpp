// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "components/force_estimation/pipeline/pipeline.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Identifies a frame.
struct FrameHead {
  int64_t stamp_ns = 0;
  uint64_t counter = 0;
  std::string recording;
  std::chrono::steady_clock::time_point taken;  ///< when it was taken from DDS
};

/// Changes the model between two frames.
struct NewCalibration {
  robot::CalibrationFile calibration;  ///< CheckCalibration is ok
  PipelineMaker maker;                 ///< of pipelines from now on; empty: as before
};

/// A frame on its way to the pipeline.
struct FrameInput {
  FrameHead head;
  bool new_sequence = false;  ///< the state of earlier frames is void
  PipelineFrame frame;
  /// Holds from this frame on; nullptr: as before.
  std::shared_ptr<const NewCalibration> calibration = nullptr;
  /// There is no frame yet: the posture that its cable inputs give is computed and expected.
  bool posture_only = false;

  std::vector<robot::ActuatorCommand>& cables() {
    if (auto* shape = std::get_if<PerceivedShape>(&frame)) return shape->frame.cables;
    return std::get<MarkerFrame>(frame).cables;
  }
  /// Whether a newer frame may take its place in the queue.
  bool overtakable() const {
    const auto* markers = std::get_if<MarkerFrame>(&frame);
    return !new_sequence && (!markers || markers->reference == ReferenceShape::kNone);
  }
};

/// What the pipeline made of a frame.
struct FrameResult : PipelineResult {
  FrameHead head;
  bool posture_only = false;  ///< the answer to such an input: state and estimate.x_m alone
};

}  // namespace palpate::force_estimation

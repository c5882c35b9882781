// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "components/force_estimation/node/frame_input.hpp"

#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Whom a source tells what came.
struct FrameEvents {
  std::function<void()> came;  ///< a frame, whatever may be wrong with it
  /// What comes next goes back in time, or has nothing to do with what came before.
  std::function<void(bool time_went_back, bool anew)> sequence;
  std::function<void(FrameInput)> accepted;
  std::function<void(const FrameHead&, const Status&)> refused;
  std::function<void(const FrameHead&)> repeated;  ///< the last frame once more
};

/// Takes frames from DDS, in the thread of the node's loop.
class FrameSource {
 public:
  explicit FrameSource(FrameEvents events) : events_(std::move(events)) {}
  virtual ~FrameSource() = default;

  /// What holds from now on: where the depth camera stands, and which images its depth bias is
  /// for.
  virtual void SetCalibration(const robot::CalibrationFile&) {}

  virtual std::string name() const = 0;  ///< of what comes, for a person: "markers"
  virtual uint64_t dropped() const = 0;  ///< frames that were lost or overtaken on the way here
  virtual uint32_t writers() const = 0;  ///< whose frames it takes
  virtual uint32_t incompatible_qos() const = 0;

 protected:
  const FrameEvents& events() const { return events_; }

 private:
  FrameEvents events_;
};

}  // namespace palpate::force_estimation

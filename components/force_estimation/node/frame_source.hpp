// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "components/force_estimation/node/frame_input.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/input_monitor.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// A frame that is not estimated, with the reason.
struct RefusedFrame {
  FrameHead head;
  Status status;
};

/// The last frame once more.
struct RepeatedFrame {
  FrameHead head;
};

/// How a sequence of frames relates to the one before it.
struct SequenceStart {
  bool time_went_back = false;
  bool unrelated = false;  ///< the state of earlier frames does not hold
};

/// One frame as it comes from DDS.
struct FrameArrival {
  std::variant<FrameInput, RefusedFrame, RepeatedFrame> frame;
  std::optional<SequenceStart> sequence = std::nullopt;  ///< which the frame begins
  std::optional<double> delay_s = std::nullopt;  ///< from its sender to here; nullopt: not known
  bool counts = true;  ///< as received; false for a repeated part of a frame
};

/// Takes frames from DDS, in the thread of the node's loop.
class FrameSource {
 public:
  using TakeArrival = std::function<void(FrameArrival)>;

  explicit FrameSource(TakeArrival take) : take_(std::move(take)) {}
  virtual ~FrameSource() = default;

  /// Uses the camera pose of a calibration, and checks images by its depth bias, from now on.
  virtual void SetCalibration(const robot::CalibrationFile&) {}

  /// Has `inputs` watch the readers, which this owns.
  virtual void ExpectInputs(dds::InputMonitor& inputs) const = 0;

  virtual std::string name() const = 0;  ///< of the frames, for messages: "markers"
  virtual uint64_t dropped() const = 0;  ///< frames that were lost or overtaken before they came
  virtual bool knows_camera_pose() const { return true; }  ///< or needs none
  virtual uint32_t writers() const = 0;                    ///< that match its readers
  virtual uint32_t incompatible_qos() const = 0;

 protected:
  void HandOver(FrameArrival arrival) const { take_(std::move(arrival)); }

 private:
  TakeArrival take_;
};

}  // namespace palpate::force_estimation

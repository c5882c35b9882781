// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/marker_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Constant marker offsets, measured minus model, from frames of a known shape of the body. All
/// consecutive frames of one reference shape are averaged.
class MarkerOffsetCalibration {
 public:
  explicit MarkerOffsetCalibration(robot::RobotModel& model);

  /// Adds a frame with a reference shape. Another shape than before, and the first frame after
  /// Finish(), begin a new calibration.
  void Add(const MarkerFrame& frame);

  /// Computes the offsets where frames were added since the last call. kOk also without any frame:
  /// the offsets are zero then. Else the status of the solution for the equilibrium.
  Status Finish();

  /// Measured minus model [3m], robot frame, m; 0 for markers that were in no reference frame.
  const Eigen::VectorXd& offset_m() const { return offset_; }
  /// Frames that the offset of a marker is the mean of; 0: its offset is no measurement. The noise
  /// of a frame over the root of this is an error that all later frames share.
  int FrameCount(size_t marker) const { return calibrated_ ? counts_[marker] : 0; }
  /// Mean measured position [3 x m] in the frames that the offsets are of, robot frame, m; NaN for
  /// markers that have no measured offset.
  const Eigen::Matrix3Xd& reference_m() const { return reference_m_; }
  /// Whether the marker may be used: it has an offset, or there was no calibration.
  bool Usable(size_t marker) const { return !calibrated_ || counts_[marker] > 0; }

 private:
  robot::RobotModel& model_;
  MarkerFrame last_;
  Eigen::VectorXd sum_;
  Eigen::VectorXd offset_;
  std::vector<int> counts_;
  Eigen::Matrix3Xd reference_m_;
  bool open_ = false;
  bool calibrated_ = false;
};

}  // namespace palpate::force_estimation

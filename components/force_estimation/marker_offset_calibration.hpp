// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/force_estimation/marker_frame.hpp"
#include "libs/core/status.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// Constant offsets between the markers as they are measured and as the model has them, from frames
/// in which the shape of the body was known.
class MarkerOffsetCalibration {
 public:
  explicit MarkerOffsetCalibration(robot::RobotModel& model);

  /// Takes one frame with a reference shape. One of another shape, or the first after Offset() was
  /// asked for, starts a new tare.
  void Add(const MarkerFrame& frame);

  /// Finishes the tare where frames were added since. kOk also where there never was one: the
  /// offsets are zero then.
  Status Finish();

  /// Measured minus model [3m], robot frame, m; 0 for markers that no reference frame showed.
  const Eigen::VectorXd& offset_m() const { return offset_; }
  /// Whether the marker may be used: seen in the tare, or there was none.
  bool Usable(size_t marker) const { return !tared_ || counts_[marker] > 0; }

 private:
  Status ModelPositions(Eigen::VectorXd* positions_m);

  robot::RobotModel& model_;
  MarkerFrame last_;
  Eigen::VectorXd sum_;
  Eigen::VectorXd offset_;
  std::vector<int> counts_;
  bool open_ = false;
  bool tared_ = false;
};

}  // namespace palpate::force_estimation

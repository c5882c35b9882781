// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/marker_offset_calibration.hpp"

#include <algorithm>
#include <limits>

#include "components/force_estimation/rest_markers.hpp"
#include "libs/core/index.hpp"

namespace palpate::force_estimation {

MarkerOffsetCalibration::MarkerOffsetCalibration(robot::RobotModel& model)
    : model_(model),
      sum_(Eigen::VectorXd::Zero(ToIndex(3 * model.body().markers.size()))),
      offset_(sum_),
      counts_(model.body().markers.size(), 0),
      reference_m_(Eigen::Matrix3Xd::Constant(3, ToIndex(counts_.size()),
                                              std::numeric_limits<double>::quiet_NaN())) {}

void MarkerOffsetCalibration::Add(const MarkerFrame& frame) {
  if (!open_ || frame.reference != last_.reference) {
    sum_.setZero();
    std::fill(counts_.begin(), counts_.end(), 0);
  }
  open_ = true;
  last_ = frame;
  for (size_t m = 0; m < counts_.size(); ++m) {
    if (!frame.markers[m].valid || !frame.markers[m].position_m.allFinite()) continue;
    sum_.segment<3>(ToIndex(3 * m)) += frame.markers[m].position_m;
    ++counts_[m];
  }
}

Status MarkerOffsetCalibration::Finish() {
  if (!open_) return Status::Ok();
  Eigen::VectorXd model_positions;
  Status status = ReferenceMarkers(model_, last_.reference, last_.cables, &model_positions);
  if (!status.ok()) return status;
  offset_.setZero();
  reference_m_.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (size_t m = 0; m < counts_.size(); ++m) {
    if (counts_[m] == 0) continue;
    const auto row = ToIndex(3 * m);
    reference_m_.col(ToIndex(m)) = sum_.segment<3>(row) / counts_[m];
    offset_.segment<3>(row) = reference_m_.col(ToIndex(m)) - model_positions.segment<3>(row);
  }
  open_ = false;
  calibrated_ = true;
  return Status::Ok();
}

}  // namespace palpate::force_estimation

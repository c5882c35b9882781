// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "components/calibration/live/frame_collector.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/message.hpp"
#include "libs/dds/topics.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::calibration {

/// A calibration request.
struct Request {
  std::string id;
  bool cancel = false;
  std::string source;               ///< "clouds" or "markers"
  int frames = 0;                   ///< > 0
  std::vector<std::string> moduli;  ///< parts of the robot
  bool actuator_gains = false;
};

/// `defaults`: values for empty fields. kInvalidInput for an unknown action or source, and for more
/// than 100 frames; the id is set even then.
Status FromRequest(const idl::palpate_msgs::CalibrationRequest& message, const Request& defaults,
                   Request* request);

/// Observed markers of the robot (`names`) in the camera frame, with covariances of `sigma_m` where
/// the message has none; -1 for one without a name. kInvalidInput, with the reason, for another
/// frame, an unknown (with "did you mean") or duplicate marker, a number that is not finite.
Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message,
                       const std::vector<std::string>& names, double sigma_m, SeenMarkers* seen);

/// `pose_covariance`: rotation vector (rad), then translation (m).
dds::Message<idl::palpate_msgs::Calibration> ToCalibration(
    const robot::CalibrationFile& file, const Eigen::Matrix<double, 6, 6>& pose_covariance,
    std::int64_t stamp_ns);

/// Progress of a request.
struct Progress {
  std::string request_id;
  std::string state = "idle";
  Status status = Status::Ok();
  std::string reason;  ///< what is missing; unused where the status is not ok
  int frames_taken = 0;
  int frames_wanted = 0;
};
dds::Message<idl::palpate_msgs::CalibrationStatus> ToStatus(const Progress& progress,
                                                            std::int64_t stamp_ns);

}  // namespace palpate::calibration

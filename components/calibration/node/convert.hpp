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

/// What somebody asks for.
struct Request {
  std::string id;
  bool cancel = false;
  std::string source;               ///< "clouds" or "markers"
  int frames = 0;                   ///< > 0
  std::vector<std::string> moduli;  ///< parts of the robot
  bool drive_gains = false;
};

/// `defaults`: what holds where the message does not say. kInvalidInput for an action or a source
/// that there is none of, and for more than 100 frames; the id is set even then.
Status FromRequest(const idl::palpate_msgs::CalibrationRequest& message, const Request& defaults,
                   Request* request);

/// Markers of the robot (`names`) in the camera's frame, those that were seen, with their
/// covariances, of `sigma_m` where a marker has none; -1 for one without a name. kInvalidInput,
/// with the reason, for another frame, a marker that is not among `names` (with "did you mean") or
/// comes twice, a number that is not finite.
Status FromMarkerArray(const idl::palpate_msgs::MarkerArray3& message,
                       const std::vector<std::string>& names, double sigma_m, SeenMarkers* seen);

/// `pose_covariance`: rotation vector (rad), then translation (m).
dds::Message<idl::palpate_msgs::Calibration> ToCalibration(
    const robot::CalibrationFile& file, const Eigen::Matrix<double, 6, 6>& pose_covariance,
    std::int64_t stamp_ns);

/// How a request fares.
struct Progress {
  std::string request_id;
  std::string state = "idle";
  Status status = Status::Ok();
  std::string reason;  ///< what is waited for; a status that is not ok says its own
  int frames_taken = 0;
  int frames_wanted = 0;
};
dds::Message<idl::palpate_msgs::CalibrationStatus> ToStatus(const Progress& progress,
                                                            std::int64_t stamp_ns);

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "libs/core/config_reader.hpp"
#include "libs/dds/node_settings.hpp"
#include "libs/fem/sparse/solver_settings.hpp"

namespace palpate::calibration {

/// Settings of the process.
struct NodeConfig {
  std::string calibration_file;
  std::string source = "clouds";
  std::string camera_pose;
  std::vector<std::string> cameras;
  int frames = 6;
  bool at_start = false;
  double still_s = 1.0;
  double still_m = 5e-5;
  double still_N = 0.05;
  double new_setting_m = 1e-3;
  double new_setting_N = 0.1;
  double patience_s = 60.0;
  bool allow_contacts = false;
  bool fit_depth_bias = true;
  int marker_pictures = 20;
  double marker_sigma_m = 3e-4;
  double marker_bias_m = 0.0;
  double marker_depth_bias = CloudSettings().depth_bias_sigma;
  std::string cable_input = "displacement";
  double drive_offset_sigma_m = 2e-3;
  double drive_gain_sigma = 0.05;
  double modulus_relative_sigma = 0.5;
  std::string solver = fem::SolverSettings().solver;
  int threads = fem::SolverSettings().threads;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    constexpr NumberRule positive{.min = 0.0, .min_open = true};
    v("calibration_file", calibration_file,
      "File to which each calibration is written, as by `palpate calibrate`; an existing file is "
      "read and published at the start; empty: none");
    v("source", source, {"clouds", "markers"},
      "Data of a calibration unless the request names them: /perception/robot_cloud, or "
      "/perception/markers in the camera frame");
    v("camera_pose", camera_pose,
      "Approximate pose of the depth camera in the robot frame, \"{translation_m: [x, y, z], "
      "rotation_xyzw: [x, y, z, w]}\": initial pose for clouds; empty: that of the last "
      "calibration; for unnamed markers on a symmetric robot it decides which marker is which, and "
      "where it is empty the cables do, then the last calibration");
    v("cameras", cameras,
      "Depth cameras beside the first, as perception has them: \"NAME: {translation_m: [x, y, z], "
      "rotation_xyzw: [x, y, z, w]}\", its approximate pose, or \"NAME\" where the last "
      "calibration has it; clouds calibrate each of them after the first");
    v("frames", frames, {.min = 1.0, .max = 100.0},
      "Frames of a calibration unless the request gives a number, each at another setting of the "
      "cables");
    v("at_start", at_start, "Starts a calibration at the start, without a request");
    v("still_s", still_s, positive, "Time without motion after which the cables count as at rest");
    v("still_m", still_m, positive, "Largest change of a displacement that counts as no motion");
    v("still_N", still_N, positive, "Largest change of a tension that counts as no motion");
    v("new_setting_m", new_setting_m, positive,
      "Smallest change of a displacement that makes a new setting of the cables");
    v("new_setting_N", new_setting_N, positive,
      "Smallest change of a tension that makes a new setting of the cables");
    v("patience_s", patience_s, positive,
      "Time without a further frame after which the calibration fails");
    v("allow_contacts", allow_contacts, "Also uses clouds in which perception detects a contact");
    v("fit_depth_bias", fit_depth_bias,
      "Estimates the depth bias together with the pose, from clouds (Limits)");
    v("marker_pictures", marker_pictures, {.min = 1.0, .max = 10000.0},
      "Marker messages whose mean makes one frame");
    v("marker_sigma_m", marker_sigma_m, positive,
      "Marker noise, one standard deviation, where /perception/markers has none");
    v("marker_bias_m", marker_bias_m, {.min = 0.0},
      "Constant error of each marker that averaging does not remove, one standard deviation");
    v("marker_depth_bias", marker_depth_bias, {.min = 0.0, .max = 0.1},
      "Standard deviation of the depth bias common to all markers, as a share of z; 0 where "
      "markers do not come from a depth image");
    v("cable_input", cable_input, {"displacement", "tension"},
      "Input of a cable that is used where both are known");
    v("drive_offset_sigma_m", drive_offset_sigma_m, positive,
      "Prior standard deviation of an actuator's offset");
    v("drive_gain_sigma", drive_gain_sigma, positive,
      "Prior standard deviation of an actuator's gain, where it is estimated");
    v("modulus_relative_sigma", modulus_relative_sigma, positive,
      "Prior standard deviation of ln E, where a modulus is estimated");
    v("solver", solver, fem::SolverNames(), "Sparse Cholesky of the model");
    v("threads", threads, {.min = 1.0, .max = 256.0}, "Threads of the model's solver");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::calibration

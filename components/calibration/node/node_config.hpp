// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

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
      "Where what is found is written, as `palpate calibrate` does; read and published at the "
      "start where it is there; empty: neither");
    v("source", source, {"clouds", "markers"},
      "What is calibrated from where a request does not say: /perception/robot_cloud, or "
      "/perception/markers in the camera's frame");
    v("camera_pose", camera_pose,
      "Roughly where the depth camera stands in the robot's frame, \"{translation_m: [x, y, z], "
      "rotation_xyzw: [x, y, z, w]}\": clouds start from it; empty: from the last calibration; of "
      "markers without names on a robot that looks the same after a turn it tells which is which, "
      "and so does the last calibration where cables leave it open");
    v("frames", frames, {.min = 1.0, .max = 100.0},
      "Frames of a calibration where the request does not say, each of another setting of the "
      "cables");
    v("at_start", at_start, "Begins a calibration at the start, without a request");
    v("still_s", still_s, positive, "Cables that moved little for so long are at rest");
    v("still_m", still_m, positive, "Little: of a displacement");
    v("still_N", still_N, positive, "Little: of a tension");
    v("new_setting_m", new_setting_m, positive,
      "A cable's displacement must have changed by so much for another frame,");
    v("new_setting_N", new_setting_N, positive, "or its tension by so much");
    v("patience_s", patience_s, positive, "Without a further frame for so long it is given up");
    v("allow_contacts", allow_contacts,
      "Clouds in which perception sees something touch the robot serve, too");
    v("fit_depth_bias", fit_depth_bias,
      "From clouds, find the smooth error of the depth image with the pose (Limits)");
    v("marker_pictures", marker_pictures, {.min = 1.0, .max = 10000.0},
      "A frame of markers is the mean over so many pictures");
    v("marker_sigma_m", marker_sigma_m, positive,
      "Marker noise where /perception/markers has none");
    v("marker_bias_m", marker_bias_m, {.min = 0.0},
      "Constant error of each marker that averaging does not remove, one sigma");
    v("marker_depth_bias", marker_depth_bias, {.min = 0.0, .max = 0.1},
      "Sigma, as a share of z, of the smooth error that the depths of all markers have in common; "
      "0 where they do not go by a depth image");
    v("cable_input", cable_input, {"displacement", "tension"},
      "Which input of a cable counts where both are known");
    v("drive_offset_sigma_m", drive_offset_sigma_m, positive,
      "How far a drive's zero may be off, one sigma");
    v("drive_gain_sigma", drive_gain_sigma, positive,
      "How far its gain may be off 1, one sigma, where it is looked for");
    v("modulus_relative_sigma", modulus_relative_sigma, positive,
      "How far a modulus that is looked for may be off, one sigma of its logarithm");
    v("solver", solver, fem::SolverNames(), "Sparse Cholesky of the model");
    v("threads", threads, {.min = 1.0, .max = 256.0}, "Threads of the model's solver");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "libs/dds/node_settings.hpp"

namespace palpate::force_estimation {

/// Settings of the process: those of the estimators, and those of its inputs and its DDS side.
struct NodeConfig : Config {
  ShapeConfig shape;
  std::string source = "auto";
  std::string camera_pose;
  std::vector<std::string> cameras;
  bool follow_calibration = true;
  bool expect_posture = true;
  std::string cable_input = "displacement";
  double max_age_s = 0.0;
  double cable_wait_s = 0.5;
  double max_cable_age_s = 0.5;
  double silence_s = 2.0;
  double late_s = 0.3;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    Config::Visit(v);
    v("shape", shape, "Forces from the robot's shape");
    v("source", source, {"auto", "markers", "shape"},
      "Data for the estimation; auto: shape where camera_pose is given, else markers");
    v("camera_pose", camera_pose,
      "Depth camera in the robot's frame, \"{translation_m: [x, y, z], rotation_xyzw: [x, y, z, "
      "w]}\"; needed for the shape, unless /calibration or /tf say it");
    v("cameras", cameras,
      "Depth cameras beside the first, as perception has them: \"NAME: {translation_m: [x, y, z], "
      "rotation_xyzw: [x, y, z, w]}\", or \"NAME\" where --calibration has its pose; the camera "
      "poses of /calibration count where it has those of all cameras");
    v("follow_calibration", follow_calibration,
      "Use camera pose, actuator offsets and moduli of /calibration from the next frame on, "
      "which begins a sequence; false: keep those of the start");
    v("expect_posture", expect_posture,
      "With source shape: publish the posture that the cable inputs give on /robot/mesh_state "
      "until the first frame; false: what is made of a recording does not depend on when they "
      "come");
    v("cable_input", cable_input, {"displacement", "tension"},
      "Boundary condition of cables with both inputs: prescribed displacement or tension");
    v("max_age_s", max_age_s, {.min = 0.0},
      "Largest age of a frame by the system clock; 0: no limit (recordings)");
    v("cable_wait_s", cable_wait_s, {.min = 0.0},
      "Longest wait of a frame for the cable inputs of its time");
    v("max_cable_age_s", max_cable_age_s, {.min = 0.0},
      "Largest age of cable inputs after that wait");
    v("silence_s", silence_s, {.min = 0.0, .min_open = true},
      "Time without frames after which the status is stale; with source shape, /forces says so "
      "once a second");
    v("late_s", late_s, {.min = 0.0},
      "Time from perception to this process from which clouds are late, and the status is stale; "
      "0: none is");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::force_estimation

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "libs/dds/node_settings.hpp"

namespace palpate::force_estimation {

/// Settings of the process: those of the estimators, and those of its inputs and its DDS side.
struct NodeConfig : Config {
  ShapeConfig shape;
  std::string source = "auto";
  std::string camera_pose;
  bool follow_calibration = true;
  std::string cable_input = "displacement";
  double max_age_s = 0.0;
  double cable_wait_s = 0.5;
  double max_cable_age_s = 0.5;
  double silence_s = 2.0;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    Config::Visit(v);
    v("shape", shape, "Forces from the robot's shape");
    v("source", source, {"auto", "markers", "shape"},
      "What forces are estimated from; auto: the shape where camera_pose is given, else markers");
    v("camera_pose", camera_pose,
      "Depth camera in the robot's frame, \"{translation_m: [x, y, z], rotation_xyzw: [x, y, z, "
      "w]}\"; needed for the shape, unless /calibration is to say it");
    v("follow_calibration", follow_calibration,
      "Takes what comes on /calibration: pose, drives and moduli, from the next frame on, which "
      "begins a sequence; false: what is given at the start stays");
    v("cable_input", cable_input, {"displacement", "tension"},
      "Which input of a cable is imposed where both are known");
    v("max_age_s", max_age_s, {.min = 0.0},
      "Frames older than this by the system clock are refused; 0: stamps are not compared with it "
      "(recordings)");
    v("cable_wait_s", cable_wait_s, {.min = 0.0},
      "How long a frame waits for the cable inputs of its time");
    v("max_cable_age_s", max_cable_age_s, {.min = 0.0},
      "After that wait, cable inputs may be older than the frame by so much");
    v("silence_s", silence_s, {.min = 0.0, .min_open = true},
      "Without frames for so long the component reports itself stale; from the shape /forces says "
      "so too, once a second");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::force_estimation

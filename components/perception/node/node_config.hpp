// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/perception/config.hpp"
#include "components/perception/node/camera_config.hpp"
#include "libs/dds/node_settings.hpp"

namespace palpate::perception {

/// Settings of the process: those of Perception, and those of its inputs and its DDS side.
struct NodeConfig : Config {
  std::string camera_pose;
  bool follow_calibration = true;
  std::vector<std::string> cameras;
  double camera_wait_s = 0.1;
  double pairing_wait_s = 0.1;
  double max_prediction_age_s = 1.0;
  double await_prediction_s = 0.0;
  double silence_s = 2.0;
  double late_s = 0.3;
  CameraConfig camera;
  dds::NodeSettings dds;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    Config::Visit(v);
    v("camera_pose", camera_pose,
      "Pose of the depth camera in the robot frame, \"{translation_m: [x, y, z], rotation_xyzw: "
      "[x, y, z, "
      "w]}\"; empty: unknown, no predicted surface is used");
    v("follow_calibration", follow_calibration,
      "Use the camera pose of /calibration where it is for the mesh of /robot/mesh");
    v("cameras", cameras,
      "Depth cameras beside the first, each \"NAME: {translation_m: [x, y, z], rotation_xyzw: [x, "
      "y, z, w]}\", its pose in the robot frame, or \"NAME\" where --calibration has it; its "
      "topics "
      "are /camera_NAME/...; camera_pose or --calibration is required then, and /calibration is "
      "followed where it has the poses of all cameras");
    v("camera_wait_s", camera_wait_s, {.min = 0.0, .max = 10.0},
      "Longest wait of a camera's frame for those of the other cameras; after three frames in vain "
      "a camera is not waited for until it sends again");
    v("pairing_wait_s", pairing_wait_s, {.min = 0.0, .max = 10.0},
      "Longest wait of a depth image for the rest of its frame set and for its camera's set-up");
    v("max_prediction_age_s", max_prediction_age_s, {.min = 0.0},
      "Largest age of the model state that predicts a frame");
    v("await_prediction_s", await_prediction_s, {.min = 0.0, .max = 600.0},
      "Longest wait of a frame for the model state of the previous frame, at any age; 0: use the "
      "newest state (live)");
    v("silence_s", silence_s, {.min = 0.0, .min_open = true},
      "Time without depth images after which the status is stale");
    v("late_s", late_s, {.min = 0.0},
      "Time from the camera's host to this process from which frames are late, and the status is "
      "stale; 0: none is");
    v("camera", camera, "Where images come from");
    v("dds", dds, "DDS side");
  }
};

}  // namespace palpate::perception

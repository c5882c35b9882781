// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::perception {

/// Where images come from, and what the messages of a camera driver do not say.
struct CameraConfig {
  std::string source = "capture";
  std::string reliability = "best_effort";
  std::string transport = "raw";
  bool use_color = true;
  double pairing_tolerance_s = 0.0;
  double depth_unit_m = 1e-3;
  double baseline_m = 0.0;
  std::string T_depth_color;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("source", source, {"capture", "driver"},
      "Publisher of the images: capture (palpate-capture, palpate-player), or driver: the driver "
      "of "
      "any camera in ROS 2, which has neither /camera/setup nor /camera/frame_info");
    v("reliability", reliability, {"best_effort", "reliable"},
      "driver: QoS that is asked for; best_effort takes the streams of every driver, reliable "
      "those "
      "of reliable publishers only, of which lost packets are sent again");
    v("transport", transport, {"raw", "compressed"},
      "driver: images as they are, or as image_transport packs them, on <image topic>/compressed "
      "(colour, JPEG or PNG) and <image topic>/compressedDepth (PNG)");
    v("use_color", use_color, "driver: use colour images; false: depth alone");
    v("pairing_tolerance_s", pairing_tolerance_s, {.min = 0.0, .max = 10.0},
      "driver: largest difference of the stamps of a depth image and its colour image; 0: three "
      "quarters of the period of the slower stream");
    v("depth_unit_m", depth_unit_m, {.min = 0.0, .min_open = true},
      "driver: z of one step of 16-bit depth images, 1 mm by the rules of ROS (REP 118)");
    v("baseline_m", baseline_m, {.min = 0.0},
      "driver: baseline of a stereo camera, for its noise; 0: unknown or no stereo camera");
    v("T_depth_color", T_depth_color,
      "driver: pose of the colour camera in the depth camera's frame, \"{translation_m: [x, y, z], "
      "rotation_xyzw: [x, y, z, w]}\"; empty: from /tf_static, or equal where the images have one "
      "frame");
  }
};

}  // namespace palpate::perception

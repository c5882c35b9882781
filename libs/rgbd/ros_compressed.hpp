// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "libs/rgbd/image.hpp"

namespace palpate::rgbd {

/// Depth as a message has it.
struct RosDepth {
  int width_px = 0;
  int height_px = 0;
  DepthImage steps;            ///< of 16-bit images; else empty
  std::vector<float> range_m;  ///< of 32-bit images, row by row; NaN: nothing seen
};

/// The data of a sensor_msgs/CompressedImage whose `format` is "16UC1; compressedDepth png",
/// "32FC1; compressedDepth", or "16UC1; png compressed". Empty: done; else why not.
[[nodiscard]] std::string DecodeCompressedDepth(std::string_view format, std::string_view data,
                                                RosDepth* depth);

/// The same of colour, JPEG or PNG.
[[nodiscard]] std::string DecodeCompressedColor(std::string_view data, ColorImage* color);

}  // namespace palpate::rgbd

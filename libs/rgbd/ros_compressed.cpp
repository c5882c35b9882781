// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/ros_compressed.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "libs/core/error.hpp"
#include "libs/rgbd/jpeg.hpp"
#include "libs/rgbd/png.hpp"

namespace palpate::rgbd {

namespace {

/// In front of the PNG of image_transport's compressedDepth: which format, and two parameters.
constexpr std::size_t kDepthHeader = 12;

/// compressed_depth_image_transport packs metres as a / (value - b), with 0 for nothing seen.
void UnpackMetres(std::string_view header, RosDepth* depth) {
  float a = 0.0f;
  float b = 0.0f;
  std::memcpy(&a, header.data() + 4, sizeof(a));
  std::memcpy(&b, header.data() + 8, sizeof(b));
  for (const std::uint16_t value : depth->steps.values) {
    const float z_m = a / (static_cast<float>(value) - b);
    const bool seen = value != 0 && std::isfinite(z_m) && z_m > 0.0f;
    depth->range_m.push_back(seen ? z_m : std::numeric_limits<float>::quiet_NaN());
  }
  depth->steps = {};
}

}  // namespace

std::string DecodeCompressedDepth(std::string_view format, std::string_view data, RosDepth* depth) {
  *depth = {};
  const bool with_header = format.find("compressedDepth") != std::string_view::npos;
  if (format.find("rvl") != std::string_view::npos) {
    return "is packed as RVL, which is not read; take PNG (parameter compressedDepth.format) or "
           "the raw image";
  }
  if (with_header && data.size() < kDepthHeader) return "is no whole image";
  const std::string_view png = with_header ? data.substr(kDepthHeader) : data;
  try {
    depth->steps = DecodeDepthPng(png, "PNG");
  } catch (const InputError& error) {
    return error.what();
  }
  depth->width_px = depth->steps.width_px;
  depth->height_px = depth->steps.height_px;
  if (format.substr(0, format.find(';')) == "32FC1") {
    if (!with_header) return "32FC1 cannot be packed as PNG without compressedDepth";
    UnpackMetres(data, depth);
  }
  return {};
}

std::string DecodeCompressedColor(std::string_view data, ColorImage* color) {
  try {
    const bool jpeg = data.starts_with("\xff\xd8");
    *color = jpeg ? DecodeJpeg(data, "JPEG") : DecodeColorPng(data, "PNG");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace palpate::rgbd

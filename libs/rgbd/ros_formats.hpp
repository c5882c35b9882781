// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "libs/rgbd/camera_model.hpp"

namespace palpate::rgbd {

/// Bytes of a pixel of a colour image, and which of them are red, green and blue.
struct ColorLayout {
  std::string_view encoding;
  std::uint32_t pixel_bytes;
  std::array<std::size_t, 3> rgb;
};

/// Of an encoding that sensor_msgs/image_encodings names; nullptr: it is no colour that is read.
const ColorLayout* ColorLayoutOf(std::string_view encoding);

/// Of a sensor_msgs/CameraInfo with distortion model `model` and numbers `d`. nullopt: another lens
/// than plumb_bob and rational_polynomial, or a number that is not finite.
std::optional<Distortion> DistortionOf(std::string_view model, std::span<const double> d);

}  // namespace palpate::rgbd

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libs/rgbd/image.hpp"

namespace palpate::rgbd {

/// Decodes a JPEG image; grey becomes RGB. Throws InputError, `name` in place of the file: no JPEG,
/// damaged, of four colours (CMYK), more than 64 Mpx.
ColorImage DecodeJpeg(std::string_view jpeg, const std::string& name);

/// 8-bit grey.
using GreyImage = Image<std::uint8_t, 1>;

/// `quality`: 1 to 100. Throws RunError for an image without pixels, or larger than 64 Mpx.
std::string EncodeJpeg(const ColorImage& image, int quality);
std::string EncodeJpeg(const GreyImage& image, int quality);

}  // namespace palpate::rgbd

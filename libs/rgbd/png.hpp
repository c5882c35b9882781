// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "libs/rgbd/image.hpp"

namespace palpate::rgbd {

/// 16-bit grey and 8-bit RGB PNG. The same image gives the same bytes (no time stamp inside).
/// Writing throws RunError where not all of it could be written (full disk; nothing half-written is
/// left behind); reading throws InputError naming the file: no PNG, truncated, of another kind
/// (8-bit depth, a pixel that is transparent, images of more than 64 Mpx, ...). An alpha channel
/// that is opaque throughout is dropped.
/// `level`: zlib's, 0 to 9; 1 is several times faster than 6 on noise.
void WriteDepthPng(const std::filesystem::path& file, const DepthImage& image, int level = 1);
void WriteColorPng(const std::filesystem::path& file, const ColorImage& image, int level = 1);
std::string EncodeColorPng(const ColorImage& image, int level);

DepthImage ReadDepthPng(const std::filesystem::path& file);
ColorImage ReadColorPng(const std::filesystem::path& file);  ///< grey and palette become RGB

/// The same of a PNG in memory; `name` takes the place of the file in messages.
DepthImage DecodeDepthPng(std::string_view png, const std::string& name);
ColorImage DecodeColorPng(std::string_view png, const std::string& name);

}  // namespace palpate::rgbd

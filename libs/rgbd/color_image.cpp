// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/rgbd/color_image.hpp"

#include "libs/core/file.hpp"
#include "libs/rgbd/jpeg.hpp"
#include "libs/rgbd/png.hpp"

namespace palpate::rgbd {

ColorImage ReadColorImage(const std::filesystem::path& file) {
  const std::string bytes = ReadFile(file);
  const bool jpeg = bytes.starts_with("\xff\xd8");
  return jpeg ? DecodeJpeg(bytes, file.string()) : DecodeColorPng(bytes, file.string());
}

}  // namespace palpate::rgbd

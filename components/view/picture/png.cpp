// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/png.hpp"

#include "libs/rgbd/png.hpp"

namespace palpate::view {

namespace {

constexpr int kLevel = 6;  // once for a scene, and people send it around

}  // namespace

void WritePng(const std::filesystem::path& path, const Image& image) {
  rgbd::ColorImage color(image.width_px, image.height_px);
  color.values = image.rgb;
  rgbd::WriteColorPng(path, color, kLevel);
}

}  // namespace palpate::view

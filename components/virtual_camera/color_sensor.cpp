// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/color_sensor.hpp"

#include <algorithm>

#include "libs/core/index.hpp"

namespace palpate::virtual_camera {

namespace {

using kernels::kRowPadding;

constexpr double kVignetting = 0.12;  // share of the light that the corners lose
constexpr float kReadNoise = 0.8F;    // grey levels
constexpr float kShotNoise = 1.6F;    // grey levels at white

}  // namespace

ColorSensor::ColorSensor(const rgbd::CameraModel& camera, std::uint64_t seed,
                         const kernels::Kernels& loops)
    : loops_{loops}, keys_{seed, "virtual_camera color noise"}, height_px_{camera.height_px} {
  exposure_.width_px = camera.width_px;
  exposure_.center_u_px = static_cast<float>(0.5 * (camera.width_px - 1));
  exposure_.center_v_px = static_cast<float>(0.5 * (camera.height_px - 1));
  const double corner_px2 = 0.25 * (camera.width_px * camera.width_px +  //
                                    camera.height_px * camera.height_px);
  exposure_.vignetting_px2 = static_cast<float>(kVignetting / corner_px2);
  exposure_.read_noise = kReadNoise;
  exposure_.shot_noise = kShotNoise;
  const auto padded = static_cast<std::size_t>(camera.width_px + 3 * kRowPadding);
  for (Planes& row : sharp_) row.fill(std::vector<float>(padded, 0.0F));
  blurred_.fill(std::vector<float>(padded, 0.0F));
}

kernels::ColorRow ColorSensor::RowOf(Planes* planes) {
  return {.red = (*planes)[0].data() + kRowPadding,
          .green = (*planes)[1].data() + kRowPadding,
          .blue = (*planes)[2].data() + kRowPadding};
}

void ColorSensor::Shade(SceneCamera* camera, int v) {
  Planes& row = sharp_[At(v % 3)];
  loops_.shade_row(camera->z_buffer().Row(v), camera->palette(), RowOf(&row));
}

void ColorSensor::Expose(SceneCamera* camera, rgbd::ColorImage* color) {
  if (color->width_px != exposure_.width_px || color->height_px != height_px_ || color->empty()) {
    *color = rgbd::ColorImage(exposure_.width_px, height_px_);
  }
  const std::uint64_t key = keys_.Bits();
  exposure_.key_low = static_cast<std::uint32_t>(key);
  exposure_.key_high = static_cast<std::uint32_t>(key >> 32);
  Shade(camera, 0);
  for (int v = 0; v < height_px_; ++v) {
    if (v + 1 < height_px_) Shade(camera, v + 1);
    const auto row_of = [this](int row) {
      return RowOf(&sharp_[At(std::clamp(row, 0, height_px_ - 1) % 3)]);
    };
    const kernels::ColorRow rows[3] = {row_of(v - 1), row_of(v), row_of(v + 1)};
    loops_.blur_row(rows, exposure_.width_px, RowOf(&blurred_));
    loops_.expose_row(RowOf(&blurred_), exposure_, v, color->Pixel(0, v));
  }
}

}  // namespace palpate::virtual_camera

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/virtual_camera/scene_camera.hpp"
#include "libs/rgbd/image.hpp"
#include "libs/scenario/random.hpp"

namespace palpate::virtual_camera {

/// Makes a colour image of what a camera sees: light, a little blur, vignetting, noise.
class ColorSensor {
 public:
  /// `loops` must outlive this.
  ColorSensor(const rgbd::CameraModel& camera, std::uint64_t seed, const kernels::Kernels& loops);

  /// The frame that follows the last one.
  void Expose(SceneCamera* camera, rgbd::ColorImage* color);

 private:
  using Planes = std::array<std::vector<float>, 3>;  // red, green, blue of one row, padded

  static kernels::ColorRow RowOf(Planes* planes);
  void Shade(SceneCamera* camera, int v);

  const kernels::Kernels& loops_;
  scenario::Random keys_;  // one for each frame
  kernels::Exposure exposure_ = {};
  int height_px_;
  std::array<Planes, 3> sharp_;  // rows v - 1, v, v + 1 in turn
  Planes blurred_;
};

}  // namespace palpate::virtual_camera

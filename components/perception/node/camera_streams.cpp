// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_streams.hpp"

namespace palpate::perception {

bool IsSameCamera(const rgbd::RgbdCamera& a, const rgbd::RgbdCamera& b) {
  return a.depth == b.depth && a.color == b.color && a.depth_unit_m == b.depth_unit_m &&
         a.invalid_value == b.invalid_value && a.baseline_m == b.baseline_m &&
         a.color_registered == b.color_registered &&
         a.T_depth_color.matrix() == b.T_depth_color.matrix();
}

}  // namespace palpate::perception

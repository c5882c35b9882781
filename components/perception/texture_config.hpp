// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/core/config_reader.hpp"

namespace palpate::perception {

/// Settings of the points of texture that are followed.
struct TextureConfig {
  int max_points = 0;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("max_points", max_points, {.min = 0.0, .max = 2000.0},
      "Largest number of points of the robot's texture that are followed in the colour image, such "
      "as 150; 0: none, tangential motion is not measured");
  }
};

}  // namespace palpate::perception

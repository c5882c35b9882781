// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

#include "libs/rgbd/image.hpp"

namespace palpate::rgbd {

/// Depth and colour taken at one instant.
struct RgbdFrame {
  std::int64_t stamp_ns = 0;
  DepthImage depth;
  ColorImage color;  ///< empty: none
};

}  // namespace palpate::rgbd

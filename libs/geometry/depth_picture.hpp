// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::geometry {

/// Size and lens of a depth image, distortion aside.
struct DepthPicture {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;

  bool operator==(const DepthPicture&) const = default;
};

}  // namespace palpate::geometry

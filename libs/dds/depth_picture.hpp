// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/geometry/depth_picture.hpp"
#include "palpate_msgs/msg/DepthPicture.hpp"

namespace palpate::dds {

inline void SetPicture(idl::palpate_msgs::DepthPicture& target,
                       const geometry::DepthPicture& source) {
  target.width_px = static_cast<std::uint32_t>(source.width_px);
  target.height_px = static_cast<std::uint32_t>(source.height_px);
  target.fx_px = source.fx_px;
  target.fy_px = source.fy_px;
  target.cx_px = source.cx_px;
  target.cy_px = source.cy_px;
}

inline geometry::DepthPicture ToPicture(const idl::palpate_msgs::DepthPicture& source) {
  return {.width_px = static_cast<int>(source.width_px),
          .height_px = static_cast<int>(source.height_px),
          .fx_px = source.fx_px,
          .fy_px = source.fy_px,
          .cx_px = source.cx_px,
          .cy_px = source.cy_px};
}

}  // namespace palpate::dds

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

/// What fills the z-buffer. Shapes are in the camera's frame; (x, y, 1) is a pixel's ray, so that
/// a hit at `t` times the ray has z = t.
namespace palpate::virtual_camera::kernels {

inline constexpr int kRowPadding = 16;

/// The z-buffer of a camera without distortion.
struct Canvas {
  int width_px;
  int height_px;
  int stride;              ///< >= width_px + kRowPadding
  float* inverse_z;        ///< [height][stride] 1/z of what is nearest, 1/m; 0: nothing
  std::uint32_t* surface;  ///< [height][stride] which surface that is; 0: none
};

/// A triangle in the plane of a canvas: in px, or, where the lens distorts, in the normalised
/// image.
struct FlatTriangle {
  double x[3];  ///< corners, ordered by y, then x
  double y[3];
  double inverse_z[3];  ///< 1/z = [0] x + [1] y + [2]
  std::uint32_t surface;
};

/// The z-buffer of a camera with distortion: pixels in the order of cells of the normalised image,
/// row after row of cells, each about a pixel large.
struct RayCanvas {
  double first_x;  ///< lower corner of cell (0, 0)
  double first_y;
  double cell;  ///< width and height
  int columns;
  int rows;
  const int* begin;  ///< [rows * columns + 1] first pixel of each cell, in the arrays below
  const double* x;   ///< [pixels + padding] the pixels' rays
  const double* y;
  float* inverse_z;
  std::uint32_t* surface;
};

/// Neighbouring pixels that a round shape may cover.
struct RaySegment {
  const double* x;
  const double* y;  ///< nullptr: all have `row_y`
  double row_y;
  int count;
  float* inverse_z;
  std::uint32_t* surface;
};

/// A cylinder of half length `half_length_m` along its own z axis, with flat ends or with half
/// spheres (half length 0: a sphere).
struct RoundSurface {
  bool round_ends;
  double radius_m;
  double half_length_m;
  double origin_m[3];  ///< the camera's centre in the shape's frame
  double axes[3][3];   ///< [k]: k-th coordinate in the shape's frame of the camera's x, y, z axes
  double nearest_m;    ///< hits nearer than that are not seen
};

}  // namespace palpate::virtual_camera::kernels

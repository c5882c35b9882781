// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

/// What turns true depth into measured depth, a row at a time.
namespace palpate::virtual_camera::kernels {

/// Filled by incidence_row; [count + padding] each. Where nothing is seen: 1 and 0.
struct Incidence {
  float* cosine;      ///< of the angle between ray and surface normal, (0, 1]
  float* reflection;  ///< share of infrared light that comes back, > 0; nullptr: not wanted
  const float* inverse_ray_length;  ///< 1/|(x, y, 1)| of each pixel
};

/// One row of true depth, what is known about it, and where the measured depth goes.
struct DepthRow {
  int width_px;
  int v;
  const float* inverse_z;  ///< 1/m, 0: nothing; [width + padding], as all rows here
  const float* above;      ///< the rows beside it, or the row itself at the border
  const float* below;
  const float* cosine;
  const float* reflection;
  const float* inverse_ray_length;
  const float* noise;  ///< normally distributed, variance 1
  const float* gain;   ///< factor on z
  float* scratch;      ///< [3][width + 2 padding], in any state
  std::uint16_t* depth;
};

/// What both kinds of camera do.
struct CommonLaw {
  float offset_m;          ///< added to z
  float incidence_bias_m;  ///< b of b (1/cos a - 1), along the ray, cos a >= 0.25
  float inverse_unit_1_m;  ///< depth steps per metre
  std::uint16_t invalid;
  float hole_ratio;    ///< of pixels along depth edges
  float flying_ratio;  ///< of pixels along depth edges
  std::uint32_t key_low;
  std::uint32_t key_high;
};

/// Disparity d = f b / z of two imagers, the left of which is the reference.
struct StereoLaw {
  CommonLaw common;
  float focal_baseline_px_m;
  float sigma_px;
  float periodic_bias_px;
  float step_px;
  float grazing_cosine;  ///< below it, holes grow to certainty at 0
};

/// Range along the ray: time of flight, or no noise at all.
struct DirectLaw {
  CommonLaw common;
  float sigma_m;          ///< at 1 m, perpendicular, reflection 1
  float least_amplitude;  ///< reflection cos a / range^2 below which nothing is measured
  float edge_share;       ///< depth jumps by more than this share of z are edges
};

}  // namespace palpate::virtual_camera::kernels

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>

/// What turns visible surfaces into colours, a row at a time.
namespace palpate::virtual_camera::kernels {

enum class Pattern : std::int32_t {
  kPlain,    ///< one colour
  kSurface,  ///< noise over the texture's x and y
  kSolid     ///< mottled: noise in the texture's space, two octaves
};

struct Paint {
  float rgb[3];  ///< [0, 1]
  Pattern pattern;
  float strength;     ///< how much the pattern changes the colour, share
  float frequency_m;  ///< spots per metre of texture space
};

/// A coloured disc on the surface.
struct Disc {
  float center_m[3];  ///< in texture space
  float radius_m;
  float rgb[3];
};

/// A flat surface. What is linear on it is, divided by z, linear in the ray (x, y, 1).
struct Facet {
  float texture[3][3];          ///< place in texture space / z
  float light[3];               ///< light that falls on it / z
  float inverse_normal_length;  ///< 1/|n| where 1/z = n . (x, y, 1)
  std::int32_t paint;
  std::int32_t first_disc;  ///< in Palette::disc_list
  std::int32_t disc_count;
};

/// What RoundSurface leaves out.
struct RoundLook {
  float radius_m;
  float half_length_m;
  bool round_ends;
  float origin_m[3];
  float axes[3][3];
  std::int32_t paint;
};

struct Lamps {
  float ambient;
  float direction[2][3];  ///< unit, camera frame, towards the lamp
  float intensity[2];
};

struct Palette {
  std::uint32_t facet_count;
  const Facet* facets;      ///< of surfaces 1 .. facet_count
  const RoundLook* rounds;  ///< of the surfaces after these
  const Paint* paints;
  const Disc* discs;
  const std::int32_t* disc_list;
  Lamps lamps;
  float pixel_angle;    ///< of a pixel, 1/f
  float background[3];  ///< where nothing is
};

/// A row of a z-buffer; all arrays [count + padding].
struct RowOfSurfaces {
  const float* x;  ///< the pixels' rays (x, y, 1)
  const float* y;
  const float* inverse_z;
  const std::uint32_t* surface;
  int count;
};

/// [count + padding] light that reaches each pixel; 1 is white.
struct ColorRow {
  float* red;
  float* green;
  float* blue;
};

/// How light becomes grey levels.
struct Exposure {
  int width_px;
  float center_u_px;
  float center_v_px;
  float vignetting_px2;  ///< share of the light that is lost per squared pixel from the centre
  float read_noise;      ///< grey levels
  float shot_noise;      ///< grey levels at white; falls about as the light's root
  std::uint32_t key_low;
  std::uint32_t key_high;
};

}  // namespace palpate::virtual_camera::kernels

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>

#include "components/virtual_camera/kernels/color_rows.hpp"
#include "components/virtual_camera/kernels/depth_rows.hpp"
#include "components/virtual_camera/kernels/fill.hpp"

/// The inner loops of the virtual camera. Plain memory in and out, so that the same source is
/// compiled for several instruction sets without a shared inline function leaking from one to the
/// other; the set is chosen at run time. Every set gives the same bits: only + - * / and square
/// roots, nothing contracted.
///
/// Rows of images are padded: every row has room for kRowPadding more pixels than it shows, which
/// the loops may read and write.
namespace palpate::virtual_camera::kernels {

struct Kernels {
  // fill.hpp
  void (*fill_triangles)(const FlatTriangle* triangles, int count, const Canvas& canvas);
  void (*fill_triangles_by_ray)(const FlatTriangle* triangles, int count, const RayCanvas& canvas);
  void (*fill_round)(const RoundSurface& shape, std::uint32_t surface, const RaySegment& rays);
  // color_rows.hpp
  void (*shade_row)(const RowOfSurfaces& row, const Palette& palette, const ColorRow& color);
  void (*blur_row)(const ColorRow rows[3], int count, const ColorRow& blurred);
  void (*expose_row)(const ColorRow& light, const Exposure& exposure, int v, std::uint8_t* rgb);
  // depth_rows.hpp
  void (*incidence_row)(const RowOfSurfaces& row, const Palette& palette, const Incidence& out);
  void (*range_row)(const float* inverse_z, int count, float* z_m);
  void (*white_noise_row)(std::uint32_t key_low, std::uint32_t key_high, std::uint32_t first,
                          int count, float* noise);
  void (*convolve)(const float* const* rows, const float* weights, int weight_count, int count,
                   float* out);
  void (*blend_row)(const float* fresh, float old_share, float fresh_share, int count,
                    float* state);
  void (*stereo_row)(const DepthRow& row, const StereoLaw& law);
  void (*direct_row)(const DepthRow& row, const DirectLaw& law);
};

/// Those of the best instruction set of this processor.
const Kernels& BestKernels();
/// Those of a set by its name ("portable", "avx2", "avx512"); nullptr: not on this processor.
const Kernels* KernelsOf(std::string_view instruction_set);

}  // namespace palpate::virtual_camera::kernels

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_camera/kernels/color_rows.inl"
#include "components/virtual_camera/kernels/depth_rows.inl"
#include "components/virtual_camera/kernels/fill.inl"
#include "components/virtual_camera/kernels/kernels.hpp"
#include "components/virtual_camera/kernels/noise_rows.inl"

namespace {

/// This source's functions.
constexpr palpate::virtual_camera::kernels::Kernels kTable = {
    .fill_triangles = FillTriangles,
    .fill_triangles_by_ray = FillTrianglesByRay,
    .fill_round = FillRound,
    .shade_row = ShadeRow,
    .blur_row = BlurRow,
    .expose_row = ExposeRow,
    .incidence_row = IncidenceRow,
    .range_row = RangeRow,
    .white_noise_row = WhiteNoiseRow,
    .convolve = Convolve,
    .blend_row = BlendRow,
    .stereo_row = StereoRow,
    .direct_row = DirectRow,
};

}  // namespace

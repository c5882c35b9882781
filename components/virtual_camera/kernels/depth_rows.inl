// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_camera/kernels/color_rows.inl"
#include "components/virtual_camera/kernels/depth_rows.hpp"
#include "components/virtual_camera/kernels/fill.hpp"
#include "components/virtual_camera/kernels/lanes.inl"

namespace {

using palpate::virtual_camera::kernels::CommonLaw;
using palpate::virtual_camera::kernels::DepthRow;
using palpate::virtual_camera::kernels::DirectLaw;
using palpate::virtual_camera::kernels::Incidence;
using palpate::virtual_camera::kernels::kRowPadding;
using palpate::virtual_camera::kernels::StereoLaw;

constexpr float kLeastCosine = 1e-3F;

PALPATE_LANES float ReflectionOf(const Paint& paint) {
  const float mean = (paint.rgb[0] + paint.rgb[1] + paint.rgb[2]) * (1.0F / 3.0F);
  return 0.15F + 0.85F * mean;
}

PALPATE_LANES void MeasureRun(const RowOfSurfaces& row, const Palette& palette, int first, int end,
                              const Incidence& out) {
  const std::uint32_t surface = row.surface[first];
  const bool flat = surface <= palette.facet_count;
  const Facet* facet = flat && surface > 0 ? palette.facets + surface - 1 : nullptr;
  const RoundLook* shape = flat ? nullptr : palette.rounds + surface - 1 - palette.facet_count;
  const float scale = facet != nullptr ? facet->inverse_normal_length : 0.0F;
  float reflection = 0.0F;
  if (facet != nullptr) reflection = ReflectionOf(palette.paints[facet->paint]);
  if (shape != nullptr) reflection = ReflectionOf(palette.paints[shape->paint]);
  for (int u = first; u < end; u += kWidth) {
    const Float shortness = Load(out.inverse_ray_length + u);
    const Float nearness = Load(row.inverse_z + u);
    Float cosine = Splat(1.0F);
    if (facet != nullptr) {
      cosine = nearness * scale * shortness;
    } else if (shape != nullptr) {
      const Float x = Load(row.x + u);
      const Float y = Load(row.y + u);
      Float n[3];
      RoundNormal(*shape, x, y, 1.0F / (nearness > 0.0F ? nearness : Splat(1.0F)), n);
      cosine = Abs(n[0] * x + n[1] * y + n[2]) * shortness;
    }
    Store(out.cosine + u, Clamp(cosine, kLeastCosine, 1.0F));
    if (out.reflection != nullptr) Store(out.reflection + u, Splat(reflection));
  }
}

void IncidenceRow(const RowOfSurfaces& row, const Palette& palette, const Incidence& out) {
  for (int first = 0; first < row.count;) {
    const int end = EndOfRun(row.surface, first, row.count);
    MeasureRun(row, palette, first, end, out);
    first = end;
  }
}

void RangeRow(const float* inverse_z, int count, float* z_m) {
  for (int u = 0; u < count; ++u) {
    z_m[u] = inverse_z[u] > 0.0F ? 1.0F / inverse_z[u] : __builtin_nanf("");
  }
}

/// The nearest whole number, |v| < 2^22: what is added leaves no room for a fraction.
PALPATE_LANES Float Round(Float v) { return (v + 12582912.0F) - 12582912.0F; }

/// sin(2 pi t) to 0.1 %.
PALPATE_LANES Float SineOfTurns(Float t) {
  const Float r = t - Round(t);
  const Float parabola = r * (8.0F - 16.0F * Abs(r));
  return parabola * (0.775F + 0.225F * Abs(parabola));
}

/// z as the camera would say it: with its systematic errors, before holes.
PALPATE_LANES Float WithBias(const DepthRow& row, const CommonLaw& law, int u, Float z) {
  Float biased = z * Load(row.gain + u) + law.offset_m;
  if (law.incidence_bias_m != 0.0F) {
    const Float slant = 1.0F / Max(Load(row.cosine + u), Splat(0.25F)) - 1.0F;
    biased += law.incidence_bias_m * slant * Load(row.inverse_ray_length + u);
  }
  return biased;
}

PALPATE_LANES void StoreDepth(const DepthRow& row, const CommonLaw& law, int u, Float z,
                              Int usable) {
  const Float steps = Clamp(z * law.inverse_unit_1_m + 0.5F, 0.0F, 65536.0F);
  const Int raw = ToInt(steps);
  const Int valid = usable & (raw > 0) & (raw < 65536);
  const Int out = valid ? raw : Splat(static_cast<std::int32_t>(law.invalid));
  typedef std::uint16_t Short __attribute__((vector_size(2 * kWidth)));
  Store(row.depth + u, __builtin_convertvector(out, Short));
}

/// [0, 1), for one decision about a pixel or a patch.
PALPATE_LANES float Chance(const CommonLaw& law, std::uint32_t place, std::uint32_t what) {
  const std::uint32_t word = RandomWord(place * 4U + what, law.key_low, law.key_high);
  return static_cast<float>(word >> 8) * (1.0F / 16777216.0F);
}
PALPATE_LANES std::uint32_t PlaceOf(const DepthRow& row, int u) {
  return static_cast<std::uint32_t>(row.v * row.width_px + u);
}

/// The patch that pixel u is in, about kPatch_px x kPatch_px pixels with ragged sides; they lie
/// again in each frame.
constexpr std::uint32_t kPatch_px = 6;
PALPATE_LANES std::uint32_t PatchOf(const DepthRow& row, const CommonLaw& law, int u) {
  const auto column = static_cast<std::uint32_t>(u);
  const auto line = static_cast<std::uint32_t>(row.v);
  const std::uint32_t ragged_down = Scramble(column ^ law.key_high) % 3U;
  const std::uint32_t ragged_across = Scramble(line ^ law.key_low) % 3U;
  const std::uint32_t down = (line + law.key_low % 64U + ragged_down) / kPatch_px;
  const std::uint32_t shift = (down * 0x9e3779b1U + law.key_high) >> 26;
  return down * 65536U + (column + shift + ragged_across) / kPatch_px;
}

/// The neighbour from which 1/z jumps most.
PALPATE_LANES float FarthestNeighbour(const DepthRow& row, int u) {
  const float mine = row.inverse_z[u];
  const float neighbours[4] = {u > 0 ? row.inverse_z[u - 1] : mine,
                               u + 1 < row.width_px ? row.inverse_z[u + 1] : mine, row.above[u],
                               row.below[u]};
  float farthest = mine;
  for (const float other : neighbours) {
    if (__builtin_fabsf(other - mine) > __builtin_fabsf(farthest - mine)) farthest = other;
  }
  return farthest;
}

/// Largest jump of 1/z to a neighbour.
PALPATE_LANES Float JumpAt(const DepthRow& row, int u) {
  const Float mine = Load(row.inverse_z + u);
  const Float left = Abs(Load(row.inverse_z + u - 1) - mine);
  const Float right = Abs(Load(row.inverse_z + u + 1) - mine);
  const Float up = Abs(Load(row.above + u) - mine);
  const Float down = Abs(Load(row.below + u) - mine);
  const Int has_left = (Lanes() + u) > 0;
  const Int has_right = (Lanes() + u) < row.width_px - 1;
  return Max(Max(has_left ? left : Float{}, has_right ? right : Float{}), Max(up, down));
}

/// Writes one pixel along a depth edge: a hole (whole patches of the edge fail together, as windows
/// that are matched do), a point flying between the surfaces, or neither.
PALPATE_LANES void SpoilEdge(const DepthRow& row, const CommonLaw& law, int u) {
  if (Chance(law, PatchOf(row, law, u), 0) < law.hole_ratio) {
    row.depth[u] = law.invalid;
    return;
  }
  const std::uint32_t place = PlaceOf(row, u);
  if (Chance(law, place, 1) * (1.0F - law.hole_ratio) >= law.flying_ratio) return;
  const float mine = row.inverse_z[u];
  const float share = 0.1F + 0.8F * Chance(law, place, 2);
  const float mixed = mine + share * (FarthestNeighbour(row, u) - mine);
  const float z = (mixed > 0.0F ? row.gain[u] / mixed : 0.0F) + law.offset_m;
  const float steps = z * law.inverse_unit_1_m + 0.5F;
  row.depth[u] = mixed > 0.0F && steps >= 1.0F && steps < 65536.0F
                     ? static_cast<std::uint16_t>(steps)
                     : law.invalid;
}

/// Where the other imager sees each pixel of a row.
struct OtherView {
  const float* shifted;  ///< [width + padding] u - disparity
  int width;
  float largest;  ///< disparity of the row
};

/// Whether the other imager sees something nearer where it should see pixel u: a pixel to the
/// right, or the surface between it and its right neighbour.
PALPATE_LANES bool IsCovered(const OtherView& view, int u) {
  const float mine = view.shifted[u];
  const float my_disparity = static_cast<float>(u) - mine;
  const int reach = u + 2 + static_cast<int>(view.largest - my_disparity);
  const int end = reach < view.width ? reach : view.width;
  for (int first = u + 1; first < end; first += kWidth) {
    const Float there = Load(view.shifted + first);
    const Float gap = Load(view.shifted + first + 1) - there;
    const Float disparity = ToFloat(Lanes() + first) - there;
    const Int same_surface = (gap > 0.5F) & (gap < 3.0F);
    const Float beyond = there + (same_surface ? gap : Splat(0.5F));
    if (Any((disparity > my_disparity + 1.0F) & (mine >= there - 0.5F) & (mine <= beyond) &
            ((Lanes() + first) < end))) {
      return true;
    }
  }
  return false;
}

/// Holes where the other imager does not see the surface. From the right: as long as the pixels
/// keep their order in the other image, nothing covers anything.
PALPATE_LANES void CastShadow(const DepthRow& row, const CommonLaw& law, const OtherView& view) {
  const float* shifted = view.shifted;
  float least = 1e30F;
  for (int first = (view.width - 1) / kWidth * kWidth; first >= 0; first -= kWidth) {
    const int end = first + kWidth < view.width ? first + kWidth : view.width;
    const Float mine = Load(shifted + first);
    const bool in_order =
        !Any((mine >= Load(shifted + first + 1)) & ((Lanes() + first) < view.width - 1));
    if (in_order && shifted[first] >= -0.5F && shifted[end - 1] < least) {
      least = shifted[first];
      continue;
    }
    for (int u = end - 1; u >= first; --u) {
      const float here = shifted[u];
      if (here < least) {
        least = here;
        if (here < -0.5F) row.depth[u] = law.invalid;
      } else if (here < -0.5F || IsCovered(view, u)) {
        row.depth[u] = law.invalid;
      }
    }
  }
}

void StereoRow(const DepthRow& row, const StereoLaw& law) {
  const CommonLaw& common = law.common;
  float* shifted = row.scratch + kRowPadding;
  const float steps_per_px = 1.0F / law.step_px;
  const float edge = 1.0F / law.focal_baseline_px_m;
  Float largest = {};
  for (int u = 0; u < row.width_px; u += kWidth) {
    const Float exact = Load(row.inverse_z + u) * law.focal_baseline_px_m;
    Store(shifted + u, ToFloat(Lanes() + u) - exact);
    largest = Max(largest, exact);
    const Float noisy = exact + law.sigma_px * Load(row.noise + u);
    const Float biased = noisy + law.periodic_bias_px * SineOfTurns(noisy);
    const Float steps = Round(biased * steps_per_px);
    const Int usable = (exact > 0.0F) & (steps > 0.5F);
    const Float z = law.focal_baseline_px_m / (usable ? steps * law.step_px : Splat(1.0F));
    StoreDepth(row, common, u, WithBias(row, common, u, z), usable);
  }
  for (int first = 0; first < row.width_px; first += kWidth) {
    const Int inside = (Lanes() + first) < row.width_px;
    const Int edges = (JumpAt(row, first) > edge) & inside;
    const Int grazing = (Load(row.cosine + first) < law.grazing_cosine) & inside;
    if (!Any(edges | grazing)) continue;
    for (int lane = 0; lane < kWidth; ++lane) {
      const int u = first + lane;
      if (edges[lane] != 0) SpoilEdge(row, common, u);
      if (grazing[lane] != 0 &&
          Chance(common, PatchOf(row, common, u), 3) > row.cosine[u] / law.grazing_cosine) {
        row.depth[u] = common.invalid;
      }
    }
  }
  float largest_of_all = 0.0F;
  for (int lane = 0; lane < kWidth; ++lane) {
    if (largest[lane] > largest_of_all) largest_of_all = largest[lane];
  }
  CastShadow(row, common, {shifted, row.width_px, largest_of_all});
}

void DirectRow(const DepthRow& row, const DirectLaw& law) {
  const CommonLaw& common = law.common;
  for (int first = 0; first < row.width_px; first += kWidth) {
    const Float nearness = Load(row.inverse_z + first);
    Int usable = nearness > 0.0F;
    Float z = 1.0F / (usable ? nearness : Splat(1.0F));
    if (law.sigma_m > 0.0F) {
      const Float range = z / Load(row.inverse_ray_length + first);
      const Float returned = Load(row.reflection + first) * Load(row.cosine + first);
      const Float amplitude = returned / (range * range);
      usable &= amplitude > law.least_amplitude;
      const Float sigma = law.sigma_m / Max(amplitude, Splat(1e-6F));
      z += sigma * Load(row.noise + first) * Load(row.inverse_ray_length + first);
    }
    StoreDepth(row, common, first, WithBias(row, common, first, z), usable);
    const Int edges =
        (JumpAt(row, first) > law.edge_share * nearness) & ((Lanes() + first) < row.width_px);
    if (!Any(edges)) continue;
    for (int lane = 0; lane < kWidth; ++lane) {
      if (edges[lane] != 0) SpoilEdge(row, common, first + lane);
    }
  }
}

}  // namespace

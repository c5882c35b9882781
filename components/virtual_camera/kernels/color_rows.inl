// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_camera/kernels/color_rows.hpp"
#include "components/virtual_camera/kernels/lanes.inl"

namespace {

using palpate::virtual_camera::kernels::ColorRow;
using palpate::virtual_camera::kernels::Disc;
using palpate::virtual_camera::kernels::Exposure;
using palpate::virtual_camera::kernels::Facet;
using palpate::virtual_camera::kernels::Paint;
using palpate::virtual_camera::kernels::Palette;
using palpate::virtual_camera::kernels::Pattern;
using palpate::virtual_camera::kernels::RoundLook;
using palpate::virtual_camera::kernels::RowOfSurfaces;

/// [-1, 1), another one at each point of the lattice.
PALPATE_LANES Float AtLattice(Word w) {
  w ^= w >> 15;
  w *= 0x2c1b3c6dU;
  w ^= w << 13;
  return ToFloat(reinterpret_cast<Int>(w)) * (1.0F / 2147483648.0F);
}

PALPATE_LANES Float Between(Float a, Float b, Float share) { return a + (b - a) * share; }
PALPATE_LANES Float Smooth(Float t) { return t * t * (3.0F - 2.0F * t); }

constexpr std::uint32_t kAcross = 0x1b873593;
constexpr std::uint32_t kDown = 0x4c957f2d;
PALPATE_LANES Word HashOf(Int i, Int j) {
  return reinterpret_cast<Word>(i) * kAcross + reinterpret_cast<Word>(j) * kDown;
}

/// Between the four points of the lattice of which `hash` is the first's.
PALPATE_LANES Float AroundPlace(Word hash, Float across, Float down) {
  const Word below = hash + kDown;
  return Between(Between(AtLattice(hash), AtLattice(hash + kAcross), across),
                 Between(AtLattice(below), AtLattice(below + kAcross), across), down);
}

/// Random values at the corners of a square lattice, smoothly between them.
PALPATE_LANES Float SurfaceNoise(Float x, Float y) {
  const Int i = Floor(x);
  const Int j = Floor(y);
  const Float s = Smooth(x - ToFloat(i));
  const Float t = Smooth(y - ToFloat(j));
  return AroundPlace(HashOf(i, j), s, t);
}

/// The same in space.
PALPATE_LANES Float SolidNoise(Float x, Float y, Float z) {
  const Int k = Floor(z);
  const Int i = Floor(x);
  const Int j = Floor(y);
  const Float s = Smooth(x - ToFloat(i));
  const Float t = Smooth(y - ToFloat(j));
  const Float r = Smooth(z - ToFloat(k));
  Float level[2];
  for (std::uint32_t up = 0; up < 2; ++up) {
    level[up] = AroundPlace(HashOf(i, j) + (reinterpret_cast<Word>(k) + up) * 0x2545f491U, s, t);
  }
  return Between(level[0], level[1], r);
}

PALPATE_LANES Float PatternAt(const Paint& paint, Float x, Float y, Float z) {
  const float f = paint.frequency_m;
  if (paint.pattern == Pattern::kSurface) {
    return 1.0F + paint.strength * SurfaceNoise(x * f, y * f);
  }
  if (paint.pattern == Pattern::kSolid) {
    const Float coarse = SolidNoise(x * f, y * f, z * f);
    const Float fine = SolidNoise(x * (2.7F * f), y * (2.7F * f), z * (2.7F * f));
    return 1.0F + paint.strength * (0.6F * coarse + 0.4F * fine);
  }
  return Splat(1.0F);
}

struct Rgb {
  Float red;
  Float green;
  Float blue;
};
PALPATE_LANES Rgb Painted(const Paint& paint, Float light) {
  return {paint.rgb[0] * light, paint.rgb[1] * light, paint.rgb[2] * light};
}
PALPATE_LANES void StoreRgb(const Rgb& rgb, const ColorRow& color, int u) {
  Store(color.red + u, rgb.red);
  Store(color.green + u, rgb.green);
  Store(color.blue + u, rgb.blue);
}

/// Discs cover the paint; their rims are one pixel soft.
PALPATE_LANES void LayDisc(const Disc& disc, const Float place[3], Float light, Float pixel_m,
                           Int mine, Rgb* rgb) {
  const Float dx = place[0] - disc.center_m[0];
  const Float dy = place[1] - disc.center_m[1];
  const Float dz = place[2] - disc.center_m[2];
  const Float distance = Sqrt(dx * dx + dy * dy + dz * dz);
  const Float inside = Clamp((disc.radius_m - distance) / pixel_m + 0.5F, 0.0F, 1.0F);
  const Float cover = mine ? inside : Float{};
  rgb->red = Between(rgb->red, disc.rgb[0] * light, cover);
  rgb->green = Between(rgb->green, disc.rgb[1] * light, cover);
  rgb->blue = Between(rgb->blue, disc.rgb[2] * light, cover);
}

PALPATE_LANES Float Dot(const float a[3], Float x, Float y) { return a[0] * x + a[1] * y + a[2]; }

/// Pixels that are shaded at a time, and what is known of them.
constexpr int kBatch = 256;
struct Batch {
  float place[3][kBatch + kWidth];
  float light[kBatch + kWidth];
};

/// Where on the facet the pixels [first, end) lie, and how it is lit there; into `batch`, from
/// `begin` on.
PALPATE_LANES void Locate(const Facet& facet, const RowOfSurfaces& row, int first, int end,
                          int begin, Batch* batch) {
  for (int u = first; u < end; u += kWidth) {
    const Float x = Load(row.x + u);
    const Float y = Load(row.y + u);
    const Float nearness = Load(row.inverse_z + u);
    const Float z = 1.0F / (nearness > 0.0F ? nearness : Splat(1.0F));
    for (int k = 0; k < 3; ++k) {
      Store(batch->place[k] + (u - begin), z * Dot(facet.texture[k], x, y));
    }
    Store(batch->light + (u - begin), z * Dot(facet.light, x, y));
  }
}

PALPATE_LANES void LayDiscs(const Facet& facet, const RowOfSurfaces& row, const Palette& palette,
                            int u, int end, const Batch& batch, int begin, const ColorRow& color) {
  for (; u < end; u += kWidth) {
    const int i = u - begin;
    const Float place[3] = {Load(batch.place[0] + i), Load(batch.place[1] + i),
                            Load(batch.place[2] + i)};
    const Float nearness = Load(row.inverse_z + u);
    const Float pixel_m = palette.pixel_angle / (nearness > 0.0F ? nearness : Splat(1.0F));
    const Int mine = (Lanes() + u) < end;
    Rgb rgb = {Load(color.red + u), Load(color.green + u), Load(color.blue + u)};
    for (int k = 0; k < facet.disc_count; ++k) {
      const Disc& disc = palette.discs[palette.disc_list[facet.first_disc + k]];
      LayDisc(disc, place, Load(batch.light + i), pixel_m, mine, &rgb);
    }
    StoreRgb(rgb, color, u);
  }
}

/// Outward normal of a round shape at z times the ray, in the camera's frame.
PALPATE_LANES void RoundNormal(const RoundLook& s, Float x, Float y, Float z, Float normal[3]) {
  Float p[3];
  for (int k = 0; k < 3; ++k) {
    p[k] = s.origin_m[k] + z * (s.axes[k][0] * x + s.axes[k][1] * y + s.axes[k][2]);
  }
  const float high = s.half_length_m;
  Float along;
  if (s.round_ends) {
    along = p[2] - Clamp(p[2], -high, high);
  } else {
    // The end is where the point lies on it to within rounding; elsewhere the mantle.
    const Int on_end = Abs(p[2]) >= Splat(high * 0.99999F);
    along = on_end ? p[2] * 1e6F : Float{};
  }
  const Float length = Sqrt(p[0] * p[0] + p[1] * p[1] + along * along);
  const Float scale = 1.0F / (length > 0.0F ? length : Splat(1.0F));
  for (int k = 0; k < 3; ++k) {
    normal[k] = (s.axes[0][k] * p[0] + s.axes[1][k] * p[1] + s.axes[2][k] * along) * scale;
  }
}

PALPATE_LANES void ShadeRound(const RoundLook& shape, const RowOfSurfaces& row,
                              const Palette& palette, int first, int end, const ColorRow& color) {
  const Paint& paint = palette.paints[shape.paint];
  for (int u = first; u < end; u += kWidth) {
    const Float nearness = Load(row.inverse_z + u);
    const Float z = 1.0F / (nearness > 0.0F ? nearness : Splat(1.0F));
    Float normal[3];
    RoundNormal(shape, Load(row.x + u), Load(row.y + u), z, normal);
    Float light = Splat(palette.lamps.ambient);
    for (int lamp = 0; lamp < 2; ++lamp) {
      const float* to_lamp = palette.lamps.direction[lamp];
      const Float cosine = to_lamp[0] * normal[0] + to_lamp[1] * normal[1] + to_lamp[2] * normal[2];
      light += palette.lamps.intensity[lamp] * Max(cosine, Float{});
    }
    StoreRgb(Painted(paint, light), color, u);
  }
}

/// Where the run of one surface that begins at `first` ends, at most `count`.
PALPATE_LANES int EndOfRun(const std::uint32_t* surface, int first, int count) {
  const std::uint32_t mine = surface[first];
  int end = first + 1;
  while (end < count && surface[end] == mine) {
    ++end;
    while (end + kWidth <= count &&
           !Any(reinterpret_cast<Int>(Load(surface + end) != Splat(mine)))) {
      end += kWidth;
    }
  }
  return end;
}

/// Shades facets of one paint that lie side by side, from `begin` on; returns where they end.
/// Facets are often narrower than the lanes, so that their pattern is made for all at once.
PALPATE_LANES int ShadeFacets(const RowOfSurfaces& row, const Palette& palette, int begin,
                              const ColorRow& color) {
  const int limit = begin + kBatch < row.count ? begin + kBatch : row.count;
  const std::int32_t paint_number = palette.facets[row.surface[begin] - 1].paint;
  const Paint& paint = palette.paints[paint_number];
  Batch batch;
  bool has_discs = false;
  int end = begin;
  while (end < limit) {
    const std::uint32_t surface = row.surface[end];
    if (surface == 0 || surface > palette.facet_count) break;
    const Facet& facet = palette.facets[surface - 1];
    if (facet.paint != paint_number) break;
    const int first = end;
    end = EndOfRun(row.surface, first, limit);
    Locate(facet, row, first, end, begin, &batch);
    has_discs = has_discs || facet.disc_count > 0;
  }
  for (int u = begin; u < end; u += kWidth) {
    const int i = u - begin;
    const Float pattern = PatternAt(paint, Load(batch.place[0] + i), Load(batch.place[1] + i),
                                    Load(batch.place[2] + i));
    StoreRgb(Painted(paint, Load(batch.light + i) * pattern), color, u);
  }
  for (int first = begin; has_discs && first < end;) {
    const int next = EndOfRun(row.surface, first, end);
    const Facet& facet = palette.facets[row.surface[first] - 1];
    if (facet.disc_count > 0) LayDiscs(facet, row, palette, first, next, batch, begin, color);
    first = next;
  }
  return end;
}

void ShadeRow(const RowOfSurfaces& row, const Palette& palette, const ColorRow& color) {
  for (int first = 0; first < row.count;) {
    const std::uint32_t surface = row.surface[first];
    if (surface > 0 && surface <= palette.facet_count) {
      first = ShadeFacets(row, palette, first, color);
      continue;
    }
    const int end = EndOfRun(row.surface, first, row.count);
    if (surface == 0) {
      const Rgb nothing = {Splat(palette.background[0]), Splat(palette.background[1]),
                           Splat(palette.background[2])};
      for (int u = first; u < end; u += kWidth) StoreRgb(nothing, color, u);
    } else {
      const RoundLook& shape = palette.rounds[surface - 1 - palette.facet_count];
      ShadeRound(shape, row, palette, first, end, color);
    }
    first = end;
  }
}

/// 1 2 1 across and down: what lens and colour mosaic take from the sharpness. Rows begin with one
/// pixel of padding before them, which is set here.
PALPATE_LANES void BlurChannel(float* const rows[3], int count, float* out) {
  for (int r = 0; r < 3; ++r) {
    rows[r][-1] = rows[r][0];
    rows[r][count] = rows[r][count - 1];
  }
  for (int u = 0; u < count; u += kWidth) {
    Float across[3];
    for (int k = 0; k < 3; ++k) {
      across[k] =
          Load(rows[0] + u + k - 1) + 2.0F * Load(rows[1] + u + k - 1) + Load(rows[2] + u + k - 1);
    }
    Store(out + u, (across[0] + 2.0F * across[1] + across[2]) * (1.0F / 16.0F));
  }
}

void BlurRow(const ColorRow rows[3], int count, const ColorRow& blurred) {
  float* red[3] = {rows[0].red, rows[1].red, rows[2].red};
  float* green[3] = {rows[0].green, rows[1].green, rows[2].green};
  float* blue[3] = {rows[0].blue, rows[1].blue, rows[2].blue};
  BlurChannel(red, count, blurred.red);
  BlurChannel(green, count, blurred.green);
  BlurChannel(blue, count, blurred.blue);
}

/// Nearly normal, mean 0, variance 1: the sum of the four bytes of a random word.
PALPATE_LANES Float NearlyNormal(Word random) {
  const Word pairs = (random & 0x00ff00ffU) + ((random >> 8) & 0x00ff00ffU);
  const Int sum = reinterpret_cast<Int>((pairs & 0xffffU) + (pairs >> 16));
  return (ToFloat(sum) - 510.0F) * 0.00676573F;  // 1/sqrt(4 (256^2 - 1) / 12)
}

PALPATE_LANES Int GreyLevel(Float light, Float noise, const Exposure& exposure) {
  const Float lit = Clamp(light, 0.0F, 1.5F);
  const Float sigma = exposure.read_noise + exposure.shot_noise * lit * (1.8F - 0.8F * lit);
  return ToInt(Clamp(255.0F * lit + sigma * noise + 0.5F, 0.0F, 255.0F));
}

void ExposeRow(const ColorRow& light, const Exposure& exposure, int v, std::uint8_t* rgb) {
  std::uint32_t packed[kWidth];
  const float dv = static_cast<float>(v) - exposure.center_v_px;
  for (int first = 0; first < exposure.width_px; first += kWidth) {
    const Int u = Lanes() + first;
    const Float du = ToFloat(u) - exposure.center_u_px;
    const Float seen = 1.0F - exposure.vignetting_px2 * (du * du + dv * dv);
    const Word counter = reinterpret_cast<Word>(u + v * exposure.width_px);
    const Word random = Scramble(Word(counter ^ exposure.key_low)) + exposure.key_high;
    const Word other = random * 0x9e3779b1U;
    const Word third = (random ^ (other >> 13)) * 0x85ebca77U;
    const Int red = GreyLevel(Load(light.red + first) * seen, NearlyNormal(random), exposure);
    const Int green =
        GreyLevel(Load(light.green + first) * seen, NearlyNormal(other ^ (other >> 15)), exposure);
    const Int blue =
        GreyLevel(Load(light.blue + first) * seen, NearlyNormal(third ^ (third >> 15)), exposure);
    Store(packed, reinterpret_cast<Word>(red | (green << 8) | (blue << 16)));
    const int left = exposure.width_px - first;
    const int count = left < kWidth ? left : kWidth;
    for (int lane = 0; lane < count; ++lane) {
      // Four bytes at once; the next pixel writes over the fourth. The last has no room for it.
      const bool last = lane == left - 1;
      __builtin_memcpy(rgb + 3L * (first + lane), packed + lane, last ? 3 : 4);
    }
  }
}

}  // namespace

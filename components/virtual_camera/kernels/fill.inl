// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_camera/kernels/fill.hpp"
#include "components/virtual_camera/kernels/lanes.inl"

namespace {

using palpate::virtual_camera::kernels::Canvas;
using palpate::virtual_camera::kernels::FlatTriangle;
using palpate::virtual_camera::kernels::RayCanvas;
using palpate::virtual_camera::kernels::RaySegment;
using palpate::virtual_camera::kernels::RoundSurface;

/// The least whole number >= x, in [0, last].
PALPATE_LANES int CeilWithin(double x, int last) {
  if (!(x > 0.0)) return 0;
  if (x >= last) return last;
  const int truncated = static_cast<int>(x);
  return truncated + (truncated < x ? 1 : 0);
}

/// Draws pixels [i, end), at most as many as Pack has lanes.
template <typename Pack, typename Mask, typename Words>
PALPATE_LANES void FillSome(float* nearest, std::uint32_t* surfaces, float value, float slope,
                            int i, int end, std::uint32_t surface) {
  const Mask lanes = LanesOf<Mask>() + i;
  const Pack mine = value + slope * __builtin_convertvector(lanes, Pack);
  const Pack old = LoadAs<Pack>(nearest + i);
  const Mask wins = (mine > old) & (lanes < end);
  Store(nearest + i, wins ? mine : old);
  Store(surfaces + i, wins ? Words{} + surface : LoadAs<Words>(surfaces + i));
}

/// Along one row from `first` to before `end`; `value` is 1/z at `first`.
PALPATE_LANES void FillSpan(const Canvas& canvas, int v, int first, int end, float value,
                            float slope, std::uint32_t surface) {
  const long offset = static_cast<long>(v) * canvas.stride + first;
  float* nearest = canvas.inverse_z + offset;
  std::uint32_t* surfaces = canvas.surface + offset;
  const int count = end - first;
  if (count <= kHalf) {
    FillSome<HalfFloat, HalfInt, HalfWord>(nearest, surfaces, value, slope, 0, count, surface);
    return;
  }
  for (int i = 0; i < count; i += kWidth) {
    FillSome<Float, Int, Word>(nearest, surfaces, value, slope, i, count, surface);
  }
}

/// An edge from its upper to its lower corner. Two triangles that share it compute the same x, so
/// that each pixel belongs to one of them: no gap, none drawn twice.
struct Edge {
  double x;
  double y;
  double slope;
};
PALPATE_LANES Edge MakeEdge(const FlatTriangle& t, int from, int to) {
  const double height = t.y[to] - t.y[from];
  return {t.x[from], t.y[from], height > 0.0 ? (t.x[to] - t.x[from]) / height : 0.0};
}
PALPATE_LANES double At(const Edge& edge, int v) { return edge.x + (v - edge.y) * edge.slope; }

PALPATE_LANES void FillRows(const FlatTriangle& t, const Edge& left, const Edge& right,
                            const int rows[2], const Canvas& canvas) {
  const auto slope = static_cast<float>(t.inverse_z[0]);
  for (int v = rows[0]; v < rows[1]; ++v) {
    const int first = CeilWithin(At(left, v), canvas.width_px);
    const int end = CeilWithin(At(right, v), canvas.width_px);
    if (first >= end) continue;
    const double value = t.inverse_z[2] + t.inverse_z[1] * v + t.inverse_z[0] * first;
    FillSpan(canvas, v, first, end, static_cast<float>(value), slope, t.surface);
  }
}

/// Pixels whose centres lie in the triangle: left and upper edges included, others not.
void FillTriangles(const FlatTriangle* triangles, int count, const Canvas& canvas) {
  for (int i = 0; i < count; ++i) {
    const FlatTriangle& t = triangles[i];
    const Edge whole = MakeEdge(t, 0, 2);
    const Edge upper = MakeEdge(t, 0, 1);
    const Edge lower = MakeEdge(t, 1, 2);
    const int upper_rows[2] = {CeilWithin(t.y[0], canvas.height_px),
                               CeilWithin(t.y[1], canvas.height_px)};
    const int lower_rows[2] = {upper_rows[1], CeilWithin(t.y[2], canvas.height_px)};
    const double side = (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) -  //
                        (t.y[1] - t.y[0]) * (t.x[2] - t.x[0]);
    if (side > 0.0) {
      FillRows(t, whole, upper, upper_rows, canvas);
      FillRows(t, whole, lower, lower_rows, canvas);
    } else {
      FillRows(t, upper, whole, upper_rows, canvas);
      FillRows(t, lower, whole, lower_rows, canvas);
    }
  }
}

PALPATE_LANES double Least(double a, double b) { return a < b ? a : b; }
PALPATE_LANES double Largest(double a, double b) { return a > b ? a : b; }

/// Widens [low, high] by the part of the edge that lies in the strip y0 <= y <= y1. Of a level edge
/// it takes one end: the other belongs to another edge.
PALPATE_LANES void WidenInStrip(const FlatTriangle& t, int from, int to, double y0, double y1,
                                double* low, double* high) {
  const double a = Largest(t.y[from], y0);
  const double b = Least(t.y[to], y1);
  if (a > b) return;
  const Edge edge = MakeEdge(t, from, to);
  const double xa = edge.x + (a - edge.y) * edge.slope;
  const double xb = edge.x + (b - edge.y) * edge.slope;
  *low = Least(*low, Least(xa, xb));
  *high = Largest(*high, Largest(xa, xb));
}

/// Twice the area that edge and point span. The corners of a FlatTriangle are ordered, so that two
/// triangles that share the edge compute the same number: a pixel on which it is zero or more lies
/// on one side for both.
PALPATE_LANES double SideOf(const FlatTriangle& t, int from, int to, double x, double y) {
  return (t.x[to] - t.x[from]) * (y - t.y[from]) - (t.y[to] - t.y[from]) * (x - t.x[from]);
}
PALPATE_LANES DoubleMask IsBeyond(const FlatTriangle& t, int from, int to, Double x, Double y) {
  return (t.x[to] - t.x[from]) * (y - t.y[from]) - (t.y[to] - t.y[from]) * (x - t.x[from]) >= 0.0;
}

PALPATE_LANES void FillRays(const FlatTriangle& t, bool clockwise, int first, int end,
                            const RayCanvas& canvas) {
  const DoubleMask middle_beyond = DoubleMask{} - (clockwise ? 1 : 0);
  for (int i = first; i < end; i += kHalf) {
    const Double x = Load(canvas.x + i);
    const Double y = Load(canvas.y + i);
    const DoubleMask whole = IsBeyond(t, 0, 2, x, y) ^ ~middle_beyond;
    const DoubleMask upper = IsBeyond(t, 0, 1, x, y) ^ middle_beyond;
    const DoubleMask lower = IsBeyond(t, 1, 2, x, y) ^ middle_beyond;
    const HalfInt inside = __builtin_convertvector(whole & upper & lower, HalfInt);
    const Double value = t.inverse_z[0] * x + t.inverse_z[1] * y + t.inverse_z[2];
    const HalfFloat mine = __builtin_convertvector(value, HalfFloat);
    const HalfFloat old = LoadAs<HalfFloat>(canvas.inverse_z + i);
    const HalfInt wins = inside & (mine > old) & (LanesOf<HalfInt>() + i < end);
    Store(canvas.inverse_z + i, wins ? mine : old);
    const HalfWord surfaces = LoadAs<HalfWord>(canvas.surface + i);
    Store(canvas.surface + i, wins ? HalfWord{} + t.surface : surfaces);
  }
}

void FillTrianglesByRay(const FlatTriangle* triangles, int count, const RayCanvas& canvas) {
  const double per_cell = 1.0 / canvas.cell;
  for (int i = 0; i < count; ++i) {
    const FlatTriangle& t = triangles[i];
    const bool clockwise = SideOf(t, 0, 2, t.x[1], t.y[1]) >= 0.0;
    const int first_row = CeilWithin((t.y[0] - canvas.first_y) * per_cell - 1.0, canvas.rows);
    const int end_row = CeilWithin((t.y[2] - canvas.first_y) * per_cell + 1.0, canvas.rows);
    for (int row = first_row; row < end_row; ++row) {
      const double y0 = canvas.first_y + (row - 0.001) * canvas.cell;
      const double y1 = canvas.first_y + (row + 1.001) * canvas.cell;
      double low = 1e300;
      double high = -1e300;
      WidenInStrip(t, 0, 2, y0, y1, &low, &high);
      WidenInStrip(t, 0, 1, y0, y1, &low, &high);
      WidenInStrip(t, 1, 2, y0, y1, &low, &high);
      if (low > high) continue;
      const int column = CeilWithin((low - canvas.first_x) * per_cell - 1.001, canvas.columns);
      const int end = CeilWithin((high - canvas.first_x) * per_cell + 0.001, canvas.columns);
      const int* begin = canvas.begin + static_cast<long>(row) * canvas.columns;
      if (column < end) FillRays(t, clockwise, begin[column], begin[end], canvas);
    }
  }
}

/// A ray o + t d in the frame of a round shape, and the infinite cylinder around the shape.
struct RoundRay {
  Double o[3];
  Double d[3];
  Double a;  ///< a t^2 + 2 b t + c = 0 where the ray meets the infinite cylinder
  Double b;
  Double root;  ///< b^2 - a c; the ray misses the shape unless it is > 0
};
PALPATE_LANES RoundRay MakeRay(const RoundSurface& s, Double x, Double y) {
  RoundRay ray;
  for (int k = 0; k < 3; ++k) {
    ray.o[k] = Splat(s.origin_m[k]);
    ray.d[k] = s.axes[k][0] * x + s.axes[k][1] * y + s.axes[k][2];
  }
  ray.a = ray.d[0] * ray.d[0] + ray.d[1] * ray.d[1];
  ray.a = ray.a > 1e-18 ? ray.a : Splat(1e-18);  // along the axis it still enters, at an end
  ray.b = ray.o[0] * ray.d[0] + ray.o[1] * ray.d[1];
  const Double c = ray.o[0] * ray.o[0] + ray.o[1] * ray.o[1] - s.radius_m * s.radius_m;
  ray.root = ray.b * ray.b - ray.a * c;
  return ray;
}

constexpr double kNever = 1e300;

/// Where the ray enters the half sphere, the end disc, around `center` on the axis; kNever:
/// nowhere.
PALPATE_LANES Double EnterSphere(const RoundSurface& s, const RoundRay& ray, Double center) {
  const Double oz = ray.o[2] - center;
  const Double a = ray.a + ray.d[2] * ray.d[2];
  const Double b = ray.b + oz * ray.d[2];
  const Double c = ray.o[0] * ray.o[0] + ray.o[1] * ray.o[1] + oz * oz - s.radius_m * s.radius_m;
  const Double root = b * b - a * c;
  return root > 0.0 ? (-b - Sqrt(root > 0.0 ? root : Double{})) / a : Splat(kNever);
}
PALPATE_LANES Double EnterDisc(const RoundSurface& s, const RoundRay& ray, Double center) {
  const Double safe = ray.d[2] != 0.0 ? ray.d[2] : Splat(1e-300);
  const Double t = (center - ray.o[2]) / safe;
  const Double x = ray.o[0] + t * ray.d[0];
  const Double y = ray.o[1] + t * ray.d[1];
  return x * x + y * y <= s.radius_m * s.radius_m ? t : Splat(kNever);
}

/// Where the ray enters the shape: the mantle of the infinite cylinder between the ends, else the
/// end on whose side it enters that cylinder.
PALPATE_LANES Double Enter(const RoundSurface& s, const RoundRay& ray) {
  const Double root = Sqrt(ray.root > 0.0 ? ray.root : Double{});
  const Double mantle = (-ray.b - root) / ray.a;
  const Double height = ray.o[2] + mantle * ray.d[2];
  const DoubleMask between = (height >= -s.half_length_m) & (height <= s.half_length_m);
  const DoubleMask meets = ray.root > 0.0;
  Double enters = mantle;
  if (Any(__builtin_convertvector(meets & ~between, HalfInt))) {
    const Double end = height > 0.0 ? Splat(s.half_length_m) : Splat(-s.half_length_m);
    const Double at_end = s.round_ends ? EnterSphere(s, ray, end) : EnterDisc(s, ray, end);
    enters = between ? mantle : at_end;
  }
  return meets ? enters : Splat(kNever);
}

void FillRound(const RoundSurface& shape, std::uint32_t surface, const RaySegment& rays) {
  bool was_met = false;
  for (int i = 0; i < rays.count; i += kHalf) {
    const Double y = rays.y != nullptr ? Load(rays.y + i) : Splat(rays.row_y);
    const RoundRay ray = MakeRay(shape, Load(rays.x + i), y);
    if (!Any(__builtin_convertvector(ray.root > 0.0, HalfInt))) {
      if (was_met && rays.y == nullptr) return;  // convex, so a row meets it once
      continue;
    }
    was_met = true;
    const Double t = Enter(shape, ray);
    const Double value = (t >= shape.nearest_m) & (t < kNever) ? 1.0 / t : Double{};
    const HalfFloat mine = __builtin_convertvector(value, HalfFloat);
    const HalfFloat old = LoadAs<HalfFloat>(rays.inverse_z + i);
    const HalfInt wins = (mine > old) & (LanesOf<HalfInt>() + i < rays.count);
    Store(rays.inverse_z + i, wins ? mine : old);
    const HalfWord surfaces = LoadAs<HalfWord>(rays.surface + i);
    Store(rays.surface + i, wins ? HalfWord{} + surface : surfaces);
  }
}

}  // namespace

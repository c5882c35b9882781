// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/picture/shapes.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

namespace palpate::view {

namespace {

constexpr int kAround = 32;  // pieces of a circle

double AngleOf(int piece) { return 2.0 * std::numbers::pi * piece / kAround; }

struct Ring {
  Eigen::Vector3d first;
  Eigen::Vector3d second;

  explicit Ring(const Eigen::Vector3d& axis) {
    first = axis.unitOrthogonal();
    second = axis.normalized().cross(first);
  }

  Eigen::Vector3d At(int piece) const {
    return std::cos(AngleOf(piece)) * first + std::sin(AngleOf(piece)) * second;
  }
};

void AddQuad(const std::array<ShadedTriangles::Corner, 4>& corners, ShadedTriangles* out) {
  out->AddTriangle(corners[0], corners[1], corners[2]);
  out->AddTriangle(corners[0], corners[2], corners[3]);
}

}  // namespace

void ShadedTriangles::AddTriangle(const Corner& a, const Corner& b, const Corner& c) {
  corners.push_back(a);
  corners.push_back(b);
  corners.push_back(c);
}

void AddBall(const Eigen::Vector3d& center_m, double radius_m, const Color& color,
             ShadedTriangles* out) {
  constexpr int kBands = kAround / 2;
  const auto corner = [&](int band, int piece) {
    const double polar = std::numbers::pi * band / kBands;
    const Eigen::Vector3d n(std::sin(polar) * std::cos(AngleOf(piece)),
                            std::sin(polar) * std::sin(AngleOf(piece)), std::cos(polar));
    return ShadedTriangles::Corner{center_m + radius_m * n, n, color};
  };
  for (int band = 0; band < kBands; ++band) {
    for (int piece = 0; piece < kAround; ++piece) {
      AddQuad({corner(band, piece), corner(band + 1, piece), corner(band + 1, piece + 1),
               corner(band, piece + 1)},
              out);
    }
  }
}

void AddFrustum(const Eigen::Vector3d& a_m, double radius_a_m, const Eigen::Vector3d& b_m,
                double radius_b_m, const Color& color, ShadedTriangles* out) {
  const Eigen::Vector3d axis = b_m - a_m;
  const double length_m = axis.norm();
  if (length_m == 0.0) {
    return;
  }
  const Ring ring(axis);
  const Eigen::Vector3d lean = (radius_a_m - radius_b_m) / length_m * axis / length_m;
  for (int piece = 0; piece < kAround; ++piece) {
    const Eigen::Vector3d now = ring.At(piece);
    const Eigen::Vector3d next = ring.At(piece + 1);
    AddQuad({ShadedTriangles::Corner{a_m + radius_a_m * now, now + lean, color},
             {a_m + radius_a_m * next, next + lean, color},
             {b_m + radius_b_m * next, next + lean, color},
             {b_m + radius_b_m * now, now + lean, color}},
            out);
  }
}

void AddDisc(const Eigen::Vector3d& center_m, const Eigen::Vector3d& normal, double radius_m,
             const Color& color, ShadedTriangles* out) {
  const Ring ring(normal);
  for (int piece = 0; piece < kAround; ++piece) {
    out->AddTriangle({center_m, normal, color},
                     {center_m + radius_m * ring.At(piece), normal, color},
                     {center_m + radius_m * ring.At(piece + 1), normal, color});
  }
}

void AddBox(const Eigen::Vector3d& center_m, const Eigen::Matrix3d& half_axes_m, const Color& color,
            ShadedTriangles* out) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d u = half_axes_m.col((axis + 1) % 3);
    const Eigen::Vector3d v = half_axes_m.col((axis + 2) % 3);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d normal = side * half_axes_m.col(axis);
      const Eigen::Vector3d middle = center_m + normal;
      AddQuad({ShadedTriangles::Corner{middle - u - v, normal, color},
               {middle + u - v, normal, color},
               {middle + u + v, normal, color},
               {middle - u + v, normal, color}},
              out);
    }
  }
}

}  // namespace palpate::view

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/channels.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "components/palpate/new_robot/face_patches.hpp"
#include "libs/core/index.hpp"

namespace palpate::command {

namespace {

/// Where a hole meets the surface, the body has an edge at least so sharp.
constexpr double kRim_rad = 45.0 * std::numbers::pi / 180.0;
constexpr int kFewestFaces = 8;
constexpr double kLongAsWide = 6.0;
constexpr double kWidestOfBody = 0.1;

struct Wall {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  std::vector<int> faces;
  double area_m2 = 0.0;
};

/// The direction to which the faces' normals are most nearly at right angles.
Wall WallOf(const geometry::TriangleSurface& surface, const std::vector<int>& faces) {
  Wall wall;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const int face : faces) {
    const Eigen::Vector3d area_m2 = geometry::TriangleAreaVector_m2(surface, face);
    if (area_m2.isZero()) continue;
    wall.area_m2 += area_m2.norm();
    spread += area_m2 * area_m2.transpose() / area_m2.norm();
  }
  wall.axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  wall.faces = faces;
  return wall;
}

/// Without the bottom of a blind hole.
std::optional<Wall> WithoutBottom(const geometry::TriangleSurface& surface,
                                  const std::vector<int>& patch) {
  // Flat triangles on a cylinder lean a little to its axis, the more the coarser they are.
  constexpr double kAcross = 0.5, kMeanLean = 0.25, kLeastShare = 0.7;
  const Wall rough = WallOf(surface, patch);
  std::vector<int> sides;
  for (const int face : patch) {
    const Eigen::Vector3d normal = geometry::TriangleNormal(surface, face);
    if (std::abs(normal.dot(rough.axis)) < kAcross) sides.push_back(face);
  }
  if (static_cast<int>(sides.size()) < kFewestFaces) return std::nullopt;
  Wall wall = WallOf(surface, sides);
  if (wall.area_m2 < kLeastShare * rough.area_m2) return std::nullopt;
  double lean_m2 = 0.0;  // squared, times the area
  for (const int face : sides) {
    const double area_m2 = geometry::TriangleAreaVector_m2(surface, face).norm();
    const double lean = geometry::TriangleNormal(surface, face).dot(wall.axis);
    lean_m2 += area_m2 * lean * lean;
  }
  if (lean_m2 > kMeanLean * kMeanLean * wall.area_m2) return std::nullopt;
  return wall;
}

/// Normals all round: a groove has them on one side.
bool GoesAllRound(const geometry::TriangleSurface& surface, const Wall& wall) {
  constexpr double kBalanced = 0.15;
  Eigen::Vector3d sum_m2 = Eigen::Vector3d::Zero();
  for (const int face : wall.faces) sum_m2 += geometry::TriangleAreaVector_m2(surface, face);
  return sum_m2.norm() < kBalanced * wall.area_m2;
}

/// The circle to which the wall's planes are tangent: n . (p - x) = r, by least squares; nullopt
/// where it is not round, or the body is inside (a rod, not a hole).
std::optional<Channel> FitCircle(const geometry::TriangleSurface& surface, const Wall& wall) {
  constexpr double kRound = 0.25;
  const Eigen::Vector3d u = wall.axis.unitOrthogonal(), v = wall.axis.cross(u);
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const int face : wall.faces) {
    const Eigen::Vector3d n = geometry::TriangleNormal(surface, face);
    const Eigen::Vector3d row(n.dot(u), n.dot(v), -1.0);
    normal_matrix += row * row.transpose();
    right_side += row * n.dot(surface.Corner(face, 0));
  }
  const Eigen::Vector3d fit = Eigen::LDLT<Eigen::Matrix3d>(normal_matrix).solve(right_side);
  if (!fit.allFinite() || fit(2) <= 0.0) return std::nullopt;
  const Eigen::Vector3d centre_m = fit(0) * u + fit(1) * v;
  double low_m = 0.0, high_m = 0.0, sum_m = 0.0;
  bool first = true;
  for (const int face : wall.faces) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d at_m = surface.Corner(face, k);
      const double along_m = wall.axis.dot(at_m);
      const double radius_m = (at_m - centre_m - along_m * wall.axis).norm();
      if (std::abs(radius_m - fit(2)) > kRound * radius_m) return std::nullopt;
      low_m = first ? along_m : std::min(low_m, along_m);
      high_m = first ? along_m : std::max(high_m, along_m);
      sum_m += radius_m;
      first = false;
    }
  }
  return Channel{.start_m = centre_m + low_m * wall.axis,
                 .end_m = centre_m + high_m * wall.axis,
                 .radius_m = sum_m / (3.0 * static_cast<double>(wall.faces.size())),
                 .faces = wall.faces};
}

bool IsLongAndThin(const BodyShape& shape, const Channel& channel) {
  const double length_m = (channel.end_m - channel.start_m).norm();
  return length_m > kLongAsWide * 2.0 * channel.radius_m &&
         2.0 * channel.radius_m < kWidestOfBody * shape.diagonal_m;
}

}  // namespace

std::vector<Channel> FindChannels(const BodyShape& shape) {
  const auto pairs = NeighboursAmong(shape.surface, shape.outer_faces);
  const auto is_rim = [](const FacePair& pair) {
    return pair.convex && pair.cos_angle < std::cos(kRim_rad);
  };
  const auto patches =
      FindPatches(shape.outer_faces, pairs, [&](const FacePair& pair) { return !is_rim(pair); });
  std::vector<Channel> channels;
  for (const std::vector<int>& patch : patches) {
    if (static_cast<int>(patch.size()) < kFewestFaces) continue;
    const auto wall = WithoutBottom(shape.surface, patch);
    if (!wall || !GoesAllRound(shape.surface, *wall)) continue;
    auto channel = FitCircle(shape.surface, *wall);
    if (!channel || !IsLongAndThin(shape, *channel)) continue;
    channel->faces = patch;
    channels.push_back(*channel);
  }
  return channels;
}

}  // namespace palpate::command

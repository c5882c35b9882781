// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/fibre_paths.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/shape_functions.hpp"
#include "libs/geometry/box.hpp"

namespace palpate::robot {

namespace {

/// A fibre presses on the body where it turns, at the ends of its chords. Half as many chords are
/// too few where it is much stiffer than the wall: 3 % of the expansion of a tube in place of 0.4
/// %.
constexpr int kChordsPerTurn = 72;
constexpr double kFibreReach_m = 0.001;
constexpr double kFibreReachOfDiagonal = 0.01;
constexpr double kInextensible = 30.0;

/// A frame about the axis: z along it, x where the winding begins.
Eigen::Matrix3d AxisFrame(const Eigen::Vector3d& along) {
  const Eigen::Vector3d z = along.normalized();
  constexpr double kAlong = 0.9;
  const Eigen::Vector3d side =
      std::abs(z.x()) < kAlong ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  Eigen::Matrix3d frame;
  frame.col(0) = (side - side.dot(z) * z).normalized();
  frame.col(1) = z.cross(frame.col(0));
  frame.col(2) = z;
  return frame;
}

Eigen::Vector3d OnCylinder(double radius_m, double turn, double height_m) {
  const double angle_rad = 2.0 * std::numbers::pi * turn;
  return {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), height_m};
}

Eigen::Matrix3Xd Helix(const Winding& winding, double length_m) {
  const double turns = length_m / winding.spacing_m;
  const int chords = std::max(1, static_cast<int>(std::ceil(turns * kChordsPerTurn - 1e-9)));
  const double sense = winding.left_handed ? -1.0 : 1.0;
  Eigen::Matrix3Xd path_m(3, chords + 1);
  for (int k = 0; k <= chords; ++k) {
    const double share = static_cast<double>(k) / chords;
    path_m.col(k) = OnCylinder(winding.radius_m, sense * turns * share, length_m * share);
  }
  return path_m;
}

Eigen::Matrix3Xd Ring(const Winding& winding, double height_m) {
  Eigen::Matrix3Xd path_m(3, kChordsPerTurn + 1);
  for (int k = 0; k <= kChordsPerTurn; ++k) {
    path_m.col(k) = OnCylinder(winding.radius_m, static_cast<double>(k) / kChordsPerTurn, height_m);
  }
  return path_m;
}

std::string InMillimetres(double length_m) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.3g", length_m * 1e3);
  return text.data();
}

std::string PlaceText_mm(const Eigen::Vector3d& place_m) {
  return "(" + InMillimetres(place_m.x()) + ", " + InMillimetres(place_m.y()) + ", " +
         InMillimetres(place_m.z()) + ") mm";
}

}  // namespace

std::vector<Eigen::Matrix3Xd> FibrePaths(const FibreSettings& fibre) {
  if (!fibre.winding) return {fibre.path_m};
  const Winding& winding = *fibre.winding;
  const Eigen::Vector3d origin_m = winding.axis_m.col(0);
  const Eigen::Vector3d along_m = winding.axis_m.col(1) - origin_m;
  const double length_m = along_m.norm();
  std::vector<Eigen::Matrix3Xd> paths_m;
  if (winding.kind == Winding::Kind::kHelix) {
    paths_m.push_back(Helix(winding, length_m));
  } else {
    constexpr double kRounding = 1e-9;
    const int gaps = static_cast<int>(length_m / winding.spacing_m + kRounding);
    for (int k = 0; k <= gaps; ++k) paths_m.push_back(Ring(winding, k * winding.spacing_m));
  }
  const Eigen::Matrix3d frame = AxisFrame(along_m);
  for (Eigen::Matrix3Xd& path_m : paths_m) path_m = (frame * path_m).colwise() + origin_m;
  return paths_m;
}

double InextensibleStiffness_N(const fem::TetMesh& mesh,
                               const std::vector<fem::Material>& materials) {
  double modulus_Pa = 0.0;
  for (const fem::Material& material : materials) {
    modulus_Pa = std::max(modulus_Pa, material.youngs_modulus_Pa);
  }
  const double volume_m3 =
      fem::ConsistentNodalMass_kg(mesh, Eigen::VectorXd::Ones(mesh.CellCount())).sum();
  return kInextensible * modulus_Pa * volume_m3 / geometry::BoundingBox(mesh.nodes_m).Diagonal_m();
}

BodyFibre LayFibre(const FibreSettings& settings, const fem::PointLocator& locator,
                   double inextensible_N) {
  BodyFibre fibre{.name = settings.name, .paths_m = FibrePaths(settings)};
  for (const Eigen::Matrix3Xd& path_m : fibre.paths_m) {
    fem::AddPolyline(locator, path_m, &fibre.embedded);
  }
  fibre.embedded.axial_stiffness_N = settings.axial_stiffness_N.value_or(inextensible_N);
  for (const fem::FibrePoint& point : fibre.embedded.points) fibre.length_m += point.length_m;
  const double diagonal_m = geometry::BoundingBox(locator.mesh().nodes_m).Diagonal_m();
  const double reach_m = std::min(kFibreReach_m, kFibreReachOfDiagonal * diagonal_m);
  if (fibre.embedded.off_m > reach_m) {
    throw InputError(settings.where, "fibre '" + settings.name + "' leaves the body near " +
                                         PlaceText_mm(fibre.embedded.off_at_m) + ", " +
                                         InMillimetres(fibre.embedded.off_m) +
                                         " mm from it; allowed are " + InMillimetres(reach_m) +
                                         " mm (1 mm, or 1 % of the body's diagonal where that is "
                                         "less); is it in metres?");
  }
  return fibre;
}

}  // namespace palpate::robot

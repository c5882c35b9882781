// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/boundary_surface.hpp"

namespace palpate::fem {

namespace {

/// A connected part of the boundary.
struct Shell {
  geometry::TriangleSurface surface;
  std::vector<int> faces;
};

/// [faces] the number of the shell of each: faces that share an edge are of one shell.
std::vector<int> ShellOfFace(const BoundarySurface& boundary) {
  std::map<std::pair<int, int>, std::vector<int>> faces_at;
  const auto edge = [&](int face, int side) {
    const int a = boundary.faces(side, face);
    const int b = boundary.faces((side + 1) % 3, face);
    return std::pair(std::min(a, b), std::max(a, b));
  };
  for (int face = 0; face < boundary.FaceCount(); ++face) {
    for (int side = 0; side < 3; ++side) faces_at[edge(face, side)].push_back(face);
  }
  std::vector<int> shell_of(At(boundary.FaceCount()), -1);
  int shells = 0;
  for (int start = 0; start < boundary.FaceCount(); ++start) {
    if (shell_of[At(start)] >= 0) continue;
    std::vector<int> open{start};
    shell_of[At(start)] = shells;
    while (!open.empty()) {
      const int face = open.back();
      open.pop_back();
      for (int side = 0; side < 3; ++side) {
        for (const int next : faces_at.at(edge(face, side))) {
          if (shell_of[At(next)] >= 0) continue;
          shell_of[At(next)] = shells;
          open.push_back(next);
        }
      }
    }
    ++shells;
  }
  return shell_of;
}

std::vector<Shell> ShellsOf(const TetMesh& mesh, const BoundarySurface& boundary) {
  const std::vector<int> shell_of = ShellOfFace(boundary);
  const int count = shell_of.empty() ? 0 : *std::max_element(shell_of.begin(), shell_of.end()) + 1;
  std::vector<Shell> shells(At(count));
  for (int face = 0; face < boundary.FaceCount(); ++face) {
    shells[At(shell_of[At(face)])].faces.push_back(face);
  }
  const Eigen::Matrix3Xi triangles = boundary.CornerTriangles();
  for (Shell& shell : shells) {
    shell.surface = {mesh.nodes_m, triangles(Eigen::all, shell.faces)};
  }
  return shells;
}

/// The normals of a cavity's wall point into it, so that the volume inside it is negative.
bool IsCavity(const Shell& shell) { return geometry::EnclosedVolume_m3(shell.surface) < 0.0; }

/// Times that a closed surface goes round `point_m`: 0 outside, 1 inside, -1 inside one whose
/// normals point inward. From solid angles (van Oosterom and Strackee 1983).
double WindingNumber(const geometry::TriangleSurface& surface, const Eigen::Vector3d& point_m) {
  double solid_angle = 0.0;
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    const Eigen::Vector3d a = surface.Corner(t, 0) - point_m;
    const Eigen::Vector3d b = surface.Corner(t, 1) - point_m;
    const Eigen::Vector3d c = surface.Corner(t, 2) - point_m;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    solid_angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                                    la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return solid_angle / (4.0 * std::numbers::pi);
}

}  // namespace

std::vector<std::vector<int>> InnerSkins(const TetMesh& mesh, const BoundarySurface& boundary) {
  std::vector<std::vector<int>> skins;
  for (Shell& shell : ShellsOf(mesh, boundary)) {
    if (IsCavity(shell)) skins.push_back(std::move(shell.faces));
  }
  return skins;
}

std::vector<int> OuterFaces(const TetMesh& mesh, const BoundarySurface& boundary) {
  const std::vector<Shell> shells = ShellsOf(mesh, boundary);
  std::vector<const Shell*> cavities;
  for (const Shell& shell : shells) {
    if (IsCavity(shell)) cavities.push_back(&shell);
  }
  std::vector<int> outer;
  for (const Shell& shell : shells) {
    const bool inner = std::any_of(cavities.begin(), cavities.end(), [&](const Shell* cavity) {
      return cavity == &shell || WindingNumber(cavity->surface, shell.surface.Corner(0, 0)) < -0.5;
    });
    if (!inner) outer.insert(outer.end(), shell.faces.begin(), shell.faces.end());
  }
  std::sort(outer.begin(), outer.end());
  return outer;
}

}  // namespace palpate::fem

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/cell_kinds.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace palpate::fem::mesh_io {

namespace {

struct NumberedKind {
  int type;
  CellKind kind;
};

constexpr CellKind Lower(int node_count, const char* name) {
  return {CellRole::kLowerDimension, node_count, name};
}

constexpr CellKind Volume(const char* name) { return {CellRole::kRefused, 0, name}; }

constexpr std::array kVtkKinds = std::to_array<NumberedKind>({
    {10, {CellRole::kTet4, 4, "tetrahedron"}},
    {24, {CellRole::kTet10, 10, "quadratic tetrahedron"}},
    {0, Lower(0, "empty cell")},
    {1, Lower(1, "vertex")},
    {2, Lower(0, "poly-vertex")},
    {3, Lower(2, "line")},
    {4, Lower(0, "poly-line")},
    {5, Lower(3, "triangle")},
    {6, Lower(0, "triangle strip")},
    {7, Lower(0, "polygon")},
    {8, Lower(4, "pixel")},
    {9, Lower(4, "quadrilateral")},
    {21, Lower(3, "quadratic edge")},
    {22, Lower(6, "quadratic triangle")},
    {23, Lower(8, "quadratic quadrilateral")},
    {28, Lower(9, "biquadratic quadrilateral")},
    {30, Lower(6, "quadratic linear quadrilateral")},
    {34, Lower(7, "biquadratic triangle")},
    {35, Lower(4, "cubic line")},
    {36, Lower(0, "quadratic polygon")},
    {68, Lower(0, "Lagrange curve")},
    {69, Lower(0, "Lagrange triangle")},
    {70, Lower(0, "Lagrange quadrilateral")},
    {75, Lower(0, "Bezier curve")},
    {76, Lower(0, "Bezier triangle")},
    {77, Lower(0, "Bezier quadrilateral")},
    {11, Volume("voxel")},
    {12, Volume("hexahedron")},
    {13, Volume("wedge")},
    {14, Volume("pyramid")},
    {15, Volume("pentagonal prism")},
    {16, Volume("hexagonal prism")},
    {25, Volume("quadratic hexahedron")},
    {26, Volume("quadratic wedge")},
    {27, Volume("quadratic pyramid")},
    {29, Volume("triquadratic hexahedron")},
    {42, Volume("polyhedron")},
    {71, Volume("Lagrange tetrahedron")},
    {72, Volume("Lagrange hexahedron")},
    {73, Volume("Lagrange wedge")},
    {74, Volume("Lagrange pyramid")},
    {78, Volume("Bezier tetrahedron")},
    {79, Volume("Bezier hexahedron")},
});

constexpr std::array kGmshKinds = std::to_array<NumberedKind>({
    {4, {CellRole::kTet4, 4, "tetrahedron"}},
    {11, {CellRole::kTet10, 10, "10-node tetrahedron"}},
    {15, Lower(1, "point")},
    {1, Lower(2, "line")},
    {8, Lower(3, "3-node line")},
    {26, Lower(4, "4-node line")},
    {27, Lower(5, "5-node line")},
    {28, Lower(6, "6-node line")},
    {2, Lower(3, "triangle")},
    {9, Lower(6, "6-node triangle")},
    {20, Lower(9, "9-node triangle")},
    {21, Lower(10, "10-node triangle")},
    {22, Lower(12, "12-node triangle")},
    {23, Lower(15, "15-node triangle")},
    {24, Lower(15, "15-node triangle")},
    {25, Lower(21, "21-node triangle")},
    {3, Lower(4, "quadrangle")},
    {10, Lower(9, "9-node quadrangle")},
    {16, Lower(8, "8-node quadrangle")},
    {36, Lower(16, "16-node quadrangle")},
    {37, Lower(25, "25-node quadrangle")},
    {5, Volume("hexahedron")},
    {6, Volume("prism")},
    {7, Volume("pyramid")},
    {12, Volume("27-node hexahedron")},
    {13, Volume("18-node prism")},
    {14, Volume("14-node pyramid")},
    {17, Volume("20-node hexahedron")},
    {18, Volume("15-node prism")},
    {19, Volume("13-node pyramid")},
    {29, Volume("20-node tetrahedron")},
    {30, Volume("35-node tetrahedron")},
    {31, Volume("56-node tetrahedron")},
});

CellKind Find(std::span<const NumberedKind> kinds, int64_t type) {
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [type](const NumberedKind& kind) { return kind.type == type; });
  return found == kinds.end() ? CellKind{} : found->kind;
}

}  // namespace

CellKind VtkCellKind(int64_t type, size_t node_count) {
  constexpr int64_t kTet4 = 10, kTet10 = 24, kLagrangeTet = 71;
  if (type == kLagrangeTet && node_count == 4) return Find(kVtkKinds, kTet4);
  if (type == kLagrangeTet && node_count == 10) return Find(kVtkKinds, kTet10);
  return Find(kVtkKinds, type);
}

CellKind GmshCellKind(int64_t type) {
  constexpr int64_t kPoint = 15;
  constexpr std::array<int64_t, 5> kLines = {1, 8, 26, 27, 28};
  CellKind kind = Find(kGmshKinds, type);
  if (kind.role != CellRole::kLowerDimension) return kind;
  const bool is_line = std::find(kLines.begin(), kLines.end(), type) != kLines.end();
  kind.dimension = type == kPoint ? 0 : (is_line ? 1 : 2);
  return kind;
}

}  // namespace palpate::fem::mesh_io

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/palpate/test_robot.hpp"

#include <array>
#include <sstream>
#include <vector>

namespace palpate::command {

namespace {

constexpr int kAlong = 8;  // cubes of 10 mm
constexpr int kAcross = 2;

int NodeOf(int i, int j, int k) { return (i * (kAcross + 1) + j) * (kAcross + 1) + k; }

// Six tetrahedra around the diagonal of each cube.
std::vector<std::array<int, 4>> Tetrahedra() {
  constexpr int kPaths[6][2] = {{0, 1}, {1, 0}, {1, 2}, {2, 1}, {2, 0}, {0, 2}};
  std::vector<std::array<int, 4>> cells;
  for (int cube = 0; cube < kAlong * kAcross * kAcross; ++cube) {
    const std::array<int, 3> corner = {cube / (kAcross * kAcross), cube / kAcross % kAcross,
                                       cube % kAcross};
    for (int path = 0; path < 6; ++path) {
      std::array<int, 3> at = corner;
      std::array<int, 4> cell{};
      cell[0] = NodeOf(at[0], at[1], at[2]);
      ++at[static_cast<std::size_t>(kPaths[path][0])];
      cell[1] = NodeOf(at[0], at[1], at[2]);
      ++at[static_cast<std::size_t>(kPaths[path][1])];
      cell[2] = NodeOf(at[0], at[1], at[2]);
      cell[3] = NodeOf(corner[0] + 1, corner[1] + 1, corner[2] + 1);
      if (path % 2 == 1) std::swap(cell[1], cell[2]);
      cells.push_back(cell);
    }
  }
  return cells;
}

std::string BarVtk() {
  std::ostringstream text;
  text << "# vtk DataFile Version 3.0\nbar\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS "
       << (kAlong + 1) * (kAcross + 1) * (kAcross + 1) << " double\n";
  for (int i = 0; i <= kAlong; ++i) {
    for (int j = 0; j <= kAcross; ++j) {
      for (int k = 0; k <= kAcross; ++k) {
        text << 10 * i << ' ' << 10 * j << ' ' << 10 * k << '\n';
      }
    }
  }
  const auto cells = Tetrahedra();
  text << "CELLS " << cells.size() << ' ' << 5 * cells.size() << '\n';
  for (const auto& c : cells) {
    text << "4 " << c[0] << ' ' << c[1] << ' ' << c[2] << ' ' << c[3] << '\n';
  }
  text << "CELL_TYPES " << cells.size() << '\n';
  for (std::size_t i = 0; i < cells.size(); ++i) text << "10\n";
  return text.str();
}

}  // namespace

std::filesystem::path WriteBarRobot(const TestFolder& folder) {
  folder.Write("bar.vtk", BarVtk());
  return folder.Write("bar.yaml", R"(name: bar
mesh: {file: bar.vtk, unit: mm}
element: tet4
material: {model: stable_neo_hookean, youngs_modulus_Pa: 100.0e3, poissons_ratio: 0.45}
mass: {density_kg_m3: 1000}
gravity_m_s2: [0, 0, -9.81]
fixed: [{box_m: [[-0.001, -0.001, -0.001], [0.001, 0.021, 0.021]]}]
cables:
  - {name: top, path_m: [[-0.01, 0.01, 0.02], [0.08, 0.01, 0.02]], max_tension_N: 1, guide_radius_m: 0}
markers: [{name: tip, position_m: [0.08, 0.01, 0.02]}]
feature_points: {count: 3}
)");
}

}  // namespace palpate::command

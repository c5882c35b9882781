// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/robot_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"

namespace palpate::robot {

std::string FullRobotText() {
  return R"(name: test beam
mesh: {file: beam.vtk, unit: mm, rotate_xyz_deg: [0, 0, 90], translate_mm: [0, 100, 0]}
element: tet10
material: {model: stable_neo_hookean, youngs_modulus_Pa: 65.0e3, poissons_ratio: 0.45}
mass: {total_kg: 0.5, distribution: volume}
gravity_m_s2: [0, 0, -9.81]
fixed: [{box_m: [[-0.011, -0.001, -0.011], [0.011, 0.001, 0.011]]}]
cables:
  - {name: north, path_m: [[0, 0, 0.02], [0, 0.05, 0.0101], [0, 0.09, 0.009]], max_tension_N: 20, guide_radius_m: 0}
  - {name: south, path_m: [[0, 0, -0.02], [0, 0.095, -0.009]]}
regions:
  - {name: tip, box_m: [[-0.02, 0.08, -0.02], [0.02, 0.12, 0.02]], youngs_modulus_Pa: 30e3}
  - {name: root, box_m: [[-0.02, 0, -0.02], [0.02, 0.02, 0.02]]}
markers: [{name: m1, position_m: [0, 0.1, 0.016]}, {name: "2", position_m: [0, 0.05, 0]}]
feature_points: {count: 12}
)";
}

std::string Changed(const std::string& old_text, const std::string& new_text) {
  std::string text = FullRobotText();
  const size_t at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  EXPECT_EQ(text.find(old_text, at + 1), std::string::npos) << old_text;
  return text.replace(at, old_text.size(), new_text);
}

RobotDescription ReadText(const std::string& text, const std::filesystem::path& file) {
  return ReadRobotFile(
      file, [&](const std::filesystem::path& path) { return app::ParseYaml(text, path.string()); });
}

std::string RefusalOf(const std::string& text) {
  try {
    ReadText(text);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

fem::TetMesh Beam_mm() {
  constexpr int kLong = 10;
  constexpr int kWide = 2;
  const auto node = [](int x, int y, int z) { return (z * (kWide + 1) + y) * (kLong + 1) + x; };
  fem::TetMesh mesh{Eigen::Matrix3Xd(3, (kLong + 1) * (kWide + 1) * (kWide + 1)),
                    Eigen::MatrixXi(4, 6 * kLong * kWide * kWide),
                    {}};
  for (int z = 0; z <= kWide; ++z) {
    for (int y = 0; y <= kWide; ++y) {
      for (int x = 0; x <= kLong; ++x) {
        mesh.nodes_m.col(node(x, y, z)) << 10.0 * x - 100.0, 10.0 * y - 10.0, 10.0 * z - 10.0;
      }
    }
  }
  int cell = 0;
  for (int z = 0; z < kWide; ++z) {
    for (int y = 0; y < kWide; ++y) {
      for (int x = 0; x < kLong; ++x) {
        const int ring[] = {node(x + 1, y, z),     node(x + 1, y + 1, z), node(x, y + 1, z),
                            node(x, y + 1, z + 1), node(x, y, z + 1),     node(x + 1, y, z + 1),
                            node(x + 1, y, z)};
        for (int k = 0; k < 6; ++k) {
          mesh.cells.col(cell++) << node(x, y, z), ring[k], ring[k + 1], node(x + 1, y + 1, z + 1);
        }
      }
    }
  }
  return mesh;
}

void WriteVtk(const fem::TetMesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(17);
  out << "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS "
      << mesh.NodeCount() << " double\n"
      << mesh.nodes_m.transpose() << "\nCELLS " << mesh.CellCount() << ' '
      << mesh.CellCount() * (mesh.cells.rows() + 1) << '\n';
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    out << mesh.cells.rows() << ' ' << mesh.cells.col(cell).transpose() << '\n';
  }
  out << "CELL_TYPES " << mesh.CellCount() << '\n';
  const int vtk_type = mesh.element_type() == fem::ElementType::kTet4 ? 10 : 24;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) out << vtk_type << '\n';
}

}  // namespace palpate::robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/independent/finger.hpp"

#include <fstream>

namespace palpate::test_support {

namespace {

/// The corners of the ten-node cells, as a legacy VTK file.
void WriteVtk(const CalculixBody& body, const std::filesystem::path& file) {
  std::ofstream text(file);
  text << "# vtk DataFile Version 3.0\nfinger\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS "
       << body.nodes_mm().size() << " double\n";
  for (const Eigen::Vector3d& node : body.nodes_mm()) text << node.transpose() << "\n";
  text << "CELLS " << body.cells().size() << " " << 11 * body.cells().size() << "\n";
  for (const std::array<int, 10>& cell : body.cells()) {
    text << "10";
    for (const int node : cell) text << " " << node;
    text << "\n";
  }
  text << "CELL_TYPES " << body.cells().size() << "\n";
  for (std::size_t c = 0; c < body.cells().size(); ++c) text << "24\n";
}

}  // namespace

CalculixBody FingerBody(const std::array<int, 3>& cells) {
  CalculixBody body =
      CalculixBody::Bar({-14, -14, 0}, {14, 14, 110}, cells, {.youngs_modulus_MPa = 0.35});
  body.Fix([](const Eigen::Vector3d& x) { return x.z() < 0.5; });
  return body;
}

std::filesystem::path WriteFinger(const std::filesystem::path& folder) {
  WriteVtk(FingerBody({4, 4, 14}), folder / "finger.vtk");
  const std::filesystem::path file = folder / "finger.yaml";
  std::ofstream(file) << R"(name: finger
mesh: {file: finger.vtk, unit: mm}
element: tet10
material: {model: stable_neo_hookean, youngs_modulus_Pa: 350.0e3, poissons_ratio: 0.45}
mass: {density_kg_m3: 1070}
gravity_m_s2: [0, 0, -9.81]
fixed: [{box_m: [[-0.0145, -0.0145, -0.0005], [0.0145, 0.0145, 0.0005]]}]
cables:
  - {name: pull, path_m: [[0.06, 0, 0], [0.013, 0, 0.09]], max_tension_N: 10, guide_radius_m: 0}
feature_points: {count: 30}
)";
  return file;
}

}  // namespace palpate::test_support

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/chambers/hollow_robot.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <stdexcept>

#include "libs/core/error.hpp"
#include "libs/fem/boundary_surface.hpp"
#include "tests/libs/fem/verification/grid_mesh.hpp"
#include "tests/libs/robot/chambers/hollow_bodies.hpp"

namespace palpate::robot {

namespace {

Eigen::MatrixXi FacesOfSkin(const fem::TetMesh& mesh, std::size_t number) {
  const fem::BoundarySurface boundary = fem::ExtractBoundary(mesh);
  const std::vector<int> faces = fem::InnerSkins(mesh, boundary).at(number);
  return boundary.CornerTriangles()(Eigen::all, faces);
}

/// Corners of a face that two cells share.
Eigen::MatrixXi FaceInside(const fem::TetMesh& mesh) {
  const Eigen::Matrix3Xi outside = fem::ExtractBoundary(mesh).CornerTriangles();
  for (const auto& cell : mesh.cells.colwise()) {
    const Eigen::Vector3i face = cell.head<3>();
    const bool is_outside =
        std::any_of(outside.colwise().begin(), outside.colwise().end(), [&](const auto& one) {
          return (one.array() == face[0]).any() && (one.array() == face[1]).any() &&
                 (one.array() == face[2]).any();
        });
    if (!is_outside) return face;
  }
  throw std::logic_error("every first face is outside");
}

}  // namespace

fem::TetMesh HollowBar_mm() {
  const fem::TetMesh box =
      fem::verification::MakeBox(Eigen::Array3i(6, 4, 5), fem::ElementType::kTet4, {60, 20, 20});
  return KeepCells(box, [](const Eigen::Vector3d& p) {
    const bool along = p.x() > 10 && p.x() < 50 && p.y() > 5 && p.y() < 15;
    return !(along && ((p.z() > 4 && p.z() < 8) || (p.z() > 12 && p.z() < 16)));
  });
}

geometry::TriangleSurface UpperWall_mm() {
  const fem::TetMesh mesh = HollowBar_mm();
  Eigen::MatrixXi faces = FacesOfSkin(mesh, 1);
  faces.row(1).swap(faces.row(2));
  return {mesh.nodes_m, faces};
}

void WriteGmsh(const fem::TetMesh& mesh, const std::vector<NamedTriangles>& surfaces,
               const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(12);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << surfaces.size() + 1 << '\n';
  out << "3 1 \"body\"\n";
  Eigen::Index triangles = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    out << "2 " << s + 2 << " \"" << surfaces[s].name << "\"\n";
    triangles += surfaces[s].faces.cols();
  }
  out << "$EndPhysicalNames\n$Nodes\n" << mesh.NodeCount() << '\n';
  for (int n = 0; n < mesh.NodeCount(); ++n) {
    out << n + 1 << ' ' << mesh.nodes_m.col(n).transpose() << '\n';
  }
  out << "$EndNodes\n$Elements\n" << mesh.CellCount() + triangles << '\n';
  int number = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    for (const auto& face : surfaces[s].faces.colwise()) {
      out << ++number << " 2 2 " << s + 2 << " 1 " << (face.array() + 1).matrix().transpose()
          << '\n';
    }
  }
  for (const auto& cell : mesh.cells.colwise()) {
    out << ++number << " 4 2 1 1 " << (cell.array() + 1).matrix().transpose() << '\n';
  }
  out << "$EndElements\n";
}

void WriteStl(const geometry::TriangleSurface& surface, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  out << std::string(80, ' ');
  const auto write = [&](const auto& value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  write(static_cast<std::uint32_t>(surface.TriangleCount()));
  for (int t = 0; t < surface.TriangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) write(0.0F);  // the normal
    for (int corner = 0; corner < 3; ++corner) {
      for (const double coordinate : surface.Corner(t, corner)) {
        write(static_cast<float>(coordinate));
      }
    }
    write(std::uint16_t{0});
  }
}

HollowRobotTest::HollowRobotTest() {
  const fem::TetMesh mesh = HollowBar_mm();
  const Eigen::MatrixXi lower = FacesOfSkin(mesh, 0), upper = FacesOfSkin(mesh, 1);
  const fem::BoundarySurface boundary = fem::ExtractBoundary(mesh);
  const std::vector<int> outer = fem::OuterFaces(mesh, boundary);
  WriteGmsh(mesh,
            {{"lower wall", lower},
             {"upper wall", upper},
             {"open wall", upper.leftCols(upper.cols() - 3)},
             {"skin", boundary.CornerTriangles()(Eigen::all, outer)},
             {"inside", FaceInside(mesh)}},
            folder_ / "bar.msh");
  WriteStl(UpperWall_mm(), folder_ / "upper.stl");
}

std::string HollowRobotTest::Text(const std::string& chambers, const std::string& mesh_file) const {
  return "name: hollow bar\nmesh: {file: " + mesh_file + R"(, unit: mm}
element: tet10
material: {model: stable_neo_hookean, youngs_modulus_Pa: 150.0e3, poissons_ratio: 0.45}
mass: {density_kg_m3: 1070}
fixed: [{box_m: [[-0.001, -0.001, -0.001], [0.001, 0.021, 0.021]]}]
cables:
  - {name: top, path_m: [[0, 0.01, 0.03], [0.055, 0.01, 0.019]], max_tension_N: 20}
)" + chambers;
}

std::string HollowRobotTest::Text() const {
  return Text(R"(chambers:
  - {name: upper, surface: {physical_group: upper wall}, max_pressure_Pa: 20e3, dead_volume_m3: 1e-6}
  - {name: lower, surface: {inner_skin: 1}}
)");
}

RobotBody HollowRobotTest::BodyOf(const std::string& text) const {
  return BuildRobotBody(ReadText(text, folder_ / "robot.yaml"));
}

std::unique_ptr<RobotModel> HollowRobotTest::Build(const std::string& text,
                                                   const fem::StaticSettings& settings) const {
  return std::make_unique<RobotModel>(BodyOf(text), settings);
}

std::string HollowRobotTest::Refusal(const std::string& text) const {
  try {
    BodyOf(text);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

}  // namespace palpate::robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/mesh/mesh_files.hpp"

#include <algorithm>
#include <array>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/fem/mesh_io/formats.hpp"
#include "libs/fem/mesh_io/mesh_kind.hpp"

namespace palpate::fem::test {

namespace {

/// The six tetrahedra around the diagonal 0-7 of a cube; corner k at (k & 1, k >> 1 & 1, k >> 2).
constexpr std::array<std::array<int, 4>, 6> kSplit = {
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

}  // namespace

TetMesh CubeMesh(int n) {
  const auto node = [n](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  TetMesh mesh;
  mesh.nodes_m.resize(3, (n + 1) * (n + 1) * (n + 1));
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        mesh.nodes_m.col(node(i, j, k)) = Eigen::Vector3d(i, j, k) / n;
      }
    }
  }
  mesh.cells.resize(4, 6 * n * n * n);
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const int cube = cell / 6;
    for (int k = 0; k < 4; ++k) {
      const int corner = kSplit[static_cast<size_t>(cell % 6)][static_cast<size_t>(k)];
      mesh.cells(k, cell) = node(cube % n + (corner & 1), cube / n % n + (corner >> 1 & 1),
                                 cube / (n * n) + (corner >> 2));
    }
  }
  return mesh;
}

std::vector<int> CubeSurface(const TetMesh& cube) {
  constexpr std::array<std::array<int, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::vector<int> surface;
  for (int cell = 0; cell < cube.CellCount(); ++cell) {
    for (const auto& face : kFaces) {
      for (int side = 0; side < 6; ++side) {
        const bool on_side = std::all_of(face.begin(), face.end(), [&](int k) {
          return cube.nodes_m(side / 2, cube.cells(k, cell)) == side % 2;
        });
        if (!on_side) continue;
        for (const int k : face) surface.push_back(cube.cells(k, cell));
      }
    }
  }
  return surface;
}

std::vector<MeshFile> AllFiles(const TetMesh& mesh, const std::vector<int>& surface) {
  std::vector<MeshFile> files = AllVtuFiles(mesh, surface);
  for (const auto& more : {AllVtkFiles(mesh, surface), AllGmshFiles(mesh, surface)}) {
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

std::string Replaced(std::string text, std::string_view from, std::string_view to) {
  const size_t start = text.find(from);
  PALPATE_CHECK(start != std::string::npos, from);
  return text.replace(start, from.size(), to);
}

std::filesystem::path WriteMeshFile(const test_support::TestFolder& folder, const MeshFile& file) {
  return folder.Write(file.name, file.bytes);
}

TetMesh ReadBytes(const MeshFile& file) {
  mesh_io::MeshBuilder builder(file.name);
  switch (KindOfMesh(file.name, file.bytes)) {
    case MeshKind::kVtu: mesh_io::ReadVtu(file.bytes, &builder); break;
    case MeshKind::kLegacyVtk: mesh_io::ReadLegacyVtk(file.bytes, &builder); break;
    case MeshKind::kGmsh: mesh_io::ReadGmsh(file.bytes, &builder); break;
    case MeshKind::kAbaqus: mesh_io::ReadAbaqus(file.bytes, &builder); break;
    case MeshKind::kMedit: mesh_io::ReadMedit(file.bytes, &builder); break;
    case MeshKind::kNone: ADD_FAILURE() << file.name; break;
  }
  return std::move(builder).Finish(1.0, nullptr);
}

std::string RefusalOf(const MeshFile& file) {
  try {
    ReadBytes(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool SameMesh(const TetMesh& a, const TetMesh& b) {
  return a.nodes_m.cols() == b.nodes_m.cols() && a.nodes_m == b.nodes_m &&
         a.cells.rows() == b.cells.rows() && a.cells.cols() == b.cells.cols() && a.cells == b.cells;
}

}  // namespace palpate::fem::test

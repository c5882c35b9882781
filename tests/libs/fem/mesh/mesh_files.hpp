// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "libs/fem/tet_mesh.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::fem::test {

/// A cube of edge 1 m, split into n^3 cubes of six tetrahedra each. Coordinates are exact in
/// Float32 where n is a power of two.
TetMesh CubeMesh(int n);

/// Node indices of the 12 n^2 surface triangles of CubeMesh(n), three a triangle.
std::vector<int> CubeSurface(const TetMesh& cube);

/// A mesh file in memory.
struct MeshFile {
  std::string name;  ///< ends in .vtu, .vtk or .msh
  std::string bytes;
};

/// `mesh` in every variant of the formats that is read, coordinates in the unit of the mesh.
/// Where `surface` is not empty its triangles are in the files too.
std::vector<MeshFile> AllVtuFiles(const TetMesh& mesh, const std::vector<int>& surface);
std::vector<MeshFile> AllVtkFiles(const TetMesh& mesh, const std::vector<int>& surface);
std::vector<MeshFile> AllGmshFiles(const TetMesh& mesh, const std::vector<int>& surface);
std::vector<MeshFile> AllFiles(const TetMesh& mesh, const std::vector<int>& surface);

/// The plain ASCII variants, as a base for damaged files.
std::string AsciiVtu(const TetMesh& mesh);
std::string AsciiVtk(const TetMesh& mesh);
std::string AsciiGmsh22(const TetMesh& mesh);
std::string AsciiGmsh41(const TetMesh& mesh);

/// `text` with the one occurrence of `from` replaced.
std::string Replaced(std::string text, std::string_view from, std::string_view to);

/// Writes the file into the folder; its path.
std::filesystem::path WriteMeshFile(const test_support::TestFolder& folder, const MeshFile& file);

/// Reads from memory as ReadMesh does from disk.
TetMesh ReadBytes(const MeshFile& file);
/// What InputError says when `file` is read; empty where it is read without one.
std::string RefusalOf(const MeshFile& file);

/// True where nodes and cells are exactly those of the other.
bool SameMesh(const TetMesh& a, const TetMesh& b);

}  // namespace palpate::fem::test

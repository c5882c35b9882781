// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>

#include "libs/core/file.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"
#include "tests/support/memory_limit.hpp"

namespace palpate::fem {
namespace {

/// 13 182 tetrahedra, the most that 16-bit offsets take. Packed files count with what they hold:
/// LZMA makes a tenth of a regular mesh.
TEST(MeshMemory, IsAtMostTenTimesTheSizeOfTheFile) {
  const test_support::TestFolder folder;
  const TetMesh cube = test::CubeMesh(13);
  const std::vector<int> surface = test::CubeSurface(cube);
  std::size_t unpacked_bytes = 0;
  for (const test::MeshFile& file : test::AllVtuFiles(cube, surface)) {
    unpacked_bytes = std::max(unpacked_bytes, file.bytes.size());
  }
  for (const test::MeshFile& file : test::AllFiles(cube, surface)) {
    SCOPED_TRACE(file.name);
    const auto path = test::WriteMeshFile(folder, file);
    const bool packed = file.bytes.size() < unpacked_bytes / 4;
    const test_support::MemoryLimit limit(10 * (packed ? unpacked_bytes : file.bytes.size()));
    EXPECT_GE(ReadMesh(path, 1.0).cells.cols(), cube.cells.cols());
  }
}

}  // namespace
}  // namespace palpate::fem

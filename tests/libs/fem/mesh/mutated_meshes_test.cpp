// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "libs/core/error.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_report.hpp"
#include "libs/fem/seams.hpp"
#include "tests/libs/fem/mesh/mesh_files.hpp"
#include "tests/support/memory_limit.hpp"
#include "tests/support/mutations.hpp"

namespace palpate::fem {
namespace {

const std::string kInp =
    "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4, ELSET=a\n"
    "1, 1, 2, 3, 4\n*ELSET, ELSET=b, GENERATE\n1, 1, 1\n";
const std::string kMeditFile =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
    "Tetrahedra\n1\n1 2 3 4 2\nEnd\n";

/// Whatever is read can be reported on.
void ReadOrRefuse(int rounds, unsigned seed) {
  const test_support::TestFolder folder;
  const test_support::MemoryLimit limit(test_support::kReaderLimit_bytes);
  test_support::Mutations mutations(seed);
  const TetMesh cube = test::CubeMesh(1);
  std::vector<test::MeshFile> files = test::AllFiles(cube, test::CubeSurface(cube));
  files.push_back({"m.inp", kInp});
  files.push_back({"m.mesh", kMeditFile});
  int refused = 0, read = 0;
  for (const test::MeshFile& file : files) {
    for (int round = 0; round < rounds; ++round) {
      const auto path = test::WriteMeshFile(folder, {file.name, mutations.Of(file.bytes)});
      try {
        TetMesh mesh = ReadMesh(path, 1e-3);
        JoinSeams(&mesh);
        ReportMesh(mesh);
        ++read;
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, rounds);
  EXPECT_GT(read, rounds / 10);
}

TEST(MutatedMeshes, AreReadOrRefused) { ReadOrRefuse(40, 20261128); }

TEST(MutatedMeshes, AreReadOrRefusedInManyRounds) { ReadOrRefuse(4000, 7); }

}  // namespace
}  // namespace palpate::fem

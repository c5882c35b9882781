// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/rod_meshes.hpp"

#include <utility>

namespace palpate::blind {

namespace {

constexpr char kCoarse[] = "rod_coarse.msh";
constexpr char kFine[] = "rod.msh";

}  // namespace

RodMeshes MeshesOfRod(std::uint64_t seed) {
  constexpr std::uint64_t kHealthyEvery = 4;  // seeds (KindOf)
  const bool coarser = seed / kHealthyEvery % 2 == 0;
  return coarser ? RodMeshes{kCoarse, kFine} : RodMeshes{kFine, kCoarse};
}

std::filesystem::path WriteDiagnosedRod(std::uint64_t seed, robot::RobotDescription rod,
                                        const std::filesystem::path& folder) {
  if (MeshesOfRod(seed).diagnosed == kCoarse)
    rod.mesh.file = std::filesystem::path(PALPATE_SOURCE_DIR) / "config/scenarios" / kCoarse;
  const std::filesystem::path file = folder / "rod.yaml";
  robot::WriteRobotFile(rod, file);
  return file;
}

}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/rod_meshes.hpp"

#include <array>
#include <utility>

namespace palpate::blind {

namespace {

constexpr char kCoarse[] = "rod_coarse.msh";
constexpr char kFine[] = "rod.msh";

}  // namespace

RodMeshes MeshesOfRod(std::uint64_t seed) {
  const std::array<RodMeshes, 3> meshes = {RodMeshes{kCoarse, kFine}, RodMeshes{kFine, kCoarse},
                                           RodMeshes{kCoarse, kFine, fem::ElementType::kTet4}};
  return meshes.at(seed % meshes.size());
}

std::filesystem::path WriteDiagnosedRod(std::uint64_t seed, robot::RobotDescription rod,
                                        const std::filesystem::path& folder) {
  const RodMeshes meshes = MeshesOfRod(seed);
  rod.element = meshes.element;
  if (meshes.diagnosed == kCoarse)
    rod.mesh.file = std::filesystem::path(PALPATE_SOURCE_DIR) / "config/scenarios" / kCoarse;
  const std::filesystem::path file = folder / "rod.yaml";
  robot::WriteRobotFile(rod, file);
  return file;
}

}  // namespace palpate::blind

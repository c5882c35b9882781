// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem {

/// Values to colour or warp a mesh by, in SI units.
struct VtuField {
  std::string name;        ///< with its unit, e.g. "displacement_m"
  Eigen::MatrixXd values;  ///< [1 or 3 x number of nodes or of cells]
};

struct VtuFields {
  std::vector<VtuField> of_nodes;
  std::vector<VtuField> of_cells;
};

enum class VtuEncoding {
  kCompressed,  ///< inline base64, zlib
  kAscii,       ///< shortest decimals that read back as the same number
};

/// Writes a mesh with its nodes at `x_m` [3n, x y z interleaved] as VTK XML UnstructuredGrid for
/// ParaView: Float64, VTK types 10 (tet4) and 24 (tet10); nodes and cells keep their numbers.
/// Throws RunError naming the file where it cannot be written to its end (no such folder, full
/// disk); nothing half-written is left behind.
void WriteVtu(const std::filesystem::path& file, const TetMesh& mesh,
              const Eigen::Ref<const Eigen::VectorXd>& x_m, const VtuFields& fields = {},
              VtuEncoding encoding = VtuEncoding::kCompressed);

/// As WriteVtu, of polylines (VTK type 4): each [3 x n] points in order, m, n >= 2. Fields of nodes
/// are of the points of all lines, one after the other; those of cells are of the lines.
void WriteVtuLines(const std::filesystem::path& file, const std::vector<Eigen::Matrix3Xd>& lines_m,
                   const VtuFields& fields = {}, VtuEncoding encoding = VtuEncoding::kCompressed);

}  // namespace palpate::fem

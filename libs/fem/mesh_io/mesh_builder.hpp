// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem::mesh_io {

/// Collects what a reader finds and makes the TetMesh of it. Nodes come before cells.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file) : file_(std::move(file)) {}

  const std::string& file() const { return file_; }
  int64_t NodeCount() const { return static_cast<int64_t>(coordinates_.size() / 3); }

  /// A node, in the unit of the file. Throws InputError where there are too many for an int.
  void AddNode(double x, double y, double z);

  /// A cell of VTK type `vtk_type`, its node indices counted from 0 over all nodes added so far.
  /// Throws InputError where the type is refused, the count wrong, or an index out of range.
  void AddVtkCell(int64_t vtk_type, std::span<const int64_t> nodes);

  /// A tetrahedron in VTK's node order; `group` is an index into group_names or -1.
  void AddTet(ElementType type, std::span<const int64_t> nodes, int group);

  void SetGroupNames(std::vector<std::string> names) { group_names_ = std::move(names); }

  /// The mesh in metres. Throws InputError where there is no tetrahedron.
  TetMesh Finish(double metres_per_unit, std::vector<std::string>* notes) &&;

 private:
  [[noreturn]] void FailAtCell(const std::string& message) const;
  void CheckNodes(std::span<const int64_t> nodes) const;

  std::string file_;
  std::vector<double> coordinates_;  ///< x y z of each node, unit of the file
  std::vector<int> cells_;           ///< 4 or 10 indices for each tetrahedron
  std::vector<int> groups_;          ///< one for each tetrahedron
  std::vector<std::string> group_names_;
  int nodes_per_cell_ = 0;      ///< 0: no tetrahedron yet
  int64_t vtk_cells_seen_ = 0;  ///< of any type, for messages
};

}  // namespace palpate::fem::mesh_io

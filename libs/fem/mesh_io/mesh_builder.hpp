// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "libs/core/large_pages.hpp"
#include "libs/fem/mesh_io/node_group.hpp"
#include "libs/fem/tet_mesh.hpp"

namespace palpate::fem::mesh_io {

/// Collects what a reader finds and makes the TetMesh of it. Nodes come before cells.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file) : file_(std::move(file)) {}

  const std::string& file() const { return file_; }
  int64_t NodeCount() const { return static_cast<int64_t>(coordinates_.size() / 3); }

  /// Makes room for nodes and cells that the file surely holds.
  void ExpectNodes(int64_t count);
  void ExpectCells(int64_t cell_count, int64_t node_count);

  /// A node, in the unit of the file. Throws InputError where there are too many for an int.
  void AddNode(double x, double y, double z);

  /// A cell of VTK type `vtk_type`, its node indices counted from 0 over all nodes added so far.
  /// Throws InputError where the type is refused, the count wrong, or an index out of range.
  void AddVtkCell(int64_t vtk_type, std::span<const int64_t> nodes);
  int64_t VtkCellCount() const { return static_cast<int64_t>(tet_of_vtk_cell_.size()); }

  /// Values of the VTK cells from `first_cell` on. Where they are few whole numbers each of them
  /// becomes a group "name=value".
  void AddVtkCellData(const std::string& name, int64_t first_cell, std::span<const double> values);

  /// A tetrahedron in VTK's node order; returns its index.
  int AddTet(ElementType type, std::span<const int64_t> nodes);

  /// Tetrahedra of equal nodes are one, in all of their groups: a format writes an element once for
  /// each group.
  void MergeEqualTets() { merge_equal_tets_ = true; }

  /// Index of the group, which is made where it is not there.
  int GroupNamed(const std::string& name);
  void AddToGroup(int group, int tet) { groups_[static_cast<size_t>(group)].cells.push_back(tet); }

  /// Groups of points, lines and surfaces are dropped unless they are asked for before reading.
  void KeepNodeGroups() { keep_node_groups_ = true; }
  bool KeepsNodeGroups() const { return keep_node_groups_; }
  /// Index of the group of this dimension, which is made where it is not there.
  int NodeGroupNamed(const std::string& name, int dimension);
  void AddToNodeGroup(int group, std::span<const int64_t> nodes);
  /// Those with an element at least.
  std::vector<NodeGroup> TakeNodeGroups();

  /// The mesh in metres, its cells positively oriented where that is possible (see ReadMesh).
  /// Throws InputError where there is no tetrahedron.
  TetMesh Finish(double metres_per_unit, std::vector<std::string>* notes) &&;

 private:
  [[noreturn]] void FailAtCell(const std::string& message) const;
  void CheckNodes(std::span<const int64_t> nodes) const;
  void KeepOneOfEqualTets();
  std::vector<CellGroup> TakeGroups();

  std::string file_;
  LargeVector<double> coordinates_;  ///< x y z of each node, unit of the file
  LargeVector<int> cells_;           ///< 4 or 10 indices for each tetrahedron
  std::vector<CellGroup> groups_;
  std::map<std::string, int> group_of_name_;
  LargeVector<int> tet_of_vtk_cell_;  ///< -1: a cell of lower dimension
  int tet_count_ = 0;
  int nodes_per_cell_ = 0;  ///< 0: no tetrahedron yet
  bool merge_equal_tets_ = false;
  bool keep_node_groups_ = false;
  std::vector<NodeGroup> node_groups_;
};

}  // namespace palpate::fem::mesh_io

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/mesh_builder.hpp"

#include <Eigen/Geometry>
#include <limits>

#include "libs/core/error.hpp"
#include "libs/fem/mesh_io/cell_kinds.hpp"

namespace palpate::fem::mesh_io {

namespace {

/// Nodal vectors have 3n entries, numbered by int.
constexpr int64_t kMaxNodes = std::numeric_limits<int>::max() / 3;

double SixfoldVolume(const TetMesh& mesh, int cell) {
  const auto corner = [&](int k) -> Eigen::Vector3d {
    return mesh.nodes_m.col(mesh.cells(k, cell));
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0));
}

bool NoCellIsPositive(const TetMesh& mesh) {
  bool any_negative = false;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const double volume = SixfoldVolume(mesh, cell);
    if (volume > 0.0) return false;
    any_negative = any_negative || volume < 0.0;
  }
  return any_negative;
}

/// Exchanges corners 1 and 2, and with them the mid-edge nodes 01-02 and 13-23.
void TurnAllCells(TetMesh* mesh) {
  mesh->cells.row(1).swap(mesh->cells.row(2));
  if (mesh->element_type() == ElementType::kTet4) return;
  mesh->cells.row(4).swap(mesh->cells.row(6));
  mesh->cells.row(8).swap(mesh->cells.row(9));
}

}  // namespace

void MeshBuilder::AddNode(double x, double y, double z) {
  if (NodeCount() >= kMaxNodes) {
    throw InputError(file_ + ": more than " + std::to_string(kMaxNodes) + " nodes");
  }
  coordinates_.insert(coordinates_.end(), {x, y, z});
}

void MeshBuilder::AddVtkCell(int64_t vtk_type, std::span<const int64_t> nodes) {
  const CellKind kind = VtkCellKind(vtk_type);
  if (kind.role == CellRole::kRefused) {
    FailAtCell("cells of type " + std::to_string(vtk_type) + " (" + kind.name +
               ") are not read, only tetrahedra of 4 or 10 nodes");
  }
  if (kind.node_count > 0 && static_cast<size_t>(kind.node_count) != nodes.size()) {
    FailAtCell("has " + std::to_string(nodes.size()) + " nodes, a " + kind.name + " has " +
               std::to_string(kind.node_count));
  }
  if (kind.role == CellRole::kLowerDimension) {
    CheckNodes(nodes);
  } else {
    AddTet(kind.role == CellRole::kTet4 ? ElementType::kTet4 : ElementType::kTet10, nodes, -1);
  }
  ++vtk_cells_seen_;
}

void MeshBuilder::AddTet(ElementType type, std::span<const int64_t> nodes, int group) {
  const int count = static_cast<int>(type);
  if (nodes_per_cell_ != 0 && nodes_per_cell_ != count) {
    FailAtCell("tetrahedra of 4 and of 10 nodes are mixed");
  }
  CheckNodes(nodes);
  nodes_per_cell_ = count;
  for (const int64_t node : nodes) cells_.push_back(static_cast<int>(node));
  groups_.push_back(group);
}

void MeshBuilder::CheckNodes(std::span<const int64_t> nodes) const {
  for (const int64_t node : nodes) {
    if (node < 0 || node >= NodeCount()) {
      FailAtCell("node index " + std::to_string(node) + " is outside 0 to " +
                 std::to_string(NodeCount() - 1));
    }
  }
}

void MeshBuilder::FailAtCell(const std::string& message) const {
  const int64_t cell = vtk_cells_seen_ > 0 ? vtk_cells_seen_ : static_cast<int64_t>(groups_.size());
  throw InputError(file_ + ": cell " + std::to_string(cell) + ": " + message);
}

TetMesh MeshBuilder::Finish(double metres_per_unit, std::vector<std::string>* notes) && {
  if (groups_.empty()) throw InputError(file_ + ": holds no tetrahedron");
  const int64_t cell_count = static_cast<int64_t>(groups_.size());
  if (cell_count > kMaxNodes) throw InputError(file_ + ": too many cells");
  TetMesh mesh;
  mesh.nodes_m =
      metres_per_unit * Eigen::Map<const Eigen::Matrix3Xd>(coordinates_.data(), 3, NodeCount());
  if (!mesh.nodes_m.allFinite()) {
    throw InputError(file_ + ": a coordinate is not finite once it is in metres");
  }
  mesh.cells = Eigen::Map<const Eigen::MatrixXi>(cells_.data(), nodes_per_cell_, cell_count);
  if (!group_names_.empty()) {
    mesh.group_of_cell = std::move(groups_);
    mesh.group_names = std::move(group_names_);
  }
  if (NoCellIsPositive(mesh)) {
    TurnAllCells(&mesh);
    if (notes != nullptr) {
      notes->push_back(file_ + ": all cells are oriented the other way round and were turned");
    }
  }
  return mesh;
}

}  // namespace palpate::fem::mesh_io

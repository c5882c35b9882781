// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/mesh_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/large_pages.hpp"
#include "libs/fem/mesh_io/cell_kinds.hpp"
#include "libs/fem/mesh_io/orientation.hpp"

namespace palpate::fem::mesh_io {

namespace {

/// Nodal vectors have 3n entries, numbered by int.
constexpr int64_t kMaxNodes = std::numeric_limits<int>::max() / 3;

constexpr size_t kMostGroupsOfCellData = 64;
constexpr double kLargestGroupNumber = 1e9;

bool AreWholeNumbers(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) {
    return std::abs(value) <= kLargestGroupNumber && value == std::floor(value);
  });
}

}  // namespace

void MeshBuilder::ExpectNodes(int64_t count) {
  coordinates_.reserve(coordinates_.size() + 3 * static_cast<size_t>(count));
}

void MeshBuilder::ExpectCells(int64_t cell_count, int64_t node_count) {
  tet_of_vtk_cell_.reserve(tet_of_vtk_cell_.size() + static_cast<size_t>(cell_count));
  cells_.reserve(cells_.size() + static_cast<size_t>(node_count));
}

void MeshBuilder::AddNode(double x, double y, double z) {
  if (NodeCount() >= kMaxNodes) {
    throw InputError(file_ + ": more than " + std::to_string(kMaxNodes) + " nodes");
  }
  coordinates_.insert(coordinates_.end(), {x, y, z});
}

void MeshBuilder::AddVtkCell(int64_t vtk_type, std::span<const int64_t> nodes) {
  const CellKind kind = VtkCellKind(vtk_type, nodes.size());
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
    tet_of_vtk_cell_.push_back(-1);
  } else {
    const auto type = kind.role == CellRole::kTet4 ? ElementType::kTet4 : ElementType::kTet10;
    const int tet = AddTet(type, nodes);
    tet_of_vtk_cell_.push_back(tet);
  }
}

void MeshBuilder::AddVtkCellData(const std::string& name, int64_t first_cell,
                                 std::span<const double> values) {
  if (!AreWholeNumbers(values)) return;
  std::set<double> distinct;
  for (const double value : values) {
    distinct.insert(value);
    if (distinct.size() > kMostGroupsOfCellData) return;
  }
  std::map<double, int> group_of_value;
  for (const double value : distinct) {
    group_of_value[value] = GroupNamed(name + "=" + std::to_string(static_cast<int64_t>(value)));
  }
  for (size_t k = 0; k < values.size(); ++k) {
    const int tet = tet_of_vtk_cell_.at(static_cast<size_t>(first_cell) + k);
    if (tet >= 0) AddToGroup(group_of_value[values[k]], tet);
  }
}

int MeshBuilder::AddTet(ElementType type, std::span<const int64_t> nodes) {
  const int count = static_cast<int>(type);
  if (nodes_per_cell_ != 0 && nodes_per_cell_ != count) {
    FailAtCell("tetrahedra of 4 and of 10 nodes are mixed");
  }
  CheckNodes(nodes);
  if (tet_count_ >= kMaxNodes) throw InputError(file_ + ": too many cells");
  nodes_per_cell_ = count;
  for (const int64_t node : nodes) cells_.push_back(static_cast<int>(node));
  return tet_count_++;
}

int MeshBuilder::GroupNamed(const std::string& name) {
  const auto [entry, is_new] = group_of_name_.try_emplace(name, static_cast<int>(groups_.size()));
  if (is_new) groups_.push_back({.name = name, .cells = {}});
  return entry->second;
}

int MeshBuilder::NodeGroupNamed(const std::string& name, int dimension) {
  for (size_t k = 0; k < node_groups_.size(); ++k) {
    const NodeGroup& group = node_groups_[k];
    if (group.dimension == dimension && group.name == name) return static_cast<int>(k);
  }
  node_groups_.push_back({.name = name, .dimension = dimension, .elements = {}});
  return static_cast<int>(node_groups_.size()) - 1;
}

void MeshBuilder::AddToNodeGroup(int group, std::span<const int64_t> nodes) {
  CheckNodes(nodes);
  std::vector<int>& element = node_groups_[At(group)].elements.emplace_back();
  for (const int64_t node : nodes) element.push_back(static_cast<int>(node));
}

std::vector<NodeGroup> MeshBuilder::TakeNodeGroups() {
  std::erase_if(node_groups_, [](const NodeGroup& group) { return group.elements.empty(); });
  return std::move(node_groups_);
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
  const int64_t cell = tet_of_vtk_cell_.empty() ? tet_count_ : VtkCellCount();
  throw InputError(file_ + ": cell " + std::to_string(cell) + ": " + message);
}

void MeshBuilder::KeepOneOfEqualTets() {
  const auto size = static_cast<size_t>(nodes_per_cell_);
  std::vector<std::pair<std::array<int, 4>, int>> keyed;
  for (int tet = 0; tet < tet_count_; ++tet) {
    std::array<int, 4> corners{};
    std::copy_n(cells_.begin() + static_cast<std::ptrdiff_t>(size) * tet, 4, corners.begin());
    std::sort(corners.begin(), corners.end());
    keyed.emplace_back(corners, tet);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<int> first(keyed.size());  // of the tetrahedra with the same corners
  for (size_t k = 0; k < keyed.size(); ++k) {
    const bool same = k > 0 && keyed[k].first == keyed[k - 1].first;
    first[At(keyed[k].second)] = same ? first[At(keyed[k - 1].second)] : keyed[k].second;
  }
  std::vector<int> new_index(keyed.size());
  int kept = 0;
  for (int tet = 0; tet < tet_count_; ++tet) {
    if (first[At(tet)] != tet) {
      new_index[At(tet)] = new_index[At(first[At(tet)])];
      continue;
    }
    const auto from = cells_.begin() + static_cast<std::ptrdiff_t>(size) * tet;
    std::copy_n(from, size, cells_.begin() + static_cast<std::ptrdiff_t>(size) * kept);
    new_index[At(tet)] = kept++;
  }
  cells_.resize(size * static_cast<size_t>(kept));
  tet_count_ = kept;
  for (CellGroup& group : groups_) {
    for (int& cell : group.cells) cell = new_index[At(cell)];
  }
}

std::vector<CellGroup> MeshBuilder::TakeGroups() {
  std::erase_if(groups_, [](const CellGroup& group) { return group.cells.empty(); });
  for (CellGroup& group : groups_) {
    std::sort(group.cells.begin(), group.cells.end());
    group.cells.erase(std::unique(group.cells.begin(), group.cells.end()), group.cells.end());
  }
  return std::move(groups_);
}

TetMesh MeshBuilder::Finish(double metres_per_unit, std::vector<std::string>* notes) && {
  if (tet_count_ == 0)
    throw InputError(file_ + ": holds no tetrahedron: fill the surface with them (gmsh -3)");
  if (merge_equal_tets_ && groups_.size() > 1) KeepOneOfEqualTets();
  TetMesh mesh;
  mesh.nodes_m.resize(3, NodeCount());
  AdviseLargePages(mesh.nodes_m.data(), sizeof(double) * coordinates_.size());
  mesh.nodes_m =
      metres_per_unit * Eigen::Map<const Eigen::Matrix3Xd>(coordinates_.data(), 3, NodeCount());
  if (!mesh.nodes_m.allFinite()) {
    throw InputError(file_ + ": a coordinate is not finite once it is in metres");
  }
  mesh.cells.resize(nodes_per_cell_, tet_count_);
  AdviseLargePages(mesh.cells.data(), sizeof(int) * cells_.size());
  mesh.cells = Eigen::Map<const Eigen::MatrixXi>(cells_.data(), nodes_per_cell_, tet_count_);
  mesh.groups = TakeGroups();
  const std::string note = OrientCells(&mesh);
  if (!note.empty() && notes != nullptr) notes->push_back(file_ + ": " + note);
  return mesh;
}

}  // namespace palpate::fem::mesh_io

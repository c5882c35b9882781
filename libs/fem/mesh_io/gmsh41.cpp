// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdlib>

#include "libs/fem/mesh_io/cell_kinds.hpp"
#include "libs/fem/mesh_io/gmsh_reader.hpp"
#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem::mesh_io {

void GmshReader::ReadEntities41() {
  if (scanner_.binary()) scanner_.Line("the entities");
  const int64_t points = ReadSize("the number of points");
  const int64_t curves = ReadSize("the number of curves");
  const int64_t surfaces = ReadSize("the number of surfaces");
  const int64_t volumes = ReadSize("the number of volumes");
  for (int64_t k = 0; k < points; ++k) SkipEntity41(0);
  for (int64_t k = 0; k < curves; ++k) SkipEntity41(1);
  for (int64_t k = 0; k < surfaces; ++k) SkipEntity41(2);
  for (int64_t k = 0; k < volumes; ++k) ReadVolumeEntity41();
}

void GmshReader::SkipEntity41(int dimension) {
  ReadInt("an entity tag");
  ReadPosition(0);                     // of a point, or one corner of the bounding box
  if (dimension > 0) ReadPosition(0);  // the other corner
  ReadPhysicalTag41();
  if (dimension == 0) return;
  const int64_t bounding = ReadSize("the number of bounding entities");
  for (int64_t k = 0; k < bounding; ++k) ReadInt("a bounding entity");
}

void GmshReader::ReadVolumeEntity41() {
  const int64_t tag = ReadInt("an entity tag");
  ReadPosition(0);
  ReadPosition(0);
  physical_of_volume_[tag] = ReadPhysicalTag41();
  const int64_t bounding = ReadSize("the number of bounding entities");
  for (int64_t k = 0; k < bounding; ++k) ReadInt("a bounding entity");
}

/// The first physical group of an entity, 0 where it has none.
int64_t GmshReader::ReadPhysicalTag41() {
  const int64_t count = ReadSize("the number of physical tags");
  int64_t first = 0;
  for (int64_t k = 0; k < count; ++k) {
    const int64_t tag = ReadInt("a physical tag");
    if (k == 0) first = std::abs(tag);
  }
  return first;
}

void GmshReader::ReadNodes41() {
  if (scanner_.binary()) scanner_.Line("the nodes");
  const int64_t blocks = ReadSize("the number of node blocks");
  const int64_t count = ReadSize("the number of nodes");
  ReadSize("the least node tag");
  ReadSize("the greatest node tag");
  CheckRoom(count, 3 * sizeof(double), "nodes");
  for (int64_t block = 0; block < blocks; ++block) {
    ReadNodeBlock41(count - static_cast<int64_t>(nodes_.size()));
  }
  if (static_cast<int64_t>(nodes_.size()) != count) {
    scanner_.Fail("the blocks hold " + std::to_string(nodes_.size()) + " nodes instead of " +
                  std::to_string(count));
  }
}

/// All tags of the block, then all positions, each with its parameters on the entity.
void GmshReader::ReadNodeBlock41(int64_t at_most) {
  const int64_t dimension = scanner_.Integer(ScalarType::kInt32, 0, 3, "a dimension");
  ReadInt("an entity tag");
  const bool parametric = scanner_.Integer(ScalarType::kInt32, 0, 1, "the parametric flag") == 1;
  const int64_t count = scanner_.Integer(size_type_, 0, at_most, "the nodes of a block");
  const size_t first = nodes_.size();
  for (int64_t k = 0; k < count; ++k) {
    nodes_.push_back({scanner_.Integer(size_type_, 1, kMaxTag, "a node tag"), {}});
  }
  for (size_t k = first; k < nodes_.size(); ++k) {
    nodes_[k] = ReadPosition(nodes_[k].tag);
    for (int64_t p = 0; parametric && p < dimension; ++p) {
      scanner_.Real(ScalarType::kFloat64, "a parameter of a node");
    }
  }
}

void GmshReader::ReadElements41() {
  if (scanner_.binary()) scanner_.Line("the elements");
  const int64_t blocks = ReadSize("the number of element blocks");
  const int64_t count = ReadSize("the number of elements");
  ReadSize("the least element tag");
  ReadSize("the greatest element tag");
  int64_t left = count;
  for (int64_t block = 0; block < blocks; ++block) left -= ReadElementBlock41(left);
  if (left != 0) scanner_.Fail("the blocks hold fewer elements than $Elements says");
}

int64_t GmshReader::ReadElementBlock41(int64_t at_most) {
  constexpr int64_t kVolume = 3;
  const int64_t dimension = scanner_.Integer(ScalarType::kInt32, 0, 3, "a dimension");
  const int64_t entity = ReadInt("an entity tag");
  const int64_t type = ReadInt("an element type");
  const int64_t nodes_each = NodeCountOf(type);
  const bool is_tet = GmshCellKind(type).role != CellRole::kLowerDimension;
  if (is_tet != (dimension == kVolume)) {
    scanner_.Fail("element type " + std::to_string(type) + " does not fit dimension " +
                  std::to_string(dimension));
  }
  const int64_t count = scanner_.Integer(size_type_, 0, at_most, "the elements of a block");
  CheckRoom(count, static_cast<size_t>(nodes_each + 1) * SizeInBytes(size_type_), "elements");
  const auto physical = physical_of_volume_.find(entity);
  const int group =
      is_tet && physical != physical_of_volume_.end() ? GroupOf(physical->second) : -1;
  for (int64_t k = 0; k < count; ++k) {
    scanner_.Integer(size_type_, 0, kMaxTag, "an element tag");
    ReadElement(type, size_type_, group);
  }
  return count;
}

}  // namespace palpate::fem::mesh_io

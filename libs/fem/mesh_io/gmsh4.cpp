// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdlib>

#include "libs/fem/mesh_io/cell_kinds.hpp"
#include "libs/fem/mesh_io/gmsh_reader.hpp"
#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem::mesh_io {

void GmshReader::ReadEntities4() {
  BeginNumbers("the entities");
  std::array<int64_t, 4> counts{};
  for (int64_t& count : counts) count = ReadSize("the number of entities");
  for (int dimension = 0; dimension <= kVolume; ++dimension) {
    for (int64_t k = 0; k < counts[static_cast<size_t>(dimension)]; ++k) ReadEntity4(dimension);
  }
}

void GmshReader::ReadEntity4(int dimension) {
  const int64_t tag = ReadInt("an entity tag");
  SkipBounds4(dimension);
  Groups groups = ReadPhysicalTags4(dimension);
  groups_of_entity_[{dimension, tag}] = std::move(groups);
  if (dimension == 0) return;
  const int64_t bounding = ReadSize("the number of bounding entities");
  for (int64_t k = 0; k < bounding; ++k) ReadInt("a bounding entity");
}

/// The pieces that a partition cuts the entities into; elements name these.
void GmshReader::ReadPartitionedEntities4() {
  BeginNumbers("the partitioned entities");
  ReadSize("the number of partitions");
  const int64_t ghosts = ReadSize("the number of ghost entities");
  for (int64_t k = 0; k < ghosts; ++k) {
    ReadInt("a ghost entity");
    ReadInt("a partition");
  }
  std::array<int64_t, 4> counts{};
  for (int64_t& count : counts) count = ReadSize("the number of partitioned entities");
  for (int dimension = 0; dimension <= kVolume; ++dimension) {
    for (int64_t k = 0; k < counts[static_cast<size_t>(dimension)]; ++k) {
      ReadPartitionedEntity4(dimension);
    }
  }
}

void GmshReader::ReadPartitionedEntity4(int dimension) {
  const int64_t tag = ReadInt("an entity tag");
  const int64_t parent_dimension = ReadInt("the dimension of a parent entity");
  const int64_t parent = ReadInt("the tag of a parent entity");
  const int64_t partitions = ReadSize("the number of partitions");
  for (int64_t k = 0; k < partitions; ++k) ReadInt("a partition");
  SkipBounds4(dimension);
  Groups groups = ReadPhysicalTags4(dimension);
  const auto of_parent = groups_of_entity_.find({dimension, parent});
  const bool inherits = groups.empty() && parent_dimension == dimension;
  if (inherits && of_parent != groups_of_entity_.end()) groups = of_parent->second;
  groups_of_entity_[{dimension, tag}] = std::move(groups);
  if (dimension == 0) return;
  const int64_t bounding = ReadSize("the number of bounding entities");
  for (int64_t k = 0; k < bounding; ++k) ReadInt("a bounding entity");
}

/// Two corners of a box; of a point in 4.1 its position.
void GmshReader::SkipBounds4(int dimension) {
  ReadPosition(0);
  if (dimension > 0 || version_ == Version::k40) ReadPosition(0);
}

GmshReader::Groups GmshReader::ReadPhysicalTags4(int dimension) {
  const int64_t count = ReadSize("the number of physical tags");
  Groups groups;
  for (int64_t k = 0; k < count; ++k) {
    const int64_t tag = std::abs(ReadInt("a physical tag"));
    if (tag != 0 && KeepsGroupsOf(dimension)) groups.push_back(GroupOf(dimension, tag));
  }
  return groups;
}

void GmshReader::ReadNodes4() {
  BeginNumbers("the nodes");
  const int64_t blocks = ReadSize("the number of node blocks");
  const int64_t count = ReadSize("the number of nodes");
  if (version_ == Version::k41) {
    ReadSize("the least node tag");
    ReadSize("the greatest node tag");
  }
  CheckRoom(count, 3 * sizeof(double), "nodes");
  for (int64_t block = 0; block < blocks; ++block) {
    ReadNodeBlock4(count - static_cast<int64_t>(nodes_.size()));
  }
  if (static_cast<int64_t>(nodes_.size()) != count) {
    scanner_.Fail("the blocks hold " + std::to_string(nodes_.size()) + " nodes instead of " +
                  std::to_string(count));
  }
}

/// In 4.1 all tags of the block, then all positions; in 4.0 each tag with its position. Positions
/// have their parameters on the entity behind them.
void GmshReader::ReadNodeBlock4(int64_t at_most) {
  const bool tags_first = version_ == Version::k41;
  if (!tags_first) ReadInt("an entity tag");
  const int64_t dimension = scanner_.Integer(ScalarType::kInt32, 0, 3, "a dimension");
  if (tags_first) ReadInt("an entity tag");
  const bool parametric = scanner_.Integer(ScalarType::kInt32, 0, 1, "the parametric flag") == 1;
  const int64_t count = scanner_.Integer(size_type_, 0, at_most, "the nodes of a block");
  const size_t first = nodes_.size();
  for (int64_t k = 0; tags_first && k < count; ++k) {
    nodes_.push_back({scanner_.Integer(tag_type_, 1, kMaxTag, "a node tag"), {}});
  }
  const int64_t parameters = parametric ? dimension : 0;
  for (size_t k = first; k < first + static_cast<size_t>(count); ++k) {
    if (!tags_first) nodes_.push_back({scanner_.Integer(tag_type_, 1, kMaxTag, "a node tag"), {}});
    nodes_[k] = ReadPosition(nodes_[k].tag);
    for (int64_t p = 0; p < parameters; ++p) {
      scanner_.Real(ScalarType::kFloat64, "a parameter of a node");
    }
  }
}

void GmshReader::ReadElements4() {
  BeginNumbers("the elements");
  const int64_t blocks = ReadSize("the number of element blocks");
  const int64_t count = ReadSize("the number of elements");
  if (version_ == Version::k41) {
    ReadSize("the least element tag");
    ReadSize("the greatest element tag");
  }
  int64_t left = count;
  for (int64_t block = 0; block < blocks; ++block) left -= ReadElementBlock4(left);
  if (left != 0) scanner_.Fail("the blocks hold fewer elements than $Elements says");
}

int64_t GmshReader::ReadElementBlock4(int64_t at_most) {
  int64_t entity = version_ == Version::k40 ? ReadInt("an entity tag") : 0;
  const int64_t dimension = scanner_.Integer(ScalarType::kInt32, 0, 3, "a dimension");
  if (version_ == Version::k41) entity = ReadInt("an entity tag");
  const int64_t type = ReadInt("an element type");
  const int64_t nodes_each = NodeCountOf(type);
  const bool is_tet = GmshCellKind(type).role != CellRole::kLowerDimension;
  if (is_tet != (dimension == kVolume)) {
    scanner_.Fail("element type " + std::to_string(type) + " does not fit dimension " +
                  std::to_string(dimension));
  }
  const int64_t count = scanner_.Integer(size_type_, 0, at_most, "the elements of a block");
  CheckRoom(count, static_cast<size_t>(nodes_each + 1) * SizeInBytes(tag_type_), "elements");
  const auto found = groups_of_entity_.find({dimension, entity});
  const Groups groups = found == groups_of_entity_.end() ? Groups{} : found->second;
  for (int64_t k = 0; k < count; ++k) {
    scanner_.Integer(tag_type_, 0, kMaxTag, "an element tag");
    ReadElement(type, tag_type_, groups);
  }
  return count;
}

}  // namespace palpate::fem::mesh_io

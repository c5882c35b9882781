// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdlib>

#include "libs/fem/mesh_io/cell_kinds.hpp"
#include "libs/fem/mesh_io/gmsh_reader.hpp"
#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem::mesh_io {

/// $ParametricNodes (-save_parametric) have behind the position the entity that they lie on, and
/// their parameters on a curve or a surface.
void GmshReader::ReadNodes2(bool parametric) {
  const int64_t count = scanner_.TextInteger(0, kMaxCount, "the number of nodes");
  scanner_.Line("the nodes");
  CheckRoom(count, sizeof(int32_t) + 3 * sizeof(double), "nodes");
  for (int64_t k = 0; k < count; ++k) {
    nodes_.push_back(ReadPosition(scanner_.Integer(tag_type_, 1, kMaxCount, "a node tag")));
    if (!parametric) continue;
    const int64_t dimension = scanner_.Integer(ScalarType::kInt32, 0, 3, "a dimension");
    ReadInt("an entity tag");
    for (int64_t p = 0; dimension < 3 && p < dimension; ++p) {
      scanner_.Real(ScalarType::kFloat64, "a parameter of a node");
    }
  }
}

/// An element stands there once for each physical group that holds it.
void GmshReader::ReadElements2() {
  builder_->MergeEqualTets();
  const int64_t count = scanner_.TextInteger(0, kMaxCount, "the number of elements");
  scanner_.Line("the elements");
  for (int64_t left = count; left > 0;) left -= ReadElementBlock2(left);
}

/// In binary files elements of one type and number of tags follow one header; in text each has its
/// own, behind its tag. Returns how many were read.
int64_t GmshReader::ReadElementBlock2(int64_t at_most) {
  constexpr int64_t kMostTags = 1000;
  if (!scanner_.binary()) ReadInt("an element tag");
  const int64_t type = ReadInt("an element type");
  NodeCountOf(type);
  const int64_t count = scanner_.binary() ? scanner_.Integer(ScalarType::kInt32, 1, at_most,
                                                             "the elements of a block")
                                          : 1;
  const int64_t tag_count =
      scanner_.Integer(ScalarType::kInt32, 0, kMostTags, "the number of tags");
  const int dimension = GmshCellKind(type).dimension;
  for (int64_t element = 0; element < count; ++element) {
    if (scanner_.binary()) ReadInt("an element tag");
    int64_t physical_tag = 0;
    for (int64_t k = 0; k < tag_count; ++k) {
      const int64_t tag = ReadInt("a tag of an element");
      if (k == 0) physical_tag = std::abs(tag);
    }
    const bool in_group = physical_tag != 0 && KeepsGroupsOf(dimension);
    ReadElement(type, tag_type_, in_group ? Groups{GroupOf(dimension, physical_tag)} : Groups{});
  }
  return count;
}

}  // namespace palpate::fem::mesh_io

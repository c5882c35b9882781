// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "libs/fem/mesh_io/mesh_builder.hpp"
#include "libs/fem/mesh_io/scanner.hpp"

namespace palpate::fem::mesh_io {

/// What the sections of a .msh file pass on to each other, and what both versions share.
/// Format: Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2".
class GmshReader {
 public:
  GmshReader(std::string_view bytes, MeshBuilder* builder)
      : scanner_(builder->file(), bytes), builder_(builder) {}

  void Read();

 private:
  struct Node {
    int64_t tag = 0;
    std::array<double, 3> position{};
  };

  void ReadFormat();
  void ReadSection(std::string_view name);
  void ReadPhysicalNames();

  void ReadNodes22();
  void ReadElements22();
  int64_t ReadElementBlock22(int64_t at_most);

  void ReadEntities41();
  void ReadVolumeEntity41();
  void SkipEntity41(int dimension);
  int64_t ReadPhysicalTag41();
  void ReadNodes41();
  void ReadNodeBlock41(int64_t at_most);
  void ReadElements41();
  int64_t ReadElementBlock41(int64_t at_most);

  Node ReadPosition(int64_t tag);
  /// Numbers the nodes read so far by rising tag and hands them to the builder.
  void FinishNodes();
  int64_t NodeOfTag(int64_t tag) const;
  /// Reads as many node tags as `type` has and adds the element, if it is a tetrahedron.
  void ReadElement(int64_t type, ScalarType tag_type, int group);
  /// Throws where the element type is refused; else its number of nodes.
  int NodeCountOf(int64_t type);
  /// Index of a physical volume among the groups, -1 for tag 0.
  int GroupOf(int64_t physical_tag);

  int64_t ReadSize(const char* what);
  int64_t ReadInt(const char* what);
  void CheckRoom(int64_t count, size_t least_binary_bytes, const char* what);

  Scanner scanner_;
  MeshBuilder* builder_;
  bool version_41_ = false;
  ScalarType size_type_ = ScalarType::kUInt64;  ///< of size_t in 4.1

  std::vector<Node> nodes_;
  std::vector<int64_t> tags_;  ///< of the nodes, rising
  bool nodes_read_ = false;
  bool elements_read_ = false;

  std::map<int64_t, std::string> volume_names_;    ///< by physical tag
  std::map<int64_t, int64_t> physical_of_volume_;  ///< 4.1: entity tag -> physical tag or 0
  std::map<int64_t, int> group_of_physical_;
  std::vector<std::string> group_names_;
};

}  // namespace palpate::fem::mesh_io

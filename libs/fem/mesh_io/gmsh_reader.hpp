// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "libs/fem/mesh_io/mesh_builder.hpp"
#include "libs/fem/mesh_io/scanner.hpp"

namespace palpate::fem::mesh_io {

/// What the sections of a .msh file pass on to each other, and what its versions share.
/// Format: Gmsh reference manual, "MSH file format" (4.1, 4.0 in that of Gmsh 4.0) and "MSH file
/// format version 2" (2.0 to 2.2).
class GmshReader {
 public:
  GmshReader(std::string_view bytes, MeshBuilder* builder)
      : scanner_(builder->file(), bytes), builder_(builder) {}

  void Read();

 private:
  enum class Version { k2, k40, k41 };
  static constexpr int kVolume = 3;
  /// Indices of the builder's groups; of points, lines and surfaces of its node groups.
  using Groups = std::vector<int>;

  struct Node {
    int64_t tag = 0;
    std::array<double, 3> position{};
  };

  void ReadFormat();
  Version ReadVersion();
  void ReadSection(std::string_view name);
  void ReadPhysicalNames();

  void ReadNodes2(bool parametric);
  void ReadElements2();
  int64_t ReadElementBlock2(int64_t at_most);

  void ReadEntities4();
  void ReadEntity4(int dimension);
  void ReadPartitionedEntities4();
  void ReadPartitionedEntity4(int dimension);
  void SkipBounds4(int dimension);
  Groups ReadPhysicalTags4(int dimension);
  void ReadNodes4();
  void ReadNodeBlock4(int64_t at_most);
  void ReadElements4();
  int64_t ReadElementBlock4(int64_t at_most);

  Node ReadPosition(int64_t tag);
  /// Numbers the nodes read so far by rising tag and hands them to the builder.
  void FinishNodes();
  int64_t NodeOfTag(int64_t tag) const;
  /// Reads as many node tags as `type` has and adds the element, if it is a tetrahedron.
  void ReadElement(int64_t type, ScalarType tag_type, const Groups& groups);
  /// Throws where the element type is refused; else its number of nodes.
  int NodeCountOf(int64_t type);
  /// The group of physical entities of this dimension, by its name where it has one.
  int GroupOf(int dimension, int64_t physical_tag);
  bool KeepsGroupsOf(int dimension) const;

  int64_t ReadSize(const char* what);
  int64_t ReadInt(const char* what);
  /// Where binary numbers begin after a line of text.
  void BeginNumbers(const char* what);
  void CheckRoom(int64_t count, size_t least_binary_bytes, const char* what);

  Scanner scanner_;
  MeshBuilder* builder_;
  Version version_ = Version::k2;
  ScalarType size_type_ = ScalarType::kUInt64;  ///< of size_t in 4.1
  ScalarType tag_type_ = ScalarType::kInt32;    ///< of nodes and elements

  std::vector<Node> nodes_;
  std::vector<int64_t> tags_;  ///< of the nodes, rising
  bool nodes_read_ = false;
  bool elements_read_ = false;

  using Entity = std::pair<int64_t, int64_t>;  ///< dimension and tag
  std::map<Entity, std::string> names_;        ///< of physical tags
  std::map<Entity, Groups> groups_of_entity_;  ///< 4: by entity tag
};

}  // namespace palpate::fem::mesh_io

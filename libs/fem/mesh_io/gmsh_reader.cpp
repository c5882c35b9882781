// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/gmsh_reader.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <sstream>

#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/cell_kinds.hpp"
#include "libs/fem/mesh_io/formats.hpp"
#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem::mesh_io {

void GmshReader::Read() {
  ReadFormat();
  for (auto mark = scanner_.TokenOrEnd(); !mark.empty(); mark = scanner_.TokenOrEnd()) {
    if (mark.size() < 2 || mark.front() != '$') scanner_.Fail("expected a section ($...)");
    ReadSection(mark.substr(1));
  }
  if (!nodes_read_ || !elements_read_) {
    scanner_.Fail(std::string("there is no section ") + (nodes_read_ ? "$Elements" : "$Nodes"));
  }
}

void GmshReader::ReadFormat() {
  std::string_view first = scanner_.Token("$MeshFormat");
  while (first == "$Comments") {
    scanner_.SkipPast("$EndComments");
    first = scanner_.Token("$MeshFormat");
  }
  if (first == "$NOD")
    scanner_.Fail("Gmsh format 1 is not read: gmsh -save -format msh41 writes 4.1");
  if (first != "$MeshFormat") {
    scanner_.Fail("is no Gmsh file: it must begin with $MeshFormat");
  }
  version_ = ReadVersion();
  const bool binary = scanner_.TextInteger(0, 1, "the file type") == 1;
  const int64_t size = scanner_.TextInteger(4, 8, "the data size");
  if (size != 8 && !(version_ == Version::k41 && size == 4)) scanner_.Fail("data size must be 8");
  size_type_ = size == 8 ? ScalarType::kUInt64 : ScalarType::kUInt32;
  if (version_ == Version::k41) tag_type_ = size_type_;
  if (binary) {
    scanner_.Line("the byte order");
    int one = 0;
    std::memcpy(&one, scanner_.Bytes(sizeof(one), "the byte order").data(), sizeof(one));
    if (one != 1 && one != 1 << 24) scanner_.Fail("the byte order mark is neither 1 nor 1 swapped");
    scanner_.SetBinary(one != 1);
  }
  if (scanner_.Token("$EndMeshFormat") != "$EndMeshFormat")
    scanner_.Fail("expected $EndMeshFormat");
}

/// Netgen writes 2.2 as "2.000000", Gmsh 4.0 as "4".
GmshReader::Version GmshReader::ReadVersion() {
  const std::string_view version = scanner_.Token("the version");
  double number = 0.0;
  if (ParseFinite(version, &number)) {
    if (number >= 2.0 && number < 3.0) return Version::k2;
    if (number == 4.0) return Version::k40;
    if (number == 4.1) return Version::k41;
  }
  scanner_.Fail("Gmsh format '" + Excerpt(version) + "' is not read (only 2.0 to 2.2, 4.0, 4.1)");
}

void GmshReader::ReadSection(std::string_view name) {
  const std::string end = "$End" + std::string(name);
  if (name == "PhysicalNames") {
    ReadPhysicalNames();
  } else if (name == "Entities" && version_ != Version::k2) {
    ReadEntities4();
  } else if (name == "PartitionedEntities" && version_ != Version::k2) {
    ReadPartitionedEntities4();
  } else if (name == "Nodes" || (name == "ParametricNodes" && version_ == Version::k2)) {
    if (nodes_read_) scanner_.Fail("a second section $Nodes");
    version_ == Version::k2 ? ReadNodes2(name != "Nodes") : ReadNodes4();
    FinishNodes();
  } else if (name == "Elements") {
    if (elements_read_ || !nodes_read_) scanner_.Fail("$Elements must follow $Nodes, once");
    version_ == Version::k2 ? ReadElements2() : ReadElements4();
    elements_read_ = true;
  } else {
    scanner_.SkipPast(end);
    return;
  }
  if (scanner_.Token(end.c_str()) != end) scanner_.Fail("expected " + end);
}

void GmshReader::ReadPhysicalNames() {
  const int64_t count = scanner_.TextInteger(0, kMaxCount, "the number of physical names");
  scanner_.Line("the physical names");
  for (int64_t k = 0; k < count; ++k) {
    const std::string_view line = scanner_.Line("a physical name");
    const size_t open = line.find('"');
    const size_t close = line.rfind('"');
    if (open == std::string_view::npos || close == open) scanner_.Fail("a name stands in quotes");
    // [dimension] tag "name"; the dimension is missing before 2.1.
    int64_t dimension = kVolume, tag = 0;
    std::istringstream numbers{std::string(line.substr(0, open))};
    std::vector<int64_t> values{std::istream_iterator<int64_t>(numbers), {}};
    if (values.empty() || values.size() > 2) scanner_.Fail("expected a dimension and a tag");
    if (values.size() == 2) dimension = values.front();
    tag = values.back();
    if (tag < 1 || tag > kMaxCount) scanner_.Fail("a physical tag must be 1 or more");
    names_[{dimension, tag}] = line.substr(open + 1, close - open - 1);
  }
}

GmshReader::Node GmshReader::ReadPosition(int64_t tag) {
  Node node{tag, {}};
  for (double& coordinate : node.position) {
    coordinate = scanner_.Real(ScalarType::kFloat64, "a coordinate");
  }
  return node;
}

void GmshReader::FinishNodes() {
  std::sort(nodes_.begin(), nodes_.end(),
            [](const Node& a, const Node& b) { return a.tag < b.tag; });
  for (const Node& node : nodes_) {
    if (!tags_.empty() && tags_.back() == node.tag) {
      scanner_.Fail("node tag " + std::to_string(node.tag) + " is given twice");
    }
    tags_.push_back(node.tag);
    builder_->AddNode(node.position[0], node.position[1], node.position[2]);
  }
  nodes_.clear();
  nodes_read_ = true;
}

int64_t GmshReader::NodeOfTag(int64_t tag) const {
  const auto found = std::lower_bound(tags_.begin(), tags_.end(), tag);
  if (found == tags_.end() || *found != tag) {
    scanner_.Fail("an element names node " + std::to_string(tag) + ", which does not exist");
  }
  return found - tags_.begin();
}

int GmshReader::NodeCountOf(int64_t type) {
  const CellKind kind = GmshCellKind(type);
  if (kind.role == CellRole::kRefused) {
    scanner_.Fail("elements of type " + std::to_string(type) + " (" + kind.name +
                  ") are not read, only tetrahedra of 4 or 10 nodes");
  }
  return kind.node_count;
}

void GmshReader::ReadElement(int64_t type, ScalarType tag_type, const Groups& groups) {
  std::array<int64_t, 32> nodes{};
  const CellKind kind = GmshCellKind(type);
  const auto count = static_cast<size_t>(kind.node_count);
  for (size_t k = 0; k < count; ++k) {
    nodes[k] = NodeOfTag(scanner_.Integer(tag_type, 1, kMaxTag, "a node tag"));
  }
  if (kind.role == CellRole::kLowerDimension) {
    for (const int group : groups) builder_->AddToNodeGroup(group, std::span(nodes).first(count));
    return;
  }
  // Gmsh: ... 23 13; VTK: ... 13 23.
  if (kind.role == CellRole::kTet10) std::swap(nodes[8], nodes[9]);
  const auto element = kind.role == CellRole::kTet4 ? ElementType::kTet4 : ElementType::kTet10;
  const int tet = builder_->AddTet(element, std::span(nodes).first(count));
  for (const int group : groups) builder_->AddToGroup(group, tet);
}

int GmshReader::GroupOf(int dimension, int64_t physical_tag) {
  const auto found = names_.find({dimension, physical_tag});
  const std::string name = found == names_.end() ? std::to_string(physical_tag) : found->second;
  return dimension == kVolume ? builder_->GroupNamed(name)
                              : builder_->NodeGroupNamed(name, dimension);
}

bool GmshReader::KeepsGroupsOf(int dimension) const {
  return dimension == kVolume || builder_->KeepsNodeGroups();
}

int64_t GmshReader::ReadSize(const char* what) {
  return scanner_.Integer(size_type_, 0, kMaxTag, what);
}

int64_t GmshReader::ReadInt(const char* what) {
  return scanner_.Integer(ScalarType::kInt32, -kMaxCount, kMaxCount, what);
}

void GmshReader::BeginNumbers(const char* what) {
  if (scanner_.binary()) scanner_.Line(what);
}

void GmshReader::CheckRoom(int64_t count, size_t least_binary_bytes, const char* what) {
  scanner_.CheckRoom(count, scanner_.binary() ? least_binary_bytes : 2, what);
}

void ReadGmsh(std::string_view bytes, MeshBuilder* builder) { GmshReader(bytes, builder).Read(); }

}  // namespace palpate::fem::mesh_io

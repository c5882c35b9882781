// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/gmsh_reader.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

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
  builder_->SetGroupNames(std::move(group_names_));
}

void GmshReader::ReadFormat() {
  if (scanner_.Token("$MeshFormat") != "$MeshFormat") {
    scanner_.Fail("is no Gmsh file: it must begin with $MeshFormat");
  }
  const std::string_view version = scanner_.Token("the version");
  if (version != "2.2" && version != "4.1") {
    scanner_.Fail("Gmsh format '" + std::string(version) + "' is not read (only 2.2 and 4.1)");
  }
  version_41_ = version == "4.1";
  const bool binary = scanner_.TextInteger(0, 1, "the file type") == 1;
  const int64_t size = scanner_.TextInteger(4, 8, "the data size");
  if (size != 8 && !(version_41_ && size == 4)) scanner_.Fail("data size must be 8");
  size_type_ = size == 8 ? ScalarType::kUInt64 : ScalarType::kUInt32;
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

void GmshReader::ReadSection(std::string_view name) {
  const std::string end = "$End" + std::string(name);
  if (name == "PhysicalNames") {
    ReadPhysicalNames();
  } else if (name == "Entities" && version_41_) {
    ReadEntities41();
  } else if (name == "PartitionedEntities") {
    scanner_.Fail("a mesh in partitions is not read: save it in one piece");
  } else if (name == "Nodes") {
    if (nodes_read_) scanner_.Fail("a second section $Nodes");
    version_41_ ? ReadNodes41() : ReadNodes22();
    FinishNodes();
  } else if (name == "Elements") {
    if (elements_read_ || !nodes_read_) scanner_.Fail("$Elements must follow $Nodes, once");
    version_41_ ? ReadElements41() : ReadElements22();
    elements_read_ = true;
  } else {
    scanner_.SkipPast(end);
    return;
  }
  if (scanner_.Token(end.c_str()) != end) scanner_.Fail("expected " + end);
}

void GmshReader::ReadPhysicalNames() {
  constexpr int64_t kVolume = 3;
  const int64_t count = scanner_.TextInteger(0, kMaxCount, "the number of physical names");
  for (int64_t k = 0; k < count; ++k) {
    const int64_t dimension = scanner_.TextInteger(0, 3, "a dimension");
    const int64_t tag = scanner_.TextInteger(1, kMaxCount, "a physical tag");
    const std::string_view rest = scanner_.Line("a physical name");
    const size_t open = rest.find('"');
    const size_t close = rest.rfind('"');
    if (open == std::string_view::npos || close == open) scanner_.Fail("a name stands in quotes");
    if (dimension == kVolume) volume_names_[tag] = rest.substr(open + 1, close - open - 1);
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

void GmshReader::ReadElement(int64_t type, ScalarType tag_type, int group) {
  std::array<int64_t, 32> nodes{};
  const CellKind kind = GmshCellKind(type);
  const auto count = static_cast<size_t>(kind.node_count);
  for (size_t k = 0; k < count; ++k) {
    nodes[k] = NodeOfTag(scanner_.Integer(tag_type, 1, kMaxTag, "a node tag"));
  }
  if (kind.role == CellRole::kLowerDimension) return;
  // Gmsh: ... 23 13; VTK: ... 13 23.
  if (kind.role == CellRole::kTet10) std::swap(nodes[8], nodes[9]);
  builder_->AddTet(kind.role == CellRole::kTet4 ? ElementType::kTet4 : ElementType::kTet10,
                   std::span(nodes).first(count), group);
}

int GmshReader::GroupOf(int64_t physical_tag) {
  if (physical_tag == 0) return -1;
  const auto [entry, is_new] =
      group_of_physical_.try_emplace(physical_tag, static_cast<int>(group_names_.size()));
  if (is_new) {
    const auto name = volume_names_.find(physical_tag);
    group_names_.push_back(name == volume_names_.end() ? std::to_string(physical_tag)
                                                       : name->second);
  }
  return entry->second;
}

int64_t GmshReader::ReadSize(const char* what) {
  return scanner_.Integer(size_type_, 0, kMaxTag, what);
}

int64_t GmshReader::ReadInt(const char* what) {
  return scanner_.Integer(ScalarType::kInt32, -kMaxCount, kMaxCount, what);
}

void GmshReader::CheckRoom(int64_t count, size_t least_binary_bytes, const char* what) {
  scanner_.CheckRoom(count, scanner_.binary() ? least_binary_bytes : 2, what);
}

void ReadGmsh(std::string_view bytes, MeshBuilder* builder) { GmshReader(bytes, builder).Read(); }

}  // namespace palpate::fem::mesh_io

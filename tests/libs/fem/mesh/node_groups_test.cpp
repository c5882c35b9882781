// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "libs/fem/mesh_io/read_mesh.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::fem {
namespace {

using testing::ElementsAre;

/// One tetrahedron of Gmsh 4.1 with a named face, edge and corner, and a face without a group.
constexpr const char* kGmsh41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
4
0 5 "cable_1"
1 6 "tendon"
2 7 "fixed"
3 8 "body"
$EndPhysicalNames
$Entities
1 1 2 1
1 0 0 0 1 5
1 0 0 0 1 0 0 1 6 0
1 0 0 0 1 1 0 1 7 0
2 0 0 0 1 1 1 0 0
1 0 0 0 1 1 1 1 8 0
$EndEntities
$Nodes
1 4 1 4
3 1 0 4
1
2
3
4
0 0 0
1 0 0
0 1 0
0 0 1
$EndNodes
$Elements
5 5 1 5
0 1 15 1
1 1
1 1 1 1
2 1 2
2 1 2 1
3 1 3 2
2 2 2 1
4 1 2 4
3 1 4 1
5 1 2 3 4
$EndElements
)";

constexpr const char* kAbaqusWithPoints = R"(*NODE, NSET=ALL
1, 0, 0, 0
2, 1, 0, 0
3, 0, 1, 0
4, 0, 0, 1
*NSET, NSET=Fixed
1, 2
3
*NSET, NSET=ODD, GENERATE
1, 4000000000000000000, 2
*NSET, NSET=elsewhere
77, other_set
*ELEMENT, TYPE=C3D4
1, 1, 2, 3, 4
)";

std::vector<NodeGroup> GroupsOf(const std::string& name, const std::string& text) {
  const test_support::TestFolder folder;
  std::vector<NodeGroup> groups;
  ReadMesh(folder.Write(name, text), 1.0, nullptr, &groups);
  return groups;
}

TEST(NodeGroups, OfGmshAreItsPhysicalPointsCurvesAndSurfaces) {
  const auto groups = GroupsOf("tet.msh", kGmsh41);
  ASSERT_EQ(groups.size(), 3U);
  EXPECT_EQ(groups[0].name, "cable_1");
  EXPECT_EQ(groups[0].dimension, 0);
  EXPECT_THAT(groups[0].elements, ElementsAre(std::vector<int>{0}));
  EXPECT_EQ(groups[1].name, "tendon");
  EXPECT_EQ(groups[1].dimension, 1);
  EXPECT_THAT(groups[1].elements, ElementsAre(std::vector<int>{0, 1}));
  EXPECT_EQ(groups[2].name, "fixed");
  EXPECT_EQ(groups[2].dimension, 2);
  EXPECT_THAT(groups[2].elements, ElementsAre(std::vector<int>{0, 2, 1}));
}

TEST(NodeGroups, OfAbaqusAreItsNodeSets) {
  const auto groups = GroupsOf("tet.inp", kAbaqusWithPoints);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].name, "Fixed");
  EXPECT_THAT(groups[0].elements,
              ElementsAre(std::vector<int>{0}, std::vector<int>{1}, std::vector<int>{2}));
  EXPECT_EQ(groups[1].name, "ODD");
  EXPECT_EQ(groups[1].elements.size(), 2U);
}

TEST(NodeGroups, OfAbaqusHoldTheSetsThatTheyName) {
  const std::string text = std::string(kAbaqusWithPoints) +
                           "*NSET, NSET=clamp\nleft, RIGHT\n*NSET, NSET=all\nCLAMP, 3, all\n"
                           "*NSET, NSET=LEFT\n1\n*NSET, NSET=right\n2, 1\n";
  const auto groups = GroupsOf("tet.inp", text);
  const auto nodes_of = [&](const std::string& name) {
    std::vector<int> nodes;
    for (const NodeGroup& group : groups) {
      if (group.name != name) continue;
      for (const std::vector<int>& element : group.elements) nodes.push_back(element.at(0));
    }
    return nodes;
  };
  EXPECT_THAT(nodes_of("clamp"), ElementsAre(0, 1));
  EXPECT_THAT(nodes_of("all"), ElementsAre(0, 1, 2));
  EXPECT_THAT(nodes_of("LEFT"), ElementsAre(0));
}

TEST(NodeGroups, DoNotChangeTheMesh) {
  const test_support::TestFolder folder;
  const auto file = folder.Write("tet.msh", kGmsh41);
  std::vector<NodeGroup> groups;
  const TetMesh with = ReadMesh(file, 1.0, nullptr, &groups);
  const TetMesh without = ReadMesh(file, 1.0);
  EXPECT_EQ(with.cells, without.cells);
  EXPECT_EQ(with.groups, without.groups);
}

}  // namespace
}  // namespace palpate::fem

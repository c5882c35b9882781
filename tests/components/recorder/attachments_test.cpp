// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/attachments.hpp"

#include <gmock/gmock.h>

#include "tests/support/test_folder.hpp"

namespace palpate::recorder {
namespace {

using test_support::TestFolder;

TEST(AttachRobot, KeepsThePathOfAMeshBelowTheRobotFile) {
  const TestFolder folder;
  folder.Write("robots/meshes/finger.msh", "a mesh");
  const auto file = folder.Write("robots/finger.yaml", "mesh: {file: ./meshes/finger.msh}\n");
  const auto attachments = AttachRobot(file);
  ASSERT_EQ(attachments.size(), 2u);
  EXPECT_EQ(attachments[0].name, "finger.yaml");
  EXPECT_EQ(attachments[0].data, "mesh: {file: ./meshes/finger.msh}\n");
  EXPECT_EQ(attachments[1].name, "meshes/finger.msh");
  EXPECT_EQ(attachments[1].data, "a mesh");
}

/// Attachments have no folder above them.
TEST(AttachRobot, AMeshOfAnotherFolderBecomesItsNeighbour) {
  const TestFolder folder;
  const auto mesh = folder.Write("meshes/finger.msh", "a mesh");
  for (const std::string& path : {std::string("../meshes/finger.msh"), mesh.string()}) {
    const auto file = folder.Write("robots/finger.yaml",
                                   "name: '" + path + "'\nmesh:\n  file: " + path + "  # ours\n");
    const auto attachments = AttachRobot(file);
    ASSERT_EQ(attachments.size(), 2u);
    EXPECT_EQ(attachments[0].data, "name: '" + path + "'\nmesh:\n  file: finger.msh  # ours\n");
    EXPECT_EQ(attachments[1].name, "finger.msh");
    EXPECT_EQ(attachments[1].data, "a mesh");
  }
}

}  // namespace
}  // namespace palpate::recorder

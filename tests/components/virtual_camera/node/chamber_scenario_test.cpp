// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <iterator>
#include <string>

#include "components/virtual_camera/node/command_line.hpp"
#include "tests/libs/dds/test_participant.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::virtual_camera {
namespace {

TEST(ChamberScenario, StartsTheCameraOfARobotWithChambers) {
  const test_support::TestFolder folder;
  const std::string scenario =
      folder
          .Write("s.yaml",
                 "name: s\ncamera:\n"
                 "  depth: {width_px: 64, height_px: 48, fx_px: 60, fy_px: 60, cx_px: 31.5,\n"
                 "          cy_px: 23.5, unit_m: 0.0001, baseline_m: 0.05}\n"
                 "  eye_m: [0.3, 0, 0.1]\n  target_m: [0, 0, 0.05]\n"
                 "recordings:\n  - name: a\n    duration_s: 1\n"
                 "    commands: [{t_s: 0, bend.pressure_Pa: 1000}]\n")
          .string();
  const std::string domain = std::to_string(dds::TestDomain());
  const char* const words[] = {"palpate-virtual-camera",
                               "pneumatic_finger",
                               "--scenario",
                               scenario.c_str(),
                               "--domain",
                               domain.c_str(),
                               "--set",
                               "interface_address=127.0.0.52"};
  const auto command = ReadCommand(static_cast<int>(std::size(words)), words);
  ASSERT_TRUE(command);
  EXPECT_NE(MakeNode(*command), nullptr);
}

}  // namespace
}  // namespace palpate::virtual_camera

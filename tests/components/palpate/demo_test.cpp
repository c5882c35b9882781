// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/palpate/child_process.hpp"
#include "libs/core/file.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

int RunDemo(const TestFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"demo", "--out", (folder / "demo").string()};
  words.insert(words.end(), more.begin(), more.end());
  ChildProcess demo(PALPATE_BINARY_DIR "/bin/palpate", words, {}, folder / "log");
  return demo.Wait();
}

TEST(Demo, FindsTheWeightThroughTheProcessesAndDrawsIt) {
  const TestFolder folder;
  EXPECT_EQ(RunDemo(folder, {"--computed"}), 0);
  const std::string text = ReadFile(folder / "log");
  EXPECT_THAT(text, testing::HasSubstr("60 marker frames answered"));
  EXPECT_THAT(text, testing::HasSubstr("truth      0.510 N"));
  EXPECT_THAT(text, testing::HasSubstr("inside the interval"));
  EXPECT_GT(std::filesystem::file_size(folder / "demo/scene.png"), 20000U);
}

TEST(Demo, RefusesADataFolderWithoutTheBeam) {
  const TestFolder folder;
  EXPECT_EQ(RunDemo(folder, {"--data", folder.path().string()}), 2);
  EXPECT_THAT(ReadFile(folder / "log"), testing::HasSubstr("no silicone_beam/"));
}

}  // namespace
}  // namespace palpate::command

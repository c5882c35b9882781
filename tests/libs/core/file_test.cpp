// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/file.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "libs/core/error.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class FileTest : public ::testing::Test {
 protected:
  std::string FailureOfWriting(const std::filesystem::path& file) const {
    try {
      WriteFile(file, "text");
    } catch (const RunError& error) {
      return error.what();
    }
    return "";
  }

  const test_support::TestFolder own_folder_;
  const std::filesystem::path folder_ = own_folder_.path();
};

TEST_F(FileTest, ReadsBackWhatWasWritten) {
  const std::string bytes("a\0b\r\n\xff", 6);
  WriteFile(folder_ / "a.bin", bytes);
  EXPECT_EQ(ReadFile(folder_ / "a.bin"), bytes);
  WriteFile(folder_ / "a.bin", "short");
  EXPECT_EQ(ReadFile(folder_ / "a.bin"), "short");
}

TEST_F(FileTest, LeavesNothingElseBehind) {
  WriteFile(folder_ / "a.bin", "text");
  EXPECT_THAT(FailureOfWriting(folder_ / "none" / "a.bin"), HasSubstr("No such file"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(FileTest, SaysWhyAFileCannotBeRead) {
  const auto refusal = [](const std::filesystem::path& file) -> std::string {
    try {
      ReadFile(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(folder_ / "none"),
            (folder_ / "none").string() + ": cannot be read: No such file or directory");
  EXPECT_THAT(refusal(folder_), HasSubstr("Is a directory"));
}

TEST_F(FileTest, SaysThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(FailureOfWriting("/dev/full"), StartsWith("/dev/full: cannot be written: No space"));
}

TEST_F(FileTest, SaysThatAFolderIsInTheWay) {
  EXPECT_THAT(FailureOfWriting(folder_), HasSubstr("Is a directory"));
}

}  // namespace
}  // namespace palpate

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "libs/core/error.hpp"

namespace palpate {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A folder of its own for each test, gone after it.
class FileTest : public ::testing::Test {
 protected:
  FileTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("palpate_file_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directory(folder_);
  }
  ~FileTest() override { std::filesystem::remove_all(folder_); }

  std::string FailureOfWriting(const std::filesystem::path& file) const {
    try {
      WriteFile(file, "text");
    } catch (const RunError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
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

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/check_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::HasSubstr;

class CheckOutput : public testing::Test {
 protected:
  TestFolder folder_;
};

TEST_F(CheckOutput, WhatCanBeWrittenPassesAndIsNotTouched) {
  folder_.Write("old.yaml", "kept");
  CheckOutputFile(folder_ / "old.yaml");
  CheckOutputFile(folder_ / "new.yaml");
  CheckOutputFile("/dev/null");
  CheckOutputFolder(folder_ / "a/b/c");
  CheckOutputFolder(folder_ / "");
  EXPECT_EQ(ReadFile(folder_ / "old.yaml"), "kept");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new.yaml"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a"));
}

TEST_F(CheckOutput, AFileInAnAbsentFolderIsRefused) {
  EXPECT_THAT(MessageOf([&] { CheckOutputFile(folder_ / "absent/new.yaml"); }),
              AllOf(HasSubstr("absent/new.yaml: cannot be written"),
                    HasSubstr("absent does not exist; create it first")));
}

TEST_F(CheckOutput, AFolderIsNoFile) {
  std::filesystem::create_directories(folder_ / "there");
  EXPECT_THAT(MessageOf([&] { CheckOutputFile(folder_ / "there"); }),
              HasSubstr("a folder has that name; give a file"));
  EXPECT_THAT(MessageOf([&] { CheckOutputFile(folder_ / "there/"); }),
              HasSubstr("no name of a file"));
}

TEST_F(CheckOutput, AFileIsNoFolder) {
  folder_.Write("file", "");
  EXPECT_THAT(MessageOf([&] { CheckOutputFolder(folder_ / "file"); }),
              HasSubstr("file is not a folder; give another place"));
  EXPECT_THAT(MessageOf([&] { CheckOutputFolder(folder_ / "file/below"); }),
              HasSubstr("file is not a folder; give another place"));
  EXPECT_THAT(MessageOf([&] { CheckOutputFile(folder_ / "file/below"); }),
              HasSubstr("cannot be written"));
}

TEST_F(CheckOutput, AFolderWithoutThePermissionIsRefused) {
  if (geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
  std::filesystem::create_directories(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::owner_read);
  EXPECT_THAT(MessageOf([&] { CheckOutputFile(folder_ / "locked/new.yaml"); }),
              HasSubstr("Permission denied; give another place"));
  EXPECT_THAT(MessageOf([&] { CheckOutputFolder(folder_ / "locked/new"); }),
              HasSubstr("Permission denied; give another place"));
}

}  // namespace
}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/ros_arguments.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Words = std::vector<std::string>;

std::string RefusedRosArguments(const Words& words) {
  try {
    WithoutRosArguments(words);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RosArguments, OtherWordsStayAsTheyAre) {
  EXPECT_THAT(WithoutRosArguments({"beam", "--set", "a=1", "-r", "x"}),
              ElementsAre("beam", "--set", "a=1", "-r", "x"));
}

TEST(RosArguments, AreTranslatedUpToTheDoubleDash) {
  EXPECT_THAT(
      WithoutRosArguments({"--ros-args", "-r", "/a:=/b", "--remap", "__ns:=/left", "-p",
                           "use_sim_time:=true", "--param", "node:silence_s:=3.0", "--log-level",
                           "warn", "--", "beam"}),
      ElementsAre("--remap", "/a:=/b", "--remap", "__ns:=/left", "--set", "dds.use_sim_time=true",
                  "--set", "silence_s=3.0", "--log-level", "warning", "beam"));
}

TEST(RosArguments, MayStandMoreThanOnce) {
  EXPECT_THAT(WithoutRosArguments({"--ros-args", "--", "--ros-args", "-r", "/a:=/b"}),
              ElementsAre("--remap", "/a:=/b"));
}

TEST(RosArguments, WhatIsNotKnownIsRefused) {
  EXPECT_THAT(RefusedRosArguments({"--ros-args", "--params-file", "f.yaml"}),
              HasSubstr("--params-file"));
  EXPECT_THAT(RefusedRosArguments({"--ros-args", "-r"}), HasSubstr("its value is missing"));
  EXPECT_THAT(RefusedRosArguments({"--ros-args", "-p", "a=1"}), HasSubstr("NAME:=VALUE"));
}

}  // namespace
}  // namespace palpate::app

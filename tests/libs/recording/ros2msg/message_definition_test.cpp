// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/ros2msg/message_definition.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::recording {
namespace {

using test_support::MessageOf;
using testing::HasSubstr;

TEST(MessageDefinition, EveryIdlSaysWhatItsMsgTwinSays) {
  int count = 0;
  const std::filesystem::path folder = PALPATE_SOURCE_DIR "/idl/palpate_msgs/msg";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".msg") continue;
    const std::string name = "palpate_msgs/" + entry.path().stem().string();
    const Definitions twin = ParseRos2msg(name, ReadFile(entry.path()));
    ASSERT_TRUE(BuiltInDefinitions().contains(name)) << name;
    EXPECT_EQ(BuiltInDefinitions().at(name), twin.at(name)) << name;
    ++count;
  }
  EXPECT_GT(count, 20);
}

TEST(MessageDefinition, WhatIsFormattedIsReadBackWithAllThatItUses) {
  for (const auto& [name, definition] : BuiltInDefinitions()) {
    const std::optional<std::string> text = FormatRos2msg(name, BuiltInDefinitions());
    ASSERT_TRUE(text.has_value()) << name;
    for (const auto& [read_name, read] : ParseRos2msg(name, *text)) {
      EXPECT_EQ(read, BuiltInDefinitions().at(read_name)) << name;
    }
  }
}

TEST(MessageDefinition, AnImageIsThatOfRos) {
  EXPECT_EQ(FormatRos2msg("sensor_msgs/msg/Image", BuiltInDefinitions()),
            "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
            "uint8 is_bigendian\nuint32 step\nuint8[] data\n" +
                std::string(80, '=') +
                "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
                std::string(80, '=') +
                "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
}

TEST(MessageDefinition, ReadsWhatRosAllows) {
  const Definitions read = ParseRos2msg("some_msgs/msg/A",
                                        "# comment\n"
                                        "uint8 ONE=1 # of three\n"
                                        "string TEXT=a # b\n"
                                        "float32[<=4] bounded\n"
                                        "string<=10 short \"default\"\n"
                                        "int32[3] three [1, 2, 3]\n"
                                        "B other\n"
                                        "geometry_msgs/msg/Point point\n"
                                        "================\n"
                                        "MSG: some_msgs/B\n"
                                        "bool yes true\n");
  const MessageDefinition& a = read.at("some_msgs/A");
  EXPECT_EQ(a.constants,
            (std::vector<Constant>{{"uint8", "ONE", "1"}, {"string", "TEXT", "a # b"}}));
  EXPECT_EQ(a.fields, (std::vector<Field>{{"float32", "bounded", Repeat::kSequence, 0},
                                          {"string", "short", Repeat::kOne, 0},
                                          {"int32", "three", Repeat::kFixed, 3},
                                          {"some_msgs/B", "other", Repeat::kOne, 0},
                                          {"geometry_msgs/Point", "point", Repeat::kOne, 0}}));
  EXPECT_EQ(read.at("some_msgs/B").fields, (std::vector<Field>{{"bool", "yes", Repeat::kOne, 0}}));
  EXPECT_FALSE(FormatRos2msg("some_msgs/A", read).has_value());  // Point is not there
}

TEST(MessageDefinition, RefusesIdlThatHasNoCounterpart) {
  EXPECT_THAT(MessageOf([] { ParseIdl("module a { };", "a.idl"); }),
              HasSubstr("a.idl: holds no struct"));
  EXPECT_THAT(
      MessageOf([] { ParseIdl("module a { struct B_ { map<long, long> c; }; };", "b.idl"); }),
      HasSubstr("b.idl: "));
  EXPECT_THAT(MessageOf([] { ParseIdl("module a { struct B_ { wchar c; }; };", "c.idl"); }),
              HasSubstr("type 'wchar' has no counterpart"));
}

}  // namespace
}  // namespace palpate::recording

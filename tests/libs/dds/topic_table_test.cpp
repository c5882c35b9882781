// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/topic_table.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/dds/ros_names.hpp"
#include "libs/dds/topics.hpp"

namespace palpate::dds {
namespace {

using ::testing::HasSubstr;

constexpr char kRow[] =
    "topics:\n"
    "  - {name: /a, type: p/msg/A, reliability: reliable, durability: volatile, depth: 5,"
    " rate_hz: 10, deadline_s: 0.5, recorded: false}\n";

TopicTable Parse(const std::string& text) { return ReadTopicTable(app::ParseYaml(text, "t.yaml")); }

std::string RefusalOf(const std::string& text) {
  try {
    Parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string Replaced(const std::string& from, const std::string& to) {
  std::string text = kRow;
  return text.replace(text.find(from), from.size(), to);
}

TEST(TopicTable, HoldsEveryTopicOfTheCodeWithItsType) {
  const TopicTable table = Parse(std::string(BuiltInTopicsYaml()));
  for (const TopicNameAndType& topic : AllTopics()) {
    EXPECT_EQ(DdsTypeName(table.At(topic.name).type), topic.dds_type) << topic.name;
  }
}

TEST(TopicTable, HoldsNoTopicThatTheCodeDoesNotKnow) {
  const TopicTable table = Parse(std::string(BuiltInTopicsYaml()));
  EXPECT_EQ(table.topics().size(), AllTopics().size());
}

TEST(TopicTable, BuiltInIsTheOneOfTheSourceTree) {
  const TopicTable file = ReadTopicTable(
      app::LoadYaml(std::filesystem::path(PALPATE_SOURCE_DIR) / "config/topics.yaml"));
  const TopicTable built_in = Parse(std::string(BuiltInTopicsYaml()));
  ASSERT_EQ(file.topics().size(), built_in.topics().size());
  for (size_t i = 0; i < file.topics().size(); ++i) {
    EXPECT_EQ(file.topics()[i].name, built_in.topics()[i].name);
    EXPECT_EQ(file.topics()[i].depth, built_in.topics()[i].depth);
  }
}

TEST(TopicTable, ReadsEveryColumn) {
  const TopicSettings topic = Parse(kRow).At("/a");
  EXPECT_EQ(topic.type, "p/msg/A");
  EXPECT_EQ(topic.reliability, Reliability::kReliable);
  EXPECT_EQ(topic.durability, Durability::kVolatile);
  EXPECT_EQ(topic.depth, 5);
  EXPECT_EQ(topic.rate_hz, 10.0);
  EXPECT_EQ(topic.deadline_s, 0.5);
  EXPECT_FALSE(topic.recorded);
  EXPECT_FALSE(topic.global);
  EXPECT_TRUE(Parse(Replaced("recorded: false", "recorded: false, global: true")).At("/a").global);
}

TEST(TopicTable, ListsMarkRows) {
  const std::string marked = std::string(kRow) + "sole_writer: [/a]\nraw: [/a]\n";
  EXPECT_TRUE(Parse(marked).At("/a").sole_writer);
  EXPECT_TRUE(Parse(marked).At("/a").raw);
  EXPECT_FALSE(Parse(kRow).At("/a").sole_writer);
  EXPECT_THAT(RefusalOf(std::string(kRow) + "raw: [/b]\n"),
              HasSubstr("t.yaml:3:7: key 'raw[0]': topic '/b' is not in the table"));
  EXPECT_THAT(RefusalOf(std::string(kRow) + "raw: /a\n"), HasSubstr("list of names"));
}

TEST(TopicTable, RefusesWhatItCannotRead) {
  EXPECT_THAT(RefusalOf(Replaced("depth", "dept")), HasSubstr("depth"));
  EXPECT_THAT(RefusalOf(Replaced("depth: 5", "depth: 0")), HasSubstr("t.yaml:2"));
  EXPECT_THAT(RefusalOf(Replaced("reliable,", "reliabel,")), HasSubstr("did you mean 'reliable'"));
  EXPECT_THAT(RefusalOf(Replaced("deadline_s: 0.5", "deadline_s: .nan")), HasSubstr("deadline_s"));
  EXPECT_THAT(RefusalOf(Replaced("/a", "a b")), HasSubstr("no ROS topic name"));
  EXPECT_THAT(RefusalOf(Replaced("p/msg/A", "A")), HasSubstr("package/msg/Name"));
  EXPECT_THAT(RefusalOf(std::string(kRow) + (strchr(kRow, '\n') + 1)), HasSubstr("twice"));
}

TEST(TopicTable, SaysWhichTopicWasMeant) {
  try {
    Parse(std::string(BuiltInTopicsYaml())).At("/force");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean '/forces'"));
  }
}

}  // namespace
}  // namespace palpate::dds

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/app/yaml.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "libs/core/config_reader.hpp"
#include "libs/core/file.hpp"

namespace palpate::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Kind = ConfigNode::Kind;

std::string Refusal(const std::string& text) {
  try {
    ParseYaml(text, "a.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Yaml, KeepsOrderKindsAndPlaces) {
  const ConfigNode root = ParseYaml(
      "name: diamond   # a comment\n"
      "cables:\n"
      "  - {name: north, path_m: [[0, 1, 2]]}\n"
      "  - name: 'south'\n"
      "nothing:\n",
      "a.yaml");
  ASSERT_EQ(root.kind, Kind::kMap);
  ASSERT_EQ(root.entries.size(), 3u);
  EXPECT_EQ(root.entries[0].key, "name");
  EXPECT_EQ(root.Find("name")->text, "diamond");
  EXPECT_EQ(root.Find("name")->where.ToString(), "a.yaml:1:7");
  EXPECT_EQ(root.Find("nothing")->kind, Kind::kNull);
  EXPECT_EQ(root.Find("none"), nullptr);
  EXPECT_EQ(root.Find("cables")->key_where.ToString(), "a.yaml:2:1");
  const ConfigNode& south = root.Find("cables")->items.at(1);
  EXPECT_EQ(south.path, "cables[1]");
  EXPECT_TRUE(south.Find("name")->quoted);
  EXPECT_EQ(south.Find("name")->where.ToString(), "a.yaml:4:11");
  const ConfigNode& point = root.Find("cables")->items.at(0).Find("path_m")->items.at(0);
  EXPECT_EQ(point.items.at(2).path, "cables[0].path_m[0][2]");
  EXPECT_FALSE(point.items.at(2).quoted);
}

TEST(Yaml, AnEmptyFileIsANullNode) {
  EXPECT_EQ(ParseYaml("", "a.yaml").kind, Kind::kNull);
  EXPECT_EQ(ParseYaml("# only a comment\n", "a.yaml").kind, Kind::kNull);
  EXPECT_EQ(ParseYaml("---\n", "a.yaml").kind, Kind::kNull);
}

TEST(Yaml, RefusesAKeyGivenTwiceAndNamesBothPlaces) {
  EXPECT_EQ(Refusal("a:\n  x: 1\n  y: 2\n  x: 3\n"),
            "a.yaml:4:3: key 'a.x' is given twice, first a.yaml:2:3");
}

TEST(Yaml, TheSameKeyInTwoMapsIsNoRepetition) {
  EXPECT_EQ(Refusal("a: {x: 1}\nb: {x: 1}\nc: [{x: 1}, {x: 2}]\n"), "");
}

TEST(Yaml, NamesThePlaceOfASyntaxError) {
  EXPECT_THAT(Refusal("a: 1\nb: [1, 2\nc: 3\n"), StartsWith("a.yaml:"));
  EXPECT_THAT(Refusal("a: 1\nb: [1, 2\nc: 3\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(Refusal("a: 1\n\tb: 2\n"), StartsWith("a.yaml:2:"));
}

TEST(Yaml, RefusesWhatSettingsHaveNoNeedOf) {
  EXPECT_EQ(Refusal("a: &x 1\nb: *x\n"), "a.yaml:1:4: anchors (&name) are not read");
  EXPECT_THAT(Refusal("a: !!str 1\n"), HasSubstr("tags (tag:yaml.org,2002:str) are not read"));
  EXPECT_EQ(Refusal("a: 1\n---\nb: 2\n"), "a.yaml:3:1: only one YAML document is read from a file");
  EXPECT_THAT(Refusal("a: 1\n---\n---\nb: 2\n"), HasSubstr("only one YAML document"));
  EXPECT_THAT(Refusal("? [1, 2]\n: 3\n"), HasSubstr("a key must be a plain word"));
}

TEST(Yaml, AnEmptyDocumentAtTheEndIsNone) {
  for (const std::string end : {"---\n", "---\n\n# end\n", "...\n"}) {
    EXPECT_EQ(ParseYaml("a: 1\n" + end, "a.yaml").Find("a")->text, "1") << end;
  }
}

TEST(Yaml, RefusesNestingTooDeepToBeSettings) {
  const std::string deep = "a: " + std::string(5000, '[') + std::string(5000, ']');
  EXPECT_THAT(Refusal(deep), HasSubstr("not valid YAML"));
}

TEST(Yaml, TrapsOfYamlReachTheStrictReaders) {
  const ConfigNode root =
      ParseYaml("a: 012\nb: no\nc: .nan\nd: '5'\ne: 1_000\nf: 0o17\n", "a.yaml");
  for (const auto& [key, entry] : root.entries) {
    EXPECT_THROW(ReadNumber(entry), InputError) << key;
  }
  EXPECT_THROW(ReadText(*root.Find("b")), InputError);
  EXPECT_EQ(ReadText(*root.Find("d")), "5");
}

TEST(LoadYaml, NamesTheFileThatCannotBeRead) {
  try {
    LoadYaml("/nowhere/robot.yaml");
    FAIL() << "no refusal";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/nowhere/robot.yaml: cannot be read: No such file or directory");
  }
}

TEST(LoadYaml, ReadsAFile) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("palpate_yaml_test_" + std::to_string(getpid()) + ".yaml");
  WriteFile(file, "a: 1\n");
  const ConfigNode root = LoadYaml(file);
  std::filesystem::remove(file);
  EXPECT_EQ(root.Find("a")->where.ToString(), file.string() + ":1:4");
}

/// What LoadYaml says of a file of this name and content.
std::string LoadRefusal(const std::string& name, const std::string& content) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("palpate_yaml_test_" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  WriteFile(folder / name, content);
  std::string message;
  try {
    LoadYaml(folder / name);
  } catch (const InputError& error) {
    message = error.what();
  }
  std::filesystem::remove_all(folder);
  const std::string prefix = folder.string() + "/";
  return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

TEST(LoadYaml, SaysThatAFileOfAnotherKindIsNone) {
  const std::string numbers = "-1 2411 " + std::string(400000, '7') + "\n";
  EXPECT_THAT(
      LoadRefusal("finger.unv", numbers),
      AllOf(StartsWith("finger.unv:1:1: is no file of settings"), HasSubstr("name ends in .yaml")));
  EXPECT_LT(LoadRefusal("finger.unv", numbers).size(), 300u);
  EXPECT_THAT(LoadRefusal("finger.stl", "solid Created by Gmsh\nfacet normal 1 0 0\n"),
              HasSubstr("it begins with 'solid Created by Gmsh"));
  EXPECT_THAT(LoadRefusal("finger.inp", "*NODE\n1, 0, 0, 0\n"), HasSubstr("name ends in .yaml"));
  EXPECT_THAT(LoadRefusal("finger.stl", std::string("solid\0\0", 7)),
              StartsWith("finger.stl: is a binary file, not YAML"));
  EXPECT_THAT(LoadRefusal("a.yaml", "just a text\n"), Not(HasSubstr("name ends in")));
}

TEST(LoadYaml, NamesTheTabThatIndents) {
  EXPECT_EQ(LoadRefusal("a.yaml", "mesh:\n\tfile: a.msh\n\tunit: mm\n"),
            "a.yaml:2:1: not valid YAML: the line is indented by a tab; use spaces");
  EXPECT_EQ(LoadRefusal("a.yaml", "a: 1\t# a tab that does no harm\n"), "");
}

}  // namespace
}  // namespace palpate::app

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "libs/app/version.hpp"

namespace palpate::idl {
namespace {

using Lines = std::vector<std::string>;

std::filesystem::path MessageFolder() {
  return std::filesystem::path(PALPATE_SOURCE_DIR) / "idl/palpate_msgs/msg";
}

Lines CodeLines(const std::filesystem::path& file, const std::string& comment) {
  std::ifstream stream(file);
  Lines lines;
  for (std::string line; std::getline(stream, line);) {
    line = line.substr(0, line.find(comment));
    line = std::regex_replace(line, std::regex("^\\s+|\\s+$"), "");
    if (!line.empty()) lines.push_back(line);
  }
  return lines;
}

/// IDL type of a .msg type, after the mapping of ROS 2 (docs/architecture.md, "DDS conventions").
std::string IdlType(const std::string& type) {
  static const std::map<std::string, std::string> kPrimitive{
      {"bool", "boolean"},         {"byte", "octet"},    {"uint8", "octet"},
      {"uint32", "unsigned long"}, {"int32", "long"},    {"uint64", "unsigned long long"},
      {"int64", "long long"},      {"float32", "float"}, {"float64", "double"},
      {"string", "string"}};
  if (const auto found = kPrimitive.find(type); found != kPrimitive.end()) return found->second;
  const size_t slash = type.find('/');
  const std::string package = slash == type.npos ? "palpate_msgs" : type.substr(0, slash);
  return package + "::msg::dds_::" + type.substr(slash == type.npos ? 0 : slash + 1) + "_";
}

/// The .msg file as the members and constants that its IDL must have.
Lines Expected(const std::filesystem::path& msg_file) {
  static const std::regex kConstant(R"((\w+) (\w+)=(\d+))");
  static const std::regex kField(R"(([\w/]+)(\[(\d*)\])? (\w+))");
  Lines expected;
  for (const std::string& line : CodeLines(msg_file, "#")) {
    std::smatch match;
    if (std::regex_match(line, match, kConstant)) {
      expected.push_back("const " + IdlType(match[1]) + " " + match[2].str() + " = " +
                         match[3].str() + ";");
    } else if (std::regex_match(line, match, kField)) {
      const std::string type = IdlType(match[1]);
      const bool sequence = match[2].matched && match[3].length() == 0;
      expected.push_back((sequence ? "sequence<" + type + ">" : type) + " " + match[4].str() +
                         (match[3].length() > 0 ? match[2].str() : "") + ";");
    } else {
      ADD_FAILURE() << msg_file << ": not understood: " << line;
    }
  }
  return expected;
}

Lines Actual(const std::filesystem::path& idl_file) {
  Lines actual;
  for (const std::string& line : CodeLines(idl_file, "//")) {
    if (line.ends_with(";") && line != "};") actual.push_back(line);
  }
  return actual;
}

TEST(IdlTwins, EachMsgFileAgreesWithItsIdlFieldByField) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MessageFolder())) {
    if (entry.path().extension() != ".msg") continue;
    std::filesystem::path idl_file = entry.path();
    idl_file.replace_extension(".idl");
    EXPECT_EQ(Expected(entry.path()), Actual(idl_file)) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 10);
}

TEST(IdlTwins, EachMessageOfOursHasATwin) {
  for (const auto& entry : std::filesystem::directory_iterator(MessageFolder())) {
    std::filesystem::path twin = entry.path();
    twin.replace_extension(entry.path().extension() == ".idl" ? ".msg" : ".idl");
    EXPECT_TRUE(std::filesystem::exists(twin)) << entry.path();
  }
}

/// rosidl refuses other names: lower case, no double or trailing underscore.
TEST(IdlTwins, EveryFieldHasANameThatRosidlTakes) {
  const std::regex name_rule("[a-z](_?[a-z0-9])*");
  for (const auto& entry : std::filesystem::directory_iterator(MessageFolder())) {
    if (entry.path().extension() != ".msg") continue;
    for (const std::string& line : CodeLines(entry.path(), "#")) {
      if (line.find('=') != line.npos) continue;
      EXPECT_TRUE(std::regex_match(line.substr(line.rfind(' ') + 1), name_rule))
          << entry.path() << ": " << line;
    }
  }
}

/// The packages whose messages the .msg files use.
std::set<std::string> UsedPackages() {
  std::set<std::string> packages;
  for (const auto& entry : std::filesystem::directory_iterator(MessageFolder())) {
    if (entry.path().extension() != ".msg") continue;
    for (const std::string& line : CodeLines(entry.path(), "#")) {
      const std::string type = line.substr(0, line.find(' '));
      if (const size_t slash = type.find('/'); slash != type.npos) {
        packages.insert(type.substr(0, slash));
      }
    }
  }
  return packages;
}

std::set<std::string> Captures(const std::filesystem::path& file, const std::string& pattern) {
  std::set<std::string> found;
  std::ifstream stream(file);
  const std::regex rule(pattern);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, rule)) found.insert(match[1]);
  }
  return found;
}

TEST(RosPackage, DependsOnThePackagesThatItsMessagesUse) {
  const std::filesystem::path folder = MessageFolder().parent_path();
  EXPECT_EQ(Captures(folder / "package.xml", "<depend>(.*)</depend>"), UsedPackages());
  std::set<std::string> found =
      Captures(folder / "CMakeLists.txt", R"(^find_package\((\w+) REQUIRED\))");
  EXPECT_EQ(found.erase("ament_cmake") + found.erase("rosidl_default_generators"), 2u);
  EXPECT_EQ(found, UsedPackages());
}

TEST(RosPackage, HasTheNameAndVersionOfTheProject) {
  const std::filesystem::path folder = MessageFolder().parent_path();
  EXPECT_EQ(Captures(folder / "package.xml", "<name>(.*)</name>"),
            std::set<std::string>{"palpate_msgs"});
  EXPECT_EQ(Captures(folder / "CMakeLists.txt", R"(^project\((\w+)\))"),
            std::set<std::string>{"palpate_msgs"});
  EXPECT_EQ(Captures(folder / "package.xml", "<version>(.*)</version>"),
            std::set<std::string>{app::Version()});
}

TEST(IdlTwins, EveryStructIsFinal) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(PALPATE_SOURCE_DIR) / "idl")) {
    if (entry.path().extension() != ".idl") continue;
    const Lines lines = CodeLines(entry.path(), "//");
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [](const std::string& line) {
      return line.starts_with("@final struct ");
    })) << entry.path();
  }
}

}  // namespace
}  // namespace palpate::idl

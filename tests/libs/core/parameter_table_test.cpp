// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/parameter_table.hpp"

#include <gmock/gmock.h>

namespace palpate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// One that takes the texts "a" and "b", and one that is fixed.
ParameterTable Table(std::string* changed) {
  Parameter free{"level", std::string("a")};
  free.change = [changed](const ParameterValue& value) -> std::string {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr || (*text != "a" && *text != "b")) return "must be a or b";
    *changed = *text;
    return "";
  };
  Parameter other = free;
  other.name = "shape.level";
  Parameter fixed{"shape.contact.radius_m", 0.5};
  fixed.fixed_because = "read at start";
  return ParameterTable({free, other, fixed});
}

TEST(ParameterTable, ListsBelowPrefixesDownToADepthAsRclcppDoes) {
  std::string changed;
  const ParameterTable table = Table(&changed);
  EXPECT_THAT(table.Names(), ElementsAre("level", "shape.level", "shape.contact.radius_m"));
  EXPECT_THAT(table.Names({}, 1), ElementsAre("level"));
  EXPECT_THAT(table.Names({}, 2), ElementsAre("level", "shape.level"));
  EXPECT_THAT(table.Names({"shape"}, 1), ElementsAre("shape.level"));
  EXPECT_THAT(table.Names({"shape"}, 0), ElementsAre("shape.level", "shape.contact.radius_m"));
  EXPECT_THAT(table.Names({"shap"}, 0), ElementsAre());
  EXPECT_THAT(table.Names({"level"}, 1), ElementsAre("level"));
}

TEST(ParameterTable, ChangesWhatCanBeChangedAndKeepsTheValue) {
  std::string changed;
  ParameterTable table = Table(&changed);
  EXPECT_EQ(table.Change("level", std::string("b")), "");
  EXPECT_EQ(changed, "b");
  EXPECT_EQ(table.Find("level")->value, ParameterValue(std::string("b")));
}

TEST(ParameterTable, RefusesWithTheReason) {
  std::string changed;
  ParameterTable table = Table(&changed);
  EXPECT_EQ(table.Change("level", 3.0), "must be a or b");
  EXPECT_EQ(table.Change("shape.contact.radius_m", 1.0), "read at start");
  EXPECT_THAT(table.Change("levle", 1.0), HasSubstr("did you mean 'level'?"));
  EXPECT_EQ(table.Find("level")->value, ParameterValue(std::string("a")));
}

TEST(ParameterTable, ChangesAllOrNone) {
  std::string changed;
  ParameterTable table = Table(&changed);
  const ParameterValue b = std::string("b");
  EXPECT_THAT(table.ChangeTogether({{"level", b}, {"shape.contact.radius_m", 1.0}}),
              HasSubstr("shape.contact.radius_m: read at start"));
  EXPECT_EQ(changed, "");
  EXPECT_THAT(table.ChangeTogether({{"level", b}, {"shape.level", 1.0}}), HasSubstr("a or b"));
  EXPECT_EQ(changed, "a");  // the first was taken back
  EXPECT_EQ(table.Find("level")->value, ParameterValue(std::string("a")));
  EXPECT_EQ(table.ChangeTogether({{"level", b}, {"shape.level", b}}), "");
  EXPECT_EQ(table.Find("shape.level")->value, b);
}

}  // namespace
}  // namespace palpate

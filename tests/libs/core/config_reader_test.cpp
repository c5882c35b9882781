// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/config_reader.hpp"

#include <gmock/gmock.h>

#include <functional>

namespace palpate {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

ConfigNode Scalar(const std::string& text, bool quoted = false) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kScalar;
  node.where = {"robot.yaml", 7, 3};
  node.path = "material.density";
  node.text = text;
  node.quoted = quoted;
  return node;
}

ConfigNode List(const std::vector<std::string>& texts) {
  ConfigNode node = Scalar("");
  node.kind = ConfigNode::Kind::kList;
  for (const std::string& text : texts) node.items.push_back(Scalar(text));
  return node;
}

ConfigNode Map(const std::vector<std::string>& keys) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kMap;
  node.where = {"robot.yaml", 1, 1};
  for (const std::string& key : keys) {
    ConfigNode entry = Scalar("1");
    entry.path = key;
    entry.key_where = {"robot.yaml", 7, 1};
    node.entries.push_back({key, entry});
  }
  return node;
}

/// The message of the InputError that `read` throws; "" where it throws none.
std::string Refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReadNumber, ReadsPlainDecimals) {
  EXPECT_EQ(ReadNumber(Scalar("65.0e3")), 65e3);
  EXPECT_EQ(ReadNumber(Scalar("-0.5")), -0.5);
  EXPECT_EQ(ReadNumber(Scalar("0")), 0.0);
}

TEST(ReadNumber, RefusalNamesFileLineColumnKeyValueAndRule) {
  const std::string message = Refusal([] { ReadNumber(Scalar("-2"), kPositive); });
  EXPECT_EQ(message, "robot.yaml:7:3: key 'material.density': must be > 0, not -2");
}

TEST(ReadNumber, RefusesWhatIsNotFinite) {
  for (const char* text : {".nan", ".NaN", "nan", ".inf", "-.inf", "+.Inf", "inf", "Infinity"}) {
    EXPECT_THAT(
        Refusal([&] { ReadNumber(Scalar(text)); }),
        AllOf(StartsWith("robot.yaml:7:3: "), HasSubstr("must be finite"), HasSubstr(text)));
  }
}

TEST(ReadNumber, RefusesWhatOtherReadersTakeForOctal) {
  for (const char* text : {"012", "-012", "+07", "00", "01.5"}) {
    EXPECT_THAT(Refusal([&] { ReadNumber(Scalar(text)); }), HasSubstr("octal")) << text;
    EXPECT_THAT(Refusal([&] { ReadInteger(Scalar(text), -99, 99); }), HasSubstr("octal")) << text;
  }
}

TEST(ReadNumber, RefusesWordsAndQuotedNumbers) {
  for (const char* text :
       {"yes", "no", "on", "off", "true", "1_000", "0x1F", "12 kPa", "1:30", ""}) {
    EXPECT_THAT(Refusal([&] { ReadNumber(Scalar(text)); }), HasSubstr("must be a number")) << text;
  }
  EXPECT_THAT(Refusal([] { ReadNumber(Scalar("5", true)); }),
              HasSubstr("must be a number, not the text '5'"));
  EXPECT_THAT(Refusal([] { ReadNumber(List({"5"})); }), HasSubstr("not a list of 1"));
  EXPECT_THAT(Refusal([] { ReadNumber(Map({})); }), HasSubstr("not a map"));
}

TEST(ReadNumber, OpenBoundsExcludeThemselvesAndClosedOnesDoNot) {
  const NumberRule half_open{.min = 0.0, .max = 0.5, .max_open = true};
  EXPECT_EQ(ReadNumber(Scalar("0"), half_open), 0.0);
  EXPECT_EQ(ReadNumber(Scalar("0.499"), half_open), 0.499);
  EXPECT_THAT(Refusal([&] { ReadNumber(Scalar("0.5"), half_open); }),
              HasSubstr("must be >= 0 and < 0.5, not 0.5"));
  EXPECT_THAT(Refusal([&] { ReadNumber(Scalar("0"), kPositive); }), HasSubstr("> 0"));
  EXPECT_EQ(Refusal([&] { ReadNumber(Scalar("0"), kNonNegative); }), "");
}

TEST(ReadInteger, ReadsWholeNumbersInTheRangeOnly) {
  EXPECT_EQ(ReadInteger(Scalar("51"), 1, 51), 51);
  EXPECT_EQ(ReadInteger(Scalar("-3"), -3, 3), -3);
  for (const char* text : {"52", "0", "99999999999999999999"}) {
    EXPECT_THAT(Refusal([&] { ReadInteger(Scalar(text), 1, 51); }),
                HasSubstr(std::string("must be 1 to 51, not ") + text));
  }
  for (const char* text : {"5.0", "5e1", "five", "", "5 ", "99999999999999999999x"}) {
    EXPECT_THAT(Refusal([&] { ReadInteger(Scalar(text), 1, 51); }), HasSubstr("whole number"))
        << text;
  }
}

TEST(ReadBool, TakesTrueAndFalseOnly) {
  EXPECT_TRUE(ReadBool(Scalar("true")));
  EXPECT_FALSE(ReadBool(Scalar("false")));
  for (const char* text : {"yes", "no", "on", "off", "True", "1", "0"}) {
    EXPECT_THAT(Refusal([&] { ReadBool(Scalar(text)); }), HasSubstr("true or false")) << text;
  }
  EXPECT_THAT(Refusal([] { ReadBool(Scalar("true", true)); }), HasSubstr("true or false"));
}

TEST(ReadText, WantsQuotesAroundWhatYamlReadsAsSomethingElse) {
  EXPECT_EQ(ReadText(Scalar("leg_north")), "leg_north");
  EXPECT_EQ(ReadText(Scalar("no", true)), "no");
  for (const char* text : {"no", "Yes", "on", "true", "12", "1e3", "nan", ".inf"}) {
    EXPECT_THAT(Refusal([&] { ReadText(Scalar(text)); }),
                HasSubstr(std::string("write \"") + text + "\""));
  }
}

TEST(ReadChoice, RefusesOthersWithDidYouMean) {
  EXPECT_EQ(ReadChoice(Scalar("tet10"), {"tet4", "tet10"}), "tet10");
  const std::string message = Refusal([] {
    ReadChoice(Scalar("hexa"), {"hexahedron", "tetrahedron", "hex8"});
  });
  EXPECT_THAT(message, HasSubstr("must be one of hexahedron, tetrahedron, hex8, not 'hexa'"));
  EXPECT_THAT(message, HasSubstr("did you mean 'hex8'?"));
}

TEST(ReadVector3, WantsThreeFiniteNumbers) {
  EXPECT_EQ(ReadVector3(List({"1", "-2", "0.5"})), Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_THAT(Refusal([] { ReadVector3(List({"1", "2"})); }), HasSubstr("a list of 3 numbers"));
  EXPECT_THAT(Refusal([] { ReadVector3(List({"1", "2", ".nan"})); }), HasSubstr("finite"));
  EXPECT_THAT(Refusal([] { ReadVector3(Scalar("1")); }), HasSubstr("a list of 3 numbers"));
}

TEST(ReadPoints, MakesOneColumnOfEachPoint) {
  ConfigNode node = List({});
  node.items = {List({"1", "2", "3"}), List({"4", "5", "6"})};
  const Eigen::Matrix3Xd points = ReadPoints(node);
  ASSERT_EQ(points.cols(), 2);
  EXPECT_EQ(points.col(1), Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_THAT(Refusal([] { ReadPoints(List({"1"})); }), HasSubstr("a list of 3 numbers"));
}

TEST(ReadNumber, ShowsNoMoreThanEightyCharactersOfTheInput) {
  const std::string message = Refusal([] { ReadNumber(Scalar(std::string(400000, 'x'))); });
  EXPECT_THAT(message, HasSubstr("must be a number, not 'xxx"));
  EXPECT_LT(message.size(), 200u);
}

TEST(ReadNumbers, AppliesTheRuleToEach) {
  EXPECT_THAT(ReadNumbers(List({"1", "2"})), ::testing::ElementsAre(1.0, 2.0));
  EXPECT_THAT(Refusal([] { ReadNumbers(List({"1", "-2"}), kPositive); }), HasSubstr("> 0"));
}

TEST(MapReader, RefusesUnknownKeyWithDidYouMean) {
  const ConfigNode node = Map({"mesh", "gravity_ms2"});
  MapReader reader(node);
  reader.Require("mesh");
  reader.Optional("gravity_m_s2");
  EXPECT_EQ(Refusal([&] { reader.Finish(); }),
            "robot.yaml:7:1: unknown key 'gravity_ms2' (did you mean 'gravity_m_s2'?); allowed: "
            "mesh, gravity_m_s2");
}

TEST(MapReader, FinishesWhereEveryKeyWasAskedFor) {
  const ConfigNode node = Map({"mesh", "scale"});
  MapReader reader(node);
  reader.Require("mesh");
  EXPECT_EQ(reader.Number("scale", 5.0), 1.0);
  EXPECT_EQ(reader.Number("offset", 5.0), 5.0);
  EXPECT_EQ(Refusal([&] { reader.Finish(); }), "");
}

TEST(MapReader, NamesTheMissingKeyAndWhatStandsInItsPlace) {
  const ConfigNode node = Map({"paht_m"});
  MapReader reader(node);
  EXPECT_EQ(Refusal([&] { reader.Require("path_m"); }),
            "robot.yaml:1:1: key 'path_m' is missing (did you mean it by 'paht_m'?)");
  EXPECT_EQ(Refusal([&] { reader.Require("name"); }), "robot.yaml:1:1: key 'name' is missing");
}

TEST(MapReader, RefusesKeysGivenTwiceEmptyKeysAndWhatIsNoMap) {
  EXPECT_THAT(Refusal([] { MapReader reader(Map({"mesh", "mesh"})); }), HasSubstr("given twice"));
  EXPECT_THAT(Refusal([] { MapReader reader(List({"1"})); }), HasSubstr("must be a map"));
  ConfigNode node = Map({"mesh"});
  node.entries[0].value.kind = ConfigNode::Kind::kNull;
  MapReader reader(node);
  EXPECT_EQ(reader.Optional("mesh"), nullptr);
  EXPECT_THAT(Refusal([&] { reader.Require("mesh"); }), HasSubstr("must have a value"));
}

}  // namespace
}  // namespace palpate

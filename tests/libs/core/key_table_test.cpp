// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/key_table.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "libs/core/config_reader.hpp"

namespace palpate {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

const KeyTable& CablesOfTheTest() {
  static const KeyTable keys{
      .title = "cable",
      .about = "A cable.",
      .keys = {{"name", value::Text(), kRequired, "Its name."},
               {"limit_N", value::Real(kPositive), Default(20.0), "Its limit."},
               {"turns", value::WholeNumber(1, 4), RequiredFor("`kind: wound`"), "Its turns."}},
      .open_keys = {{"<drive>.offset_m", value::Real(), kOptional, "An offset."}}};
  return keys;
}

ConfigNode MapOf(const std::vector<std::pair<std::string, std::string>>& entries) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kMap;
  node.where = {"a.yaml", 1, 1};
  for (const auto& [key, text] : entries) {
    ConfigNode entry;
    entry.kind = ConfigNode::Kind::kScalar;
    entry.text = text;
    entry.path = key;
    entry.where = entry.key_where = {"a.yaml", 2, 3};
    node.entries.push_back({key, entry});
  }
  return node;
}

std::string Message(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(KeyTable, FindsKeysAndOpenKeys) {
  const KeyTable& keys = CablesOfTheTest();
  EXPECT_EQ(keys.Find("limit_N")->meaning, "Its limit.");
  EXPECT_EQ(keys.Find("north.offset_m")->meaning, "An offset.");
  EXPECT_EQ(keys.Find(".offset_m"), nullptr);
  EXPECT_EQ(keys.Find("limit"), nullptr);
}

TEST(KeyTable, KnowsTheUnitOfAKey) {
  EXPECT_EQ(UnitOf("density_kg_m3"), "kg/m³");
  EXPECT_EQ(UnitOf("gravity_m_s2"), "m/s²");
  EXPECT_EQ(UnitOf("compliance_m_N"), "m/N");
  EXPECT_EQ(UnitOf("t_s"), "s");
  EXPECT_EQ(UnitOf("fx_px"), "px");
  EXPECT_EQ(UnitOf("<cable>.displacement_m"), "m");
  EXPECT_EQ(UnitOf("name"), "");
  EXPECT_EQ(UnitOf("m"), "");
}

TEST(KeyTable, RefusesAKeyInAnotherUnitOrWithoutOne) {
  EXPECT_EQ(Message([] {
              RefuseForeignUnits(MapOf({{"limit_kN", "1"}}), CablesOfTheTest());
            }),
            "a.yaml:2:3: key 'limit_kN': the unit 'kN' does not fit: write 'limit_N'");
  EXPECT_THAT(Message([] {
                RefuseForeignUnits(MapOf({{"limit", "1"}}), CablesOfTheTest());
              }),
              EndsWith("the unit is missing: write 'limit_N'"));
  EXPECT_EQ(Message([] { RefuseForeignUnits(MapOf({{"limit_N", "1"}}), CablesOfTheTest()); }), "");
}

TEST(KeyTable, GivesTypeRangeAndPresenceToTheReader) {
  const ConfigNode node = MapOf({{"name", "north"}, {"limit_N", "-1"}});
  MapReader reader(node, CablesOfTheTest());
  std::string name;
  reader.Read("name", &name);
  EXPECT_EQ(name, "north");
  double limit_N = 0.0;
  EXPECT_THAT(Message([&] { reader.Read("limit_N", &limit_N); }), HasSubstr("must be > 0, not -1"));
  int turns = 0;
  EXPECT_THAT(Message([&] { reader.Read("turns", &turns); }), HasSubstr("'turns' is missing"));
  double offset_m = 7.0;
  reader.Read("north.offset_m", &offset_m);
  EXPECT_EQ(offset_m, 7.0);
}

TEST(KeyTable, ListsTheAllowedKeysWhereOneIsUnknown) {
  const ConfigNode node = MapOf({{"nam", "north"}});
  MapReader reader(node, CablesOfTheTest());
  reader.Optional("name");
  reader.Optional("limit_N");
  EXPECT_EQ(Message([&] { reader.Finish(); }),
            "a.yaml:2:3: unknown key 'nam' (did you mean 'name'?); allowed: name, limit_N");
}

TEST(KeyTable, TakesDefaultsAsYamlAndAsJson) {
  EXPECT_EQ(Default(0.0015).json, "0.0015");
  EXPECT_EQ(Default(true).text, "true");
  EXPECT_EQ(Default("tet10").text, "tet10");
  EXPECT_EQ(Default("tet10").json, "\"tet10\"");
  EXPECT_EQ(Default(Eigen::Vector3d(0, 0, -9.81)).json, "[0, 0, -9.81]");
}

TEST(KeyTableDeathTest, AKeyThatIsNotInTheTableCannotBeAskedFor) {
  const ConfigNode node = MapOf({{"name", "north"}});
  MapReader reader(node, CablesOfTheTest());
  EXPECT_DEATH(reader.Optional("length_m"), "is not in the table");
}

TEST(KeyTableDeathTest, AKeyOfTheTableThatIsNeverAskedForIsAFaultOfTheReader) {
  const ConfigNode node = MapOf({{"name", "north"}});
  MapReader reader(node, CablesOfTheTest());
  reader.Require("name");
  EXPECT_DEATH(reader.Finish(), "limit_N is in the table and was not asked for");
}

}  // namespace
}  // namespace palpate

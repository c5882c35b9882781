// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "libs/scenario/effect_places.hpp"
#include "libs/scenario/robot_names.hpp"
#include "tests/support/robots.hpp"
#include "tests/system/blind/cause_menu.hpp"
#include "tests/system/blind/judge/made_up.hpp"

/// What is hidden.
namespace palpate::blind {
namespace {

constexpr std::uint64_t kFixedSeed = 4711;
constexpr int kCases = 2000;

TEST(BlindCase, AnyTwentySeedsInARowAreTheMix) {
  const robot::RobotDescription robot = test_support::FourLegRobot();
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{13}, kFixedSeed}) {
    std::map<CaseKind, int> kinds;
    for (std::uint64_t i = 0; i < 20; ++i) ++kinds[DrawCase(first + i, robot).kind];
    EXPECT_EQ(kinds[CaseKind::kHealthy], 5);
    EXPECT_EQ(kinds[CaseKind::kOneCause], 9);
    EXPECT_EQ(kinds[CaseKind::kTwoCauses], 3);
    EXPECT_EQ(kinds[CaseKind::kOutside], 2);
    EXPECT_EQ(kinds[CaseKind::kCorrupted], 1);
  }
}

TEST(BlindCase, FollowsFromItsSeedAlone) {
  const robot::RobotDescription robot = test_support::FourLegRobot();
  for (std::uint64_t seed = kFixedSeed; seed < kFixedSeed + 40; ++seed) {
    const BlindCase a = DrawCase(seed, robot);
    const BlindCase b = DrawCase(seed, robot);
    ASSERT_EQ(a.effects.size(), b.effects.size());
    for (std::size_t i = 0; i < a.effects.size(); ++i) {
      EXPECT_EQ(Describe(a.effects[i]), Describe(b.effects[i]));
    }
    EXPECT_EQ(a.without, b.without);
    EXPECT_EQ(a.corruption, b.corruption);
  }
}

TEST(BlindCase, MenuAndWhatIsLeftOutAreTheCatalogue) {
  std::multiset<std::string> mine;
  for (const MenuItem& item : CauseMenu()) mine.emplace(item.id);
  for (const LeftOut& left_out : LeftOutOfMenu()) mine.emplace(left_out.id);
  std::multiset<std::string> catalogue;
  for (const auto& kind : scenario::EffectCatalogue()) catalogue.emplace(kind.id);
  EXPECT_EQ(mine, catalogue);
}

void ExpectThatTheBenchTakes(const scenario::ActiveEffect& effect,
                             const scenario::RobotNames& names) {
  const auto* kind = scenario::FindEffect(effect.id);
  EXPECT_THAT(scenario::PlacesOn(*kind, names), testing::Contains(effect.where));
  std::size_t known = 0;
  for (const auto& parameter : kind->parameters) {
    const auto found = effect.parameters.find(std::string(parameter.name));
    if (found == effect.parameters.end()) {
      EXPECT_FALSE(parameter.required) << Describe(effect);
      continue;
    }
    ++known;
    EXPECT_GE(found->second, parameter.min) << Describe(effect);
    EXPECT_LE(found->second, parameter.max) << Describe(effect);
  }
  EXPECT_EQ(known, effect.parameters.size()) << Describe(effect);
}

TEST(BlindCase, EveryCauseAndPlaceComesWithParametersThatTheBenchTakes) {
  for (const std::string name : {"four_leg", "rod"}) {
    const robot::RobotDescription robot = test_support::ReadRobot(name);
    const scenario::RobotNames names = scenario::NamesOf(robot);
    std::set<std::string> seen;
    std::set<std::string> menu;
    for (const MenuItem& item : MenuFor(robot)) menu.emplace(item.id);
    for (std::uint64_t seed = kFixedSeed; seed < kFixedSeed + kCases; ++seed) {
      for (const auto& effect : DrawCase(seed, robot).effects) {
        ExpectThatTheBenchTakes(effect, names);
        seen.insert(effect.id);
      }
    }
    EXPECT_EQ(seen, menu) << name;
  }
}

TEST(BlindCase, CablesInEyeletsRub) {
  const auto has = [](const std::string& robot, const std::string& id) {
    const auto menu = MenuFor(test_support::ReadRobot(robot));
    return std::any_of(menu.begin(), menu.end(), [&](const MenuItem& one) { return one.id == id; });
  };
  EXPECT_TRUE(has("rod", "cable_friction"));
  EXPECT_FALSE(has("four_leg", "cable_friction"));
}

TEST(BlindCase, TwoCausesDifferInKindAndOneIsWithheldWithAllThatDoTheSame) {
  const robot::RobotDescription robot = test_support::FourLegRobot();
  std::set<Corruption> corruptions;
  bool twin = false;
  bool general = false;
  for (std::uint64_t seed = kFixedSeed; seed < kFixedSeed + kCases; ++seed) {
    const BlindCase drawn = DrawCase(seed, robot);
    corruptions.insert(drawn.corruption);
    if (drawn.kind == CaseKind::kTwoCauses) {
      EXPECT_NE(drawn.effects[0].id, drawn.effects[1].id);
    }
    EXPECT_EQ(drawn.without.empty(), drawn.kind != CaseKind::kOutside);
    if (drawn.without.empty()) continue;
    EXPECT_EQ(drawn.without[0], drawn.effects[0].id);
    if (drawn.without[0] == "cable_elasticity") {
      EXPECT_THAT(drawn.without, testing::ElementsAre("cable_elasticity", "cable_cutting"));
      twin = true;
    }
    if (drawn.without[0] == "payload") {
      EXPECT_THAT(drawn.without, testing::ElementsAre("payload", "permanent_force"));
      general = true;
    }
  }
  EXPECT_TRUE(twin);
  EXPECT_TRUE(general);
  EXPECT_EQ(corruptions.size(), 6u);
}

}  // namespace
}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <string>

#include "libs/core/error.hpp"
#include "tests/support/robots.hpp"
#include "tests/system/blind/blind_case.hpp"
#include "tests/system/blind/blind_set.hpp"
#include "tests/system/blind/cause_menu.hpp"
#include "tests/system/blind/rod_meshes.hpp"

/// Which cases a set has.
namespace palpate::blind {
namespace {

constexpr const char* kKindVariable = "PALPATE_BLIND_KIND";

/// PALPATE_BLIND_KIND while it lives.
struct KindFromEnvironment {
  explicit KindFromEnvironment(const char* kind) { setenv(kKindVariable, kind, 1); }
  ~KindFromEnvironment() { unsetenv(kKindVariable); }
};

TEST(BlindSet, HasAllSeedsOrThoseOfItsKind) {
  const robot::RobotDescription robot = test_support::ReadRobot("four_leg");
  BlindSet set{.cases = 4, .seed = 41};
  EXPECT_THAT(set.Seeds(robot), testing::ElementsAre(41, 42, 43, 44));
  set.kind = CaseKind::kCorrupted;
  EXPECT_THAT(set.Seeds(robot), testing::ElementsAre(50, 70, 90, 110));
}

TEST(BlindSet, HidesAsManyOfEveryCauseAsItIsAskedFor) {
  const robot::RobotDescription robot = test_support::ReadRobot("pneumatic_finger");
  std::map<std::string, int> hidden;
  for (const std::uint64_t seed : BlindSet{.cases = 3, .cause = "each"}.Seeds(robot)) {
    const BlindCase drawn = DrawCase(seed, robot);
    ASSERT_EQ(drawn.effects.size(), 1U) << seed;
    ++hidden[drawn.effects.front().id];
  }
  EXPECT_EQ(hidden.size(), MenuFor(robot).size());
  for (const auto& [cause, count] : hidden) EXPECT_EQ(count, 3) << cause;
  const BlindSet leaks{.cases = 4, .cause = "leak"};
  for (const std::uint64_t seed : leaks.Seeds(robot))
    EXPECT_EQ(DrawCase(seed, robot).effects.front().id, "leak") << seed;
}

TEST(BlindSet, OfEachRobotHasASetAndAFolderForEveryOne) {
  const std::vector<BlindSet> one =
      BlindSet{.cases = 2, .folder = "kept", .robot = "rod"}.OfRobots();
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].folder, "kept");
  const std::vector<BlindSet> each =
      BlindSet{.cases = 2, .folder = "kept", .robot = "each"}.OfRobots();
  ASSERT_EQ(each.size(), 4U);
  EXPECT_EQ(each[1].robot, "rod");
  EXPECT_EQ(each[1].folder, "kept/rod");
  EXPECT_EQ(each[1].cases, 2);
}

TEST(BlindSet, RefusesACauseThatTheRobotCannotHave) {
  const BlindSet set{.cases = 1, .cause = "leek"};
  EXPECT_THAT([&] { set.Seeds(test_support::ReadRobot("pneumatic_finger")); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("did you mean 'leak'")));
  EXPECT_THROW((BlindSet{.cases = 1, .cause = "leak"}.Seeds(test_support::ReadRobot("rod"))),
               InputError);
  EXPECT_THROW((BlindSet{.cases = 1, .kind = CaseKind::kHealthy, .cause = "leak"}.Seeds(
                   test_support::ReadRobot("pneumatic_finger"))),
               InputError);
}

TEST(BlindSet, TakesEachKindByTheNameThatItsCasesArePrintedWith) {
  for (const CaseKind kind : {CaseKind::kHealthy, CaseKind::kOneCause, CaseKind::kTwoCauses,
                              CaseKind::kOutside, CaseKind::kCorrupted}) {
    const KindFromEnvironment environment(ToString(kind).c_str());
    const BlindSet set = BlindSet::FromEnvironment(1);
    ASSERT_TRUE(set.kind.has_value()) << ToString(kind);
    EXPECT_EQ(KindOf(set.Seeds(test_support::ReadRobot("four_leg")).front()), kind)
        << ToString(kind);
  }
}

TEST(BlindSet, RefusesAKindThatThereIsNot) {
  const KindFromEnvironment environment("two");
  EXPECT_THAT([] { BlindSet::FromEnvironment(1); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr(
                  "PALPATE_BLIND_KIND is 'two', none of: healthy, one cause, two causes")));
}

TEST(BlindSet, HasRodsOnCoarserAndOnFinerMeshes) {
  int finer = 0;
  const BlindSet set{.cases = 12, .kind = CaseKind::kHealthy};
  for (const std::uint64_t seed : set.Seeds(test_support::ReadRobot("rod"))) {
    const RodMeshes meshes = MeshesOfRod(seed);
    EXPECT_NE(meshes.body, meshes.diagnosed) << seed;
    finer += meshes.body == "rod.msh";
  }
  EXPECT_EQ(finer, 6);
}

}  // namespace
}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <cstdlib>

#include "libs/core/error.hpp"
#include "tests/system/blind/blind_set.hpp"
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
  BlindSet set{.cases = 4, .seed = 41};
  EXPECT_THAT(set.Seeds(), testing::ElementsAre(41, 42, 43, 44));
  set.kind = CaseKind::kCorrupted;
  EXPECT_THAT(set.Seeds(), testing::ElementsAre(50, 70, 90, 110));
}

TEST(BlindSet, TakesEachKindByTheNameThatItsCasesArePrintedWith) {
  for (const CaseKind kind : {CaseKind::kHealthy, CaseKind::kOneCause, CaseKind::kTwoCauses,
                              CaseKind::kOutside, CaseKind::kCorrupted}) {
    const KindFromEnvironment environment(ToString(kind).c_str());
    const BlindSet set = BlindSet::FromEnvironment(1);
    ASSERT_TRUE(set.kind.has_value()) << ToString(kind);
    EXPECT_EQ(KindOf(set.Seeds().front()), kind) << ToString(kind);
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
  for (const std::uint64_t seed : BlindSet{.cases = 12, .kind = CaseKind::kHealthy}.Seeds()) {
    const RodMeshes meshes = MeshesOfRod(seed);
    EXPECT_NE(meshes.body, meshes.diagnosed) << seed;
    finer += meshes.body == "rod.msh";
  }
  EXPECT_EQ(finer, 6);
}

}  // namespace
}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <set>

#include "libs/core/check.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/sha256.hpp"
#include "libs/core/status.hpp"

namespace palpate {
namespace {

TEST(Status, StartsAsAFailure) {
  const Status status;
  EXPECT_FALSE(status.ok());
  EXPECT_EQ(status.code(), StatusCode::kNotRun);
  EXPECT_TRUE(Status::Ok().ok());
}

TEST(Status, EachCodeHasAWordOfItsOwn) {
  std::set<std::string_view> words;
  const int last = static_cast<int>(StatusCode::kUncertain);
  for (int code = 0; code <= last; ++code) words.insert(ToString(static_cast<StatusCode>(code)));
  EXPECT_EQ(words.size(), static_cast<size_t>(last) + 1);
  EXPECT_EQ(ToString(StatusCode::kTangentialUnobservable), "tangential_unobservable");
}

TEST(SourceLocation, LeavesOutWhatIsUnknown) {
  EXPECT_EQ((SourceLocation{"a.yaml", 3, 7}.ToString()), "a.yaml:3:7");
  EXPECT_EQ((SourceLocation{"a.yaml", 3, 0}.ToString()), "a.yaml:3");
  EXPECT_EQ((SourceLocation{"a.yaml", 0, 7}.ToString()), "a.yaml");
  EXPECT_STREQ(InputError({"a.yaml", 3, 7}, "no").what(), "a.yaml:3:7: no");
}

TEST(CheckDeathTest, PrintsConditionAndValuesAndAborts) {
  const int nodes = 3;
  EXPECT_DEATH(PALPATE_CHECK(nodes == 4, nodes, "nodes"), "check failed: nodes == 4, with 3 nodes");
}

TEST(Check, CostsNothingWhereThePromiseHolds) { PALPATE_CHECK(true); }

TEST(Clock, MonotonicTimeNeverGoesBack) {
  std::int64_t before_ns = MonotonicNow_ns();
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t now_ns = MonotonicNow_ns();
    ASSERT_GE(now_ns, before_ns);
    before_ns = now_ns;
  }
}

TEST(Clock, WallTimeCountsNanosecondsSinceTheEpoch) {
  constexpr std::int64_t kYear2020_ns = 1'577'836'800'000'000'000;
  constexpr std::int64_t kYear2200_ns = 7'258'118'400'000'000'000;
  EXPECT_GT(WallNow_ns(), kYear2020_ns);
  EXPECT_LT(WallNow_ns(), kYear2200_ns);
}

TEST(Clock, IsAnArgumentThatATestStepsByHand) {
  std::int64_t now_ns = 5;
  const Clock clock = [&] { return now_ns; };
  now_ns = 8;
  EXPECT_EQ(clock(), 8);
}

// Vectors of FIPS 180-4 (NIST, "SHA-256 examples"), and lengths around the block size, whose
// digests sha256sum computed.
TEST(Sha256, AgreesWithTheStandard) {
  EXPECT_EQ(Sha256Hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256Hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256Hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256Hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PadsAroundTheBlockSize) {
  EXPECT_EQ(Sha256Hex(std::string(55, 'b')),
            "eb2c86e932179f4ba13fe8715a26124b77d6bad290b9b4c1cc140cf633300c19");
  EXPECT_EQ(Sha256Hex(std::string(56, 'b')),
            "a5fc6e203a4c2b657d0d153885932414b2ffc6a93f0f8bf8b3183315e5a7212c");
  EXPECT_EQ(Sha256Hex(std::string(64, 'b')),
            "a0fab1377f49a759b57f63318262ebe89fabfc990e8e93ceac2984561482b9d4");
}

}  // namespace
}  // namespace palpate

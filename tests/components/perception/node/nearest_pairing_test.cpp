// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/nearest_pairing.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <vector>

namespace palpate::perception {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kFramePeriod_ns = 33 * kMillisecond_ns;
const FrameSet::Time kBegin{};

bool AddDepthAt(NearestPairing& pairing, std::int64_t stamp_ns, FrameSet::Time now = kBegin) {
  FrameSet set;
  set.stamp_ns = stamp_ns;
  set.depth.emplace();
  return pairing.AddDepth(std::move(set), now);
}

/// A colour image whose one pixel tells it from others.
void AddColorAt(NearestPairing& pairing, std::int64_t stamp_ns, std::uint8_t value = 0) {
  pairing.AddColor(stamp_ns, rgbd::ColorImage(1, 1, value), Status::Ok());
}

/// Both streams at 30 Hz, colour 7 ms later, so that the periods are known.
void Warm(NearestPairing& pairing, int frames) {
  for (int i = 0; i < frames; ++i) {
    AddDepthAt(pairing, i * kFramePeriod_ns);
    AddColorAt(pairing, i * kFramePeriod_ns + 7 * kMillisecond_ns);
    while (pairing.Take(true, kBegin)) {
    }
  }
}

TEST(NearestPairing, ADepthImageHasTheColourThatIsNearestInTime) {
  NearestPairing pairing(milliseconds(100), 0.0);
  AddColorAt(pairing, 0, 1);
  AddDepthAt(pairing, 20 * kMillisecond_ns);
  EXPECT_FALSE(pairing.Take(true, kBegin)) << "a nearer one may follow";
  AddColorAt(pairing, 30 * kMillisecond_ns, 2);
  const auto set = pairing.Take(true, kBegin);
  ASSERT_TRUE(set && set->color);
  EXPECT_EQ(set->stamp_ns, 20 * kMillisecond_ns);
  EXPECT_EQ(set->color->values[0], 2);
}

TEST(NearestPairing, AnEqualStampIsTakenAtOnce) {
  NearestPairing pairing(milliseconds(100), 0.0);
  AddColorAt(pairing, 20 * kMillisecond_ns, 5);
  AddDepthAt(pairing, 20 * kMillisecond_ns);
  const auto set = pairing.Take(true, kBegin);
  ASSERT_TRUE(set && set->color);
  EXPECT_EQ(set->color->values[0], 5);
}

TEST(NearestPairing, TheToleranceIsThreeQuartersOfTheSlowerPeriod) {
  NearestPairing pairing(milliseconds(100), 0.0);
  EXPECT_FALSE(pairing.tolerance_ns());
  Warm(pairing, 10);
  EXPECT_EQ(pairing.tolerance_ns(), kFramePeriod_ns * 3 / 4);
  EXPECT_EQ(NearestPairing(milliseconds(100), 0.005).tolerance_ns(), 5 * kMillisecond_ns);
}

TEST(NearestPairing, WhereColourWasLostTheDepthComesWithoutIt) {
  NearestPairing pairing(milliseconds(100), 0.010);
  AddColorAt(pairing, 0);
  AddDepthAt(pairing, 30 * kMillisecond_ns);
  AddColorAt(pairing, 60 * kMillisecond_ns);
  const auto set = pairing.Take(true, kBegin);
  ASSERT_TRUE(set);
  EXPECT_FALSE(set->color);
}

TEST(NearestPairing, ASlowColourGoesWithSeveralDepthImages) {
  NearestPairing pairing(milliseconds(100), 0.0);
  int with_color = 0;
  for (int i = 0; i < 40; ++i) {
    AddDepthAt(pairing, i * kFramePeriod_ns);
    if (i % 2 == 0) AddColorAt(pairing, i * kFramePeriod_ns);
    while (const auto set = pairing.Take(true, kBegin)) with_color += set->color ? 1 : 0;
  }
  EXPECT_GE(with_color, 20);
  EXPECT_EQ(pairing.tolerance_ns(), 2 * kFramePeriod_ns * 3 / 4);
}

TEST(NearestPairing, WithoutColourTheNewestDepthIsTakenAtOnce) {
  NearestPairing pairing(milliseconds(100), 0.0);
  AddDepthAt(pairing, 1);
  AddDepthAt(pairing, 2);
  EXPECT_EQ(pairing.Take(false, kBegin)->stamp_ns, 2);
  EXPECT_EQ(pairing.dropped(), 1u);
  EXPECT_FALSE(pairing.Take(false, kBegin));
}

TEST(NearestPairing, ADepthImageWaitsForColourOnlySoLong) {
  NearestPairing pairing(milliseconds(100), 0.0);
  AddDepthAt(pairing, 1);
  EXPECT_EQ(pairing.NextOverdue(), kBegin + milliseconds(100));
  EXPECT_FALSE(pairing.Take(true, kBegin + milliseconds(99)));
  const auto set = pairing.Take(true, kBegin + milliseconds(100));
  ASSERT_TRUE(set);
  EXPECT_FALSE(set->color);
  EXPECT_FALSE(pairing.NextOverdue());
}

TEST(NearestPairing, ARepeatedStampIsNotTakenAndOneThatFallsBeginsAgain) {
  NearestPairing pairing(milliseconds(100), 0.0);
  EXPECT_TRUE(AddDepthAt(pairing, 1000 * kMillisecond_ns));
  EXPECT_FALSE(AddDepthAt(pairing, 1000 * kMillisecond_ns));
  AddColorAt(pairing, 1000 * kMillisecond_ns);
  ASSERT_TRUE(pairing.Take(true, kBegin));
  EXPECT_TRUE(AddDepthAt(pairing, 10 * kMillisecond_ns));
  EXPECT_FALSE(pairing.Take(true, kBegin)) << "colour of the sequence before";
  AddColorAt(pairing, 10 * kMillisecond_ns);
  EXPECT_TRUE(pairing.Take(true, kBegin)->color.has_value());
}

/// Streams of one driver, each with its own jitter and losses.
struct Streams {
  std::vector<std::int64_t> depth_ns, color_ns;
};

Streams RandomStreams(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int64_t> jitter_ns(-5 * kMillisecond_ns, 5 * kMillisecond_ns);
  std::bernoulli_distribution lost(0.1);
  Streams streams;
  for (int i = 0; i < 300; ++i) {
    if (!lost(random)) streams.depth_ns.push_back(i * kFramePeriod_ns + jitter_ns(random));
    if (!lost(random))
      streams.color_ns.push_back(i * kFramePeriod_ns + 9 * kMillisecond_ns + jitter_ns(random));
  }
  return streams;
}

TEST(NearestPairing, UnderJitterAndLossesNoOtherColourIsNearerAndFewFramesAreLost) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Streams streams = RandomStreams(seed);
    NearestPairing pairing(milliseconds(100), 0.0);
    std::size_t next_color = 0, whole = 0;
    for (const std::int64_t depth_ns : streams.depth_ns) {
      AddDepthAt(pairing, depth_ns);
      // Colour comes up to the first that is not before this depth image.
      while (next_color < streams.color_ns.size() &&
             (next_color == 0 || streams.color_ns[next_color - 1] < depth_ns)) {
        AddColorAt(pairing, streams.color_ns[next_color],
                   static_cast<std::uint8_t>(next_color % 256));
        ++next_color;
      }
      while (const auto set = pairing.Take(true, kBegin)) {
        if (!set->color) continue;
        ++whole;
        std::int64_t nearest_ns = streams.color_ns.front();
        std::size_t nearest = 0;
        for (std::size_t i = 0; i < streams.color_ns.size(); ++i) {
          if (std::abs(streams.color_ns[i] - set->stamp_ns) <
              std::abs(nearest_ns - set->stamp_ns)) {
            nearest_ns = streams.color_ns[i];
            nearest = i;
          }
        }
        ASSERT_EQ(set->color->values[0], nearest % 256) << "seed " << seed;
        if (const auto tolerance = pairing.tolerance_ns()) {
          EXPECT_LE(std::abs(nearest_ns - set->stamp_ns), *tolerance);
        }
      }
    }
    // A depth image is lost with its own colour image, in a tenth of the cases, and no more.
    EXPECT_GE(whole, streams.depth_ns.size() * 8 / 10) << "seed " << seed;
  }
}

}  // namespace
}  // namespace palpate::perception

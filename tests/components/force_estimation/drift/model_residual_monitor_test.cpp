// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/drift/model_residual_monitor.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

/// Twelve points of a robot with two cables and a region, seen with noise ten times a second, and a
/// model that is off by so much.
namespace palpate::force_estimation {
namespace {

using GapState = GapReport::State;
using testing::HasSubstr;

constexpr double kCloudNoise_m = 4e-4;
constexpr double kFramePeriod_s = 0.1;
constexpr int kPoints = 12;
constexpr unsigned kSeed = 5;

/// m per coordinate of a point at a time.
using Off = std::function<double(int point, double t_s)>;

class GapWatchTest : public testing::Test {
 protected:
  void Watch(double from_s, double to_s, const Off& off_m) {
    for (double t_s = from_s; t_s < to_s; t_s += kFramePeriod_s) watch_.Add(t_s, Frame(t_s, off_m));
  }
  ModelGapReport Frame(double t_s, const Off& off_m) {
    ModelGapReport report{
        {}, {{"body", 0, 0, 0}, {"leg", 0, 0, 0}}, {{"north", 0, 0, 0}, {"south", 0, 0, 0}}};
    std::normal_distribution<double> normal(0.0, kCloudNoise_m);
    for (int p = 0; p < kPoints; ++p) {
      double squares_m2 = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const double residual_m = off_m(p, t_s) + normal(random_);
        squares_m2 += residual_m * residual_m;
      }
      Add(squares_m2, &report.whole);
      Add(squares_m2, &report.regions[IsOfLeg(p) ? 1 : 0]);
      Add(squares_m2, &report.cables[IsOfNorth(p) ? 0 : 1]);
    }
    Finish(&report.whole);
    for (ModelGapPart& part : report.regions) Finish(&part);
    for (ModelGapPart& part : report.cables) Finish(&part);
    return report;
  }

  static bool IsOfNorth(int point) { return point < 6; }
  static bool IsOfLeg(int point) { return point % 3 == 0; }
  static void Add(double squares_m2, ModelGapPart* part) {
    part->residual_rms_m += squares_m2;
    ++part->sample_count;
  }
  static void Finish(ModelGapPart* part) {
    part->residual_rms_m = std::sqrt(part->residual_rms_m / (3.0 * part->sample_count));
    part->noise_rms_m = kCloudNoise_m;
  }
  static double Nothing(int /*point*/, double /*t_s*/) { return 0.0; }

  std::mt19937 random_{kSeed};
  ModelResidualMonitor watch_;
};

TEST_F(GapWatchTest, HoldsThroughMinutesOfNoise) {
  Watch(0.0, 9.0, Nothing);
  EXPECT_EQ(watch_.report().state, GapState::kLearning);
  for (double t_s = 9.0; t_s < 600.0; t_s += 1.0) {
    Watch(t_s, t_s + 1.0, Nothing);
    if (t_s < 12.0) continue;
    ASSERT_EQ(watch_.report().state, GapState::kHolds) << t_s << " s, seed " << kSeed;
  }
  EXPECT_NEAR(watch_.report().residual_rms_m, kCloudNoise_m, 0.2 * kCloudNoise_m);
}

TEST_F(GapWatchTest, NamesTheCableNextToWhichTheModelIsSuddenlyOff) {
  const auto off_m = [](int p, double t_s) { return t_s > 30.0 && IsOfNorth(p) ? 1e-3 : 0.0; };
  Watch(0.0, 30.0, off_m);
  ASSERT_EQ(watch_.report().state, GapState::kHolds);
  Watch(30.0, 36.0, off_m);
  ASSERT_EQ(watch_.report().state, GapState::kGrown) << "seed " << kSeed;
  EXPECT_THAT(watch_.report().advice, HasSubstr("cable north or its actuator"));
  EXPECT_THAT(watch_.report().advice, HasSubstr("palpate diagnose"));
}

TEST_F(GapWatchTest, NamesTheRegionThatHoldsTheGrowth) {
  const auto off_m = [](int p, double t_s) { return t_s > 20.0 && IsOfLeg(p) ? 1e-3 : 0.0; };
  Watch(0.0, 30.0, off_m);
  EXPECT_THAT(watch_.report().advice, HasSubstr("the material of leg"));
}

TEST_F(GapWatchTest, TellsWhatCameSlowlyFromWhatCameAtOnce) {
  Watch(0.0, 120.0, [](int, double t_s) { return 1e-5 * std::max(0.0, t_s - 15.0); });
  EXPECT_THAT(watch_.report().advice, HasSubstr("slow"));
  watch_ = ModelResidualMonitor();
  Watch(0.0, 120.0, [](int, double t_s) { return t_s > 60.0 ? 1e-3 : 0.0; });
  EXPECT_THAT(watch_.report().advice, HasSubstr("sudden"));
}

TEST_F(GapWatchTest, HoldsAgainWhereTheGrowthWent) {
  const auto off_m = [](int, double t_s) { return t_s > 20.0 && t_s < 30.0 ? 1e-3 : 0.0; };
  Watch(0.0, 29.0, off_m);
  ASSERT_EQ(watch_.report().state, GapState::kGrown);
  Watch(29.0, 40.0, off_m);
  EXPECT_EQ(watch_.report().state, GapState::kHolds);
  EXPECT_TRUE(watch_.report().advice.empty());
}

TEST_F(GapWatchTest, AModelThatIsFarOffFromTheStartIsSaidToBe) {
  Watch(0.0, 12.0, [](int, double) { return 3e-3; });
  EXPECT_EQ(watch_.report().state, GapState::kGrown);
  EXPECT_THAT(watch_.report().advice, HasSubstr("from the start"));
}

TEST_F(GapWatchTest, SaysThatNothingIsSeenWhereNothingWasEstimated) {
  Watch(0.0, 15.0, Nothing);
  for (double t_s = 15.0; t_s < 17.0; t_s += kFramePeriod_s) watch_.Add(t_s, {});
  EXPECT_EQ(watch_.report().state, GapState::kNotSeen);
  Watch(17.0, 19.5, Nothing);
  EXPECT_EQ(watch_.report().state, GapState::kHolds);
}

TEST_F(GapWatchTest, BeginsAnewWhereTimeGoesBack) {
  Watch(100.0, 115.0, Nothing);
  ASSERT_EQ(watch_.report().state, GapState::kHolds);
  Watch(0.0, 1.0, Nothing);
  EXPECT_EQ(watch_.report().state, GapState::kLearning);
}

}  // namespace
}  // namespace palpate::force_estimation

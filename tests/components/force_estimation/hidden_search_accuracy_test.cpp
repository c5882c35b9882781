// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "components/force_estimation/shape/hidden_search.hpp"
#include "tests/components/force_estimation/hidden_scene.hpp"

namespace palpate::force_estimation {
namespace {

/// Our robot as a camera at 0.45 m sees it: with linear elements and a few pushes, or, with
/// PALPATE_HIDDEN_TRIALS=n, its quadratic elements and so many.

const char* TrialsAskedFor() { return std::getenv("PALPATE_HIDDEN_TRIALS"); }

int Trials(int by_default) {
  return TrialsAskedFor() != nullptr ? std::atoi(TrialsAskedFor()) : by_default;
}

robot::RobotDescription SeenFourLeg() {
  robot::RobotDescription robot = QuickFourLegRobot();
  robot.feature_point_count = 85;  // of which the camera sees 25
  if (TrialsAskedFor() != nullptr) {
    robot.element = fem::ElementType::kTet10;
    robot.material.poissons_ratio = 0.45;
  }
  return robot;
}

double Quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

double Now_ms() {
  using Milliseconds = std::chrono::duration<double, std::milli>;
  return Milliseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// How well pushes were found.
struct Tally {
  std::vector<double> off_m, force_error, ci95_m;
  int pushes = 0, held = 0, wrong_count = 0;

  void Add(const std::vector<HiddenScene::Push>& truth, const std::vector<HiddenContact>& found) {
    wrong_count += found.size() == truth.size() ? 0 : 1;
    for (const HiddenScene::Push& push : truth) {
      ++pushes;
      if (found.empty()) continue;
      const auto off = [&](const HiddenContact& contact) {
        return (contact.rest_position_m - push.place_m).norm();
      };
      const auto nearest =
          std::min_element(found.begin(), found.end(),
                           [&](const auto& a, const auto& b) { return off(a) < off(b); });
      off_m.push_back(off(*nearest));
      ci95_m.push_back(nearest->location_ci95_m);
      force_error.push_back(std::abs(nearest->force_N / push.normal_N - 1.0));
      held += off(*nearest) <= nearest->location_ci95_m ? 1 : 0;
    }
  }
  void Print(const char* what) const {
    std::printf(
        "%s: %d pushes, off by %.1f mm median, %.1f mm at 90 %%; force by %.0f %% median, %.0f %% "
        "at 90 %%; 95 %% radius %.1f mm median, holds %d; %d wrong numbers of contacts\n",
        what, pushes, 1e3 * Quantile(off_m, 0.5), 1e3 * Quantile(off_m, 0.9),
        100.0 * Quantile(force_error, 0.5), 100.0 * Quantile(force_error, 0.9),
        1e3 * Quantile(ci95_m, 0.5), held, wrong_count);
  }
};

class HiddenSearchOnFourLeg : public testing::Test {
 protected:
  HiddenSearchOnFourLeg() : scene_(SeenFourLeg(), {0.343, -0.198, 0.275}, {0, 0, 0.065}) {
    EXPECT_TRUE(scene_.Respond().ok());
    EXPECT_GT(scene_.rows.size(), 20U);
  }

  std::vector<HiddenContact> FindAbout(const Unexplained& data) {
    return scene_.search->Find(data, 2, 1e-6, {}, 0.0);
  }

  /// Solves for the equilibrium with `found` and searches again about it, as long as the residual
  /// falls.
  std::vector<HiddenContact> FindAgain(const Unexplained& data, std::vector<HiddenContact> found,
                                       int rounds) {
    double left_m = data.residual_m.norm();
    for (int round = 0; round < rounds; ++round) {
      std::vector<HiddenScene::Push> pushes;
      for (const HiddenContact& contact : found) pushes.push_back(AsPush(contact));
      Unexplained about = data;
      about.residual_m -= scene_.MoveTo(pushes);
      if (about.residual_m.norm() >= left_m) break;
      left_m = about.residual_m.norm();
      about.left_m = about.residual_m;
      for (const HiddenScene::Push& push : pushes) {
        about.residual_m += scene_.ResponseAt(push.place_m) * push.force_N;
      }
      found = FindAbout(about);
    }
    return found;
  }

  static HiddenScene::Push AsPush(const HiddenContact& contact) {
    return {contact.rest_position_m, contact.tangential_N - contact.force_N * contact.normal,
            contact.force_N};
  }

  HiddenScene scene_;
  std::mt19937 random_{5};
};

TEST_F(HiddenSearchOnFourLeg, LocatesPushesThatTheCameraDoesNotSee) {
  Tally at_once, again;
  for (int trial = 0; trial < Trials(5); ++trial) {
    const std::vector<HiddenScene::Push> truth = {scene_.RandomPush(0.3, 1.5, 0.2, random_)};
    const Unexplained data = scene_.Observe(truth, random_);
    ASSERT_TRUE(scene_.Respond().ok());
    const std::vector<HiddenContact> found = FindAbout(data);
    ASSERT_FALSE(found.empty());
    at_once.Add(truth, found);
    again.Add(truth, FindAgain(data, found, 3));
  }
  at_once.Print("one hidden push, to first order");
  again.Print("one hidden push, found again about its equilibrium");
  EXPECT_LT(Quantile(at_once.off_m, 0.5), 0.02);
  EXPECT_LT(Quantile(again.off_m, 0.5), 0.008);
  EXPECT_LT(Quantile(again.force_error, 0.5), 0.15);
  EXPECT_LE(again.wrong_count, again.pushes / 10);
}

TEST_F(HiddenSearchOnFourLeg, TellsTwoPushesOnDifferentLegs) {
  Tally tally;
  for (int trial = 0; trial < Trials(4); ++trial) {
    std::vector<HiddenScene::Push> truth = {scene_.RandomPush(0.3, 0.8, 0.2, random_)};
    do {
      truth.resize(1);
      truth.push_back(scene_.RandomPush(0.3, 0.8, 0.2, random_));
    } while ((truth[0].place_m - truth[1].place_m).norm() < 0.08);
    const Unexplained data = scene_.Observe(truth, random_);
    ASSERT_TRUE(scene_.Respond().ok());
    tally.Add(truth, FindAgain(data, FindAbout(data), 5));
  }
  tally.Print("two hidden pushes, found again about their equilibrium");
  EXPECT_LT(Quantile(tally.off_m, 0.5), 0.03);
  EXPECT_LE(tally.wrong_count, tally.pushes / 3);
}

TEST_F(HiddenSearchOnFourLeg, IsQuietAndQuickAtRest) {
  constexpr int kFrames = 300;
  scene_.LookAtAllFeatures(51);
  const double respond_start_ms = Now_ms();
  ASSERT_TRUE(scene_.Respond().ok());
  const double start_ms = Now_ms();
  int alarms = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    alarms += FindAbout(scene_.Noise(random_)).empty() ? 0 : 1;
  }
  const double find_ms = (Now_ms() - start_ms) / kFrames;
  std::printf("%zu rows, %d candidates: responses in %.0f ms, %.2f ms to find nothing\n",
              scene_.rows.size(), scene_.search->CandidateCount(), start_ms - respond_start_ms,
              find_ms);
  EXPECT_EQ(alarms, 0);
}

}  // namespace
}  // namespace palpate::force_estimation

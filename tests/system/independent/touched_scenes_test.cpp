// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/independent/touched_scenes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "libs/core/statistics.hpp"
#include "libs/experiment/csv_table.hpp"
#include "tests/support/test_folder.hpp"

/// `palpate calibrate` and `palpate estimate` without options on scenes whose shapes CalculiX has
/// computed and whose images Embree has cast: neither the solver nor the camera are palpate's.
namespace palpate::test_support {
namespace {

namespace fs = std::filesystem;

constexpr double kSamePlace_m = 0.02;

/// Of the last frame of each recording.
struct Score {
  int there = 0;
  int found = 0;  ///< within kSamePlace_m, with a force
  int none = 0;   ///< forces where nothing touches
  int covered = 0;
  std::vector<double> errors;    ///< of |F|, relative
  std::vector<double> places_m;  ///< errors of them
  std::string missed;

  double MedianError() const { return Quantile(errors, 0.5); }
  double MedianPlace_m() const { return Quantile(places_m, 0.5); }
};

struct Estimated {
  Eigen::Vector3d position_m, force_N;
  double ci95_N;
};

/// Forces of the last frame of each recording.
std::map<std::string, std::vector<Estimated>> ReadLast(const fs::path& file) {
  const auto table = experiment::CsvTable::Read(file);
  std::map<std::string, double> last_s;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    double& t_s = last_s.try_emplace(std::string(table.Text(row, 0)), 0.0).first->second;
    t_s = std::max(t_s, table.Number(row, 1));
  }
  std::map<std::string, std::vector<Estimated>> forces;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string name(table.Text(row, 0));
    std::vector<Estimated>& of_recording = forces[name];
    if (table.Number(row, 1) < last_s[name] || table.Text(row, 6).empty()) continue;
    const auto vector = [&](std::size_t column) {
      return Eigen::Vector3d(table.Number(row, column), table.Number(row, column + 1),
                             table.Number(row, column + 2));
    };
    of_recording.push_back({vector(3), vector(6), table.Number(row, 9)});
  }
  return forces;
}

Score ScoreOf(const fs::path& file, const std::vector<TrueContact>& truth) {
  Score score;
  for (auto [name, estimated] : ReadLast(file)) {
    for (const TrueContact& contact : truth) {
      if (contact.recording != name) continue;
      ++score.there;
      const auto nearest = std::min_element(estimated.begin(), estimated.end(),
                                            [&](const Estimated& a, const Estimated& b) {
                                              return (a.position_m - contact.position_m).norm() <
                                                     (b.position_m - contact.position_m).norm();
                                            });
      const bool found = nearest != estimated.end() &&
                         (nearest->position_m - contact.position_m).norm() < kSamePlace_m;
      if (!found) {
        score.missed += " " + name;
        continue;
      }
      const double true_N = contact.force_N.norm();
      const double off_N = std::abs(nearest->force_N.norm() - true_N);
      ++score.found;
      score.covered += off_N <= nearest->ci95_N ? 1 : 0;
      score.errors.push_back(off_N / true_N);
      score.places_m.push_back((nearest->position_m - contact.position_m).norm());
      estimated.erase(nearest);
    }
    score.none += static_cast<int>(estimated.size());
  }
  return score;
}

std::ostream& operator<<(std::ostream& stream, const Score& score) {
  return stream << score.found << " of " << score.there << " found, median error "
                << 100.0 * score.MedianError() << " %, place " << 1e3 * score.MedianPlace_m()
                << " mm, " << score.covered << " covered, " << score.none
                << " false; missed:" << score.missed;
}

class TouchedScenes : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (std::system("command -v ccx > /dev/null") != 0) {
      GTEST_SKIP() << "CalculiX (ccx, Debian package calculix-ccx) is not installed";
    }
    TouchedScenesPlan plan{.robot = GetParam(),
                           .postures = 3,
                           .single = 3,
                           .pairs = 1,
                           .hidden = 1,
                           .weights = 3,
                           .alone = 1,
                           .frames = 2};
    truth_ = WriteTouchedScenes(plan, folder_ / "exp");
    robot_ = fs::path(PALPATE_SOURCE_DIR) / "config/robots" / (plan.robot + ".yaml");
  }

  void Calibrate() {
    command::CalibrateOptions options;
    options.robot = robot_;
    options.data = folder_ / "exp";
    options.out = calibration_ = folder_ / "calibration.yaml";
    ASSERT_EQ(command::Calibrate(options), 0);
  }

  Score Estimate(const std::string& recording = {}) {
    command::EstimateOptions options;
    options.robot = robot_;
    options.data = folder_ / "exp";
    options.calibration = calibration_;
    options.out = folder_ / "forces.csv";
    if (!recording.empty()) options.recordings = {recording};
    EXPECT_EQ(command::Estimate(options), 0);
    const Score score = ScoreOf(options.out, truth_);
    RecordProperty(recording.empty() ? "all" : recording, score.found);
    std::cout << GetParam() << " " << recording << ": " << score << std::endl;
    return score;
  }

  void RemoveContactFree() {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "exp/recordings")) {
      const std::string name = entry.path().filename();
      if (name.ends_with("rest") || name.ends_with("hold")) fs::remove_all(entry.path());
    }
  }

  TestFolder folder_;
  fs::path robot_, calibration_;
  std::vector<TrueContact> truth_;
};

/// With contact-free recordings, with the calibration file alone, and with neither.
TEST_P(TouchedScenes, DefaultCommandsFindTheContactsAndTheirForces) {
  Calibrate();
  const Score whole = Estimate();
  EXPECT_GE(whole.found, whole.there - 1) << whole;
  EXPECT_LE(whole.MedianError(), 0.06) << whole;
  EXPECT_EQ(whole.none, 0) << whole;
  EXPECT_GE(whole.covered, 0.9 * whole.found) << whole;
  EXPECT_LE(whole.MedianPlace_m(), 0.005) << whole;
  RemoveContactFree();
  const Score calibrated = Estimate();
  EXPECT_GE(calibrated.found, whole.found - 1) << calibrated;
  EXPECT_LE(calibrated.MedianError(), 0.08) << calibrated;
  EXPECT_EQ(calibrated.none, 0) << calibrated;
  calibration_.clear();
  const Score alone = Estimate();
  EXPECT_GE(alone.found, whole.found - 2) << alone;
  EXPECT_LE(alone.MedianError(), 0.20) << alone;
  EXPECT_GE(alone.covered, alone.found - 1) << alone;
}

/// What lies on the tip in the first image of all is an object.
TEST_P(TouchedScenes, AWeightThatLiesThereFromTheFirstFrameOnIsNoRobot) {
  Calibrate();
  RemoveContactFree();
  for (const TrueContact& contact : truth_) {
    if (contact.group != "weight") continue;
    const Score score = Estimate(contact.recording);
    EXPECT_EQ(score.found, 1) << score;
    EXPECT_LE(score.MedianError(), 0.15) << score;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, TouchedScenes, testing::Values("four_leg", "rod"),
                         [](const auto& robot) { return robot.param; });

}  // namespace
}  // namespace palpate::test_support

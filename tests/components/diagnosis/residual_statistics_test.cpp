// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/goodness_of_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace palpate::diagnosis {
namespace {

constexpr int kRecordings = 2;
constexpr int kSamples = 20;  // of each
constexpr int kMarkers = 4;
constexpr unsigned kLeaksSeed = 5;

/// Two recordings in which one of two cables goes up and down, the other stays; markers 0 and 1 lie
/// beside each other, and 2 and 3.
struct Scene {
  ObservedExperiment observed;
  Eigen::Matrix3Xd rest_m{3, kMarkers};
  LinearModel model;

  Scene() {
    rest_m << 0.0, 0.01, 1.0, 1.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0;
    observed.timeline.actuators = {{.name = "pulled"}, {.name = "still"}};
    for (int r = 0; r < kRecordings; ++r) {
      observed.recordings.push_back({.name = "r" + std::to_string(r), .kind = "ramp"});
      for (int s = 0; s < kSamples; ++s) {
        Sample& sample = observed.samples.emplace_back();
        sample.recording = r;
        sample.t_s = r * kSamples + s;
      }
      for (int coordinate = 0; coordinate < 3 * kMarkers; ++coordinate) {
        for (int s = 0; s < kSamples; ++s) {
          model.sample_of_row.push_back(r * kSamples + s);
          model.coordinate_of_row.push_back(coordinate);
        }
      }
    }
    const double middle_s[] = {kSamples / 2 - 0.5, 1.5 * kSamples - 0.5};
    const double end_s = kRecordings * kSamples;
    observed.timeline.t_s = {-1.0, middle_s[0], kSamples - 0.5, middle_s[1], end_s};
    for (const double pulled_m : {0.0, 0.01, 0.0, 0.01, 0.0}) {
      observed.timeline.command.emplace_back(Eigen::Vector2d(pulled_m, 0.002));
    }
    model.y = Eigen::VectorXd::Zero(std::ssize(model.sample_of_row));
  }

  using Value = std::function<double(const Sample& sample, int marker)>;
  /// In recording r1 alone.
  Eigen::VectorXd Residual(const Value& value) const {
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(model.y.size());
    for (Eigen::Index row = 0; row < residual.size(); ++row) {
      const auto k = static_cast<std::size_t>(row);
      const Sample& sample = observed.samples[static_cast<std::size_t>(model.sample_of_row[k])];
      if (sample.recording == 1) residual[row] = value(sample, model.coordinate_of_row[k] / 3);
    }
    return residual;
  }

  double Of(const Eigen::VectorXd& residual, const std::string& name) const {
    const ResidualStatistics tests(observed, rest_m, model);
    for (Eigen::Index k = 0; k < tests.count(); ++k) {
      if (tests.NameOf(k) == name) return tests.Of(residual)[k];
    }
    ADD_FAILURE() << "no test is called " << name;
    return std::nan("");
  }
};

TEST(ResidualStatistics, FindWhatNeighboursHaveInCommon) {
  const Scene scene;
  // From sample to sample there and back: nothing correlates with time.
  const auto in_turn = [](const Sample& sample) {
    return std::fmod(sample.t_s, 2.0) == 0.0 ? 1.0 : -1.0;
  };
  const Eigen::VectorXd alike =
      scene.Residual([&](const Sample& s, int marker) { return marker < 2 ? in_turn(s) : 0.0; });
  const Eigen::VectorXd opposed = scene.Residual(
      [&](const Sample& s, int marker) { return marker % 2 == 0 ? in_turn(s) : -in_turn(s); });
  const std::string pattern = "pattern over the body in recording r";
  // One of five pairs is alike, each weighed 4/5; the second has two alike and three opposed.
  EXPECT_GT(scene.Of(alike, pattern + "1"), 0.25 * alike.squaredNorm());
  EXPECT_LT(scene.Of(opposed, pattern + "1"), 0.0);
  EXPECT_EQ(scene.Of(alike, pattern + "0"), 0.0);
  EXPECT_LT(scene.Of(alike, "runs in recording r1"), 0.0);
}

/// Less what is constant, which belongs to the mesh.
TEST(ResidualStatistics, FindWhatGoesAlongWithTheCommands) {
  const Scene scene;
  const std::string with_commands = "residual along with the commands in recording r1";
  const Eigen::VectorXd residual = scene.Residual([&](const Sample& sample, int) {
    return 1e3 * scene.observed.timeline.CommandAt(sample.t_s)[0];
  });
  const Eigen::VectorXd own = residual.tail(residual.size() / kRecordings);
  const double about_mean = (own.array() - own.mean()).matrix().squaredNorm();
  EXPECT_NEAR(scene.Of(residual, with_commands), about_mean, 1e-9 * about_mean);
  EXPECT_LT(scene.Of(residual, "residual along with how fast the commands change in recording r1"),
            0.01 * about_mean);
  const Eigen::VectorXd constant = scene.Residual([](const Sample&, int marker) { return marker; });
  EXPECT_LT(scene.Of(constant, with_commands), 1e-9 * constant.squaredNorm());
}

TEST(ResidualStatistics, FindWhatGoesAlongWithTheirRates) {
  const Scene scene;
  const Eigen::VectorXd with_rate = scene.Residual(
      [&](const Sample& sample, int) { return sample.t_s < 1.5 * kSamples - 0.5 ? 1.0 : -1.0; });
  const double misfit = scene.Of(with_rate, "misfit of recording r1");
  EXPECT_NEAR(
      scene.Of(with_rate, "residual along with how fast the commands change in recording r1"),
      misfit, 1e-9 * misfit);
  EXPECT_LT(scene.Of(with_rate, "residual along with the commands in recording r1"), 0.02 * misfit);
}

TEST(ResidualStatistics, AreOfNoiseWhatChiSquaredSays) {
  const Scene scene;
  const ResidualStatistics tests(scene.observed, scene.rest_m, scene.model);
  std::mt19937 random(kLeaksSeed);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 2000;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(tests.count());
  for (int d = 0; d < kDraws; ++d) {
    mean += tests.Of(Eigen::VectorXd::NullaryExpr(scene.model.y.size(), [&] {
      return normal(random);
    })) / kDraws;
  }
  constexpr double kRows = kSamples * 3.0 * kMarkers;
  const auto expect = [&](const std::string& name, double expected) {
    for (Eigen::Index k = 0; k < tests.count(); ++k) {
      if (tests.NameOf(k) != name) continue;
      EXPECT_NEAR(mean[k], expected, 0.02 * kRows) << name << ", seed " << kLeaksSeed;
      EXPECT_EQ(tests.NameOf(tests.MisfitBeside(k)),
                name.starts_with("misfit") ? name : "misfit of recording r0");
    }
  };
  expect("misfit of all recordings", 2.0 * kRows);
  expect("misfit of recording r0", kRows);
  expect("runs in recording r0", 0.0);
  expect("pattern over the body in recording r0", 0.0);
  // One direction in each of the markers' coordinates.
  expect("residual along with the commands in recording r0", 3.0 * kMarkers);
  expect("residual along with how fast the commands change in recording r0", 3.0 * kMarkers);
}

/// A marker that is not seen, a robot of one marker, one without cables: fewer tests tell anything.
TEST(ResidualStatistics, TakeWhatThereIs) {
  Scene scene;
  scene.model.sample_of_row.erase(scene.model.sample_of_row.begin(),
                                  scene.model.sample_of_row.begin() + 3 * kSamples);
  scene.model.coordinate_of_row.erase(scene.model.coordinate_of_row.begin(),
                                      scene.model.coordinate_of_row.begin() + 3 * kSamples);
  scene.model.y.setZero(std::ssize(scene.model.sample_of_row));
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(scene.model.y.size());
  EXPECT_EQ(scene.Of(ones, "misfit of recording r0"), kSamples * 3.0 * (kMarkers - 1));
  EXPECT_GT(scene.Of(ones, "pattern over the body in recording r0"), 0.0);

  Scene bare;
  bare.rest_m = Eigen::Vector3d::Zero();
  bare.observed.timeline = {};
  const Eigen::VectorXd of_bare = Eigen::VectorXd::Ones(bare.model.y.size());
  EXPECT_EQ(bare.Of(of_bare, "pattern over the body in recording r1"), 0.0);
  EXPECT_EQ(bare.Of(of_bare, "residual along with the commands in recording r1"), 0.0);
}

}  // namespace
}  // namespace palpate::diagnosis

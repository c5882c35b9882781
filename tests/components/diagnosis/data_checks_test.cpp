// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/prepare/data_checks.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

namespace palpate::diagnosis {
namespace {

using testing::HasSubstr;

constexpr int kFitnessSamples = 8;
constexpr int kFrames = 5;  ///< of each
constexpr int kFeatures = 12;
constexpr double kFitnessNoise_m = 5e-4;

/// One recording of a robot whose surface lies so far off where it is thought to be, in `height_m`
/// of feature and depth frame, beside the noise.
class PicturesOfARecording : public testing::Test {
 protected:
  std::string Judge(const std::function<double(int feature, int frame)>& height_m) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise_m(0.0, kFitnessNoise_m);
    ObservedExperiment observed;
    observed.recordings.push_back({.name = "a", .kind = "ramp"});
    observed.feature_rest_m.setZero(3, kFeatures);
    SurfaceClouds clouds;
    for (int s = 0; s < kFitnessSamples; ++s) {
      Sample& sample = observed.samples.emplace_back();
      sample.recording = 0;
      sample.surface.resize(kFeatures);
      for (SurfaceMeasurement& surface : sample.surface) {
        surface.count = kFrames;
        surface.sigma_m = kFitnessNoise_m / std::sqrt(kFrames);
      }
      clouds.emplace_back();
      for (int k = 0; k < kFrames; ++k) {
        SeenCloud& seen = clouds.back().emplace_back();
        const int frame = kFrames * s + k;
        seen.frame = {frame, 0.1 * frame};
        seen.digest = static_cast<std::uint64_t>(frame);
        seen.cloud.points_m.setOnes(3, 1);
        seen.height_m.resize(kFeatures);
        for (int f = 0; f < kFeatures; ++f) seen.height_m[f] = height_m(f, frame) + noise_m(random);
      }
    }
    return CheckImages(observed, clouds).message();
  }

  /// To and fro by 4 mm, as a robot with a fault may be off its model.
  static double Smooth_m(int feature, int frame) {
    return 4e-3 * std::sin(0.3 * feature + 0.2 * frame);
  }
  static int Shuffled(int frame) { return 7 * frame % (kFitnessSamples * kFrames); }
};

TEST_F(PicturesOfARecording, OfARobotThatMovesOtherwiseAreInOrder) {
  EXPECT_EQ(Judge(Smooth_m), "");
}

TEST_F(PicturesOfARecording, OfNoiseAloneAreInOrder) {
  EXPECT_EQ(Judge([](int, int) { return 0.0; }), "");
}

TEST_F(PicturesOfARecording, InWhichSomeFeaturesJumpFromEdgeToEdgeAreInOrder) {
  EXPECT_EQ(Judge([](int feature, int frame) {
              const bool jumps = feature < kFeatures / 4;
              return jumps ? 0.02 * (frame % 2) : Smooth_m(feature, frame);
            }),
            "");
}

TEST_F(PicturesOfARecording, WithStampsOutOfOrderAreTold) {
  EXPECT_THAT(Judge([](int feature, int frame) { return Smooth_m(feature, Shuffled(frame)); }),
              HasSubstr("recording a: the clouds jump"));
}

/// Of one marker along x, with noise whose size is not stated, and one cable.
experiment::Recording RecordingOf(const std::string& name, double moved_m,
                                  const std::function<int(int frame)>& order) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise_m(0.0, kFitnessNoise_m);
  constexpr int kMarkerFrames = 40;
  const auto share = [](int frame) { return static_cast<double>(frame) / kMarkerFrames; };
  experiment::Recording recording;
  recording.name = name;
  recording.markers.emplace().names = {"tip"};
  recording.actuation.emplace().columns.emplace_back().cable = "north";
  for (int k = 0; k < kMarkerFrames; ++k) {
    recording.actuation->t_s.push_back(0.1 * k);
    recording.actuation->columns[0].samples.emplace_back(moved_m * share(k));
    const double x_m = moved_m * share(order(k)) + noise_m(random);
    recording.markers->frames.push_back(
        {.t_s = 0.1 * k, .positions_m = {Eigen::Vector3d(x_m, noise_m(random), noise_m(random))}});
  }
  return recording;
}

TEST(MarkerTables, AtRestAreNotOutOfOrderWhereTheirNoiseIsNotStated) {
  experiment::Experiment experiment;
  experiment.recordings.push_back(RecordingOf("still", 0.0, [](int k) { return k; }));
  EXPECT_EQ(CheckTables(experiment).message(), "");
  experiment.recordings.push_back(RecordingOf("ramp", 0.02, [](int k) { return k; }));
  EXPECT_EQ(CheckTables(experiment).message(), "");
  experiment.recordings.push_back(RecordingOf("mixed", 0.02, [](int k) { return 7 * k % 40; }));
  EXPECT_THAT(CheckTables(experiment).message(), HasSubstr("recording mixed: the markers jump"));
}

}  // namespace
}  // namespace palpate::diagnosis

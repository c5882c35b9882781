// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/model/window_means.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace palpate::diagnosis {
namespace {

/// One marker that goes along (1, 2, -1) by 3 t + 0.4 t^2.
Eigen::Matrix3Xd At(double t_s) {
  return (3.0 * t_s + 0.4 * t_s * t_s) * Eigen::Vector3d(1.0, 2.0, -1.0);
}

/// Samples of windows of five frames, 0.1 s apart, one after the other.
std::pair<ObservedExperiment, Simulation> Motion(int windows, bool still) {
  ObservedExperiment observed;
  Simulation simulation;
  for (int w = 0; w < windows; ++w) {
    Sample sample;
    sample.still = still;
    for (int f = 0; f < 5; ++f) sample.frame_t_s.push_back(0.1 * (5 * w + f));
    sample.t_s = 0.1 * (5 * w + 2);
    observed.samples.push_back(sample);
    SimulatedSample simulated;
    simulated.status = Status::Ok();
    simulated.markers_m = At(sample.t_s);
    simulation.samples.push_back(simulated);
  }
  return {std::move(observed), std::move(simulation)};
}

Eigen::Matrix3Xd MeanOverFrames(const Sample& sample) {
  Eigen::Matrix3Xd mean_m = Eigen::Matrix3Xd::Zero(3, 1);
  for (const double t_s : sample.frame_t_s) mean_m += At(t_s) / 5.0;
  return mean_m;
}

TEST(WindowMeans, AreExactForAQuadraticMotion) {
  auto [observed, simulation] = Motion(4, false);
  MoveToWindowMeans(observed, &simulation);
  for (std::size_t s = 0; s < observed.samples.size(); ++s) {
    const Eigen::Matrix3Xd mean_m = MeanOverFrames(observed.samples[s]);
    EXPECT_GT((At(observed.samples[s].t_s) - mean_m).norm(), 1e-3);
    EXPECT_LT((simulation.samples[s].markers_m - mean_m).norm(), 1e-12) << "sample " << s;
  }
}

TEST(WindowMeans, StayWhereNothingTellsThem) {
  for (auto [windows, still] : {std::pair{2, false}, std::pair{4, true}}) {
    auto [observed, simulation] = Motion(windows, still);
    MoveToWindowMeans(observed, &simulation);
    for (std::size_t s = 0; s < observed.samples.size(); ++s) {
      EXPECT_EQ(simulation.samples[s].markers_m, At(observed.samples[s].t_s));
    }
  }
}

TEST(WindowMeans, AreOfOnePieceEach) {
  auto [observed, simulation] = Motion(6, false);
  for (std::size_t s = 3; s < 6; ++s) {
    observed.samples[s].piece_begin_s = 1.5;
    simulation.samples[s].markers_m = 10.0 * At(1.0);  // elsewhere, and still
  }
  MoveToWindowMeans(observed, &simulation);
  EXPECT_LT((simulation.samples[2].markers_m - MeanOverFrames(observed.samples[2])).norm(), 1e-12);
  EXPECT_EQ(simulation.samples[3].markers_m, 10.0 * At(1.0));
}

}  // namespace
}  // namespace palpate::diagnosis

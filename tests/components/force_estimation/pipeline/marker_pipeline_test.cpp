// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/pipeline/marker_pipeline.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

const std::string kTipContact = "tip: 0, 0.015, 0.03, 0.004";

/// A reference frame, then a force at the tip that grows, with noise.
std::vector<MarkerFrame> GrowingPush() {
  const auto truth = Build(BeamRobot());
  std::mt19937 random(20261127);
  std::vector<MarkerFrame> frames;
  for (int k = 0; k < 4; ++k) {
    const robot::DeadLoad push = LoadAt(*truth, {0.0, 0.015, 0.03}, 0.004, {0.0, 0.0, -0.1 * k});
    frames.push_back(FrameUnder(*truth, {}, {push}));
    frames.back().t_s = 0.1 * k;
    AddNoise(1e-4, random, &frames.back());
  }
  frames.front().reference = ReferenceShape::kEquilibrium;
  return frames;
}

void ExpectSame(const ForceEstimate& a, const ForceEstimate& b) {
  EXPECT_EQ(a.status.code(), b.status.code());
  EXPECT_EQ(a.t_s, b.t_s);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t c = 0; c < a.contacts.size(); ++c) {
    EXPECT_EQ(a.contacts[c].name, b.contacts[c].name);
    EXPECT_EQ(a.contacts[c].force_N, b.contacts[c].force_N);
    EXPECT_EQ(a.contacts[c].covariance_N2, b.contacts[c].covariance_N2);
  }
}

TEST(MarkerPipeline, EstimatesAsTheEstimatorAloneWithAndWithoutMonitors) {
  for (const auto& contacts : {std::vector{kTipContact}, std::vector<std::string>()}) {
    const auto model = Build(BeamRobot()), model_alone = Build(BeamRobot());
    MarkerPipeline pipeline(*model, WithContacts(contacts), robot::CalibrationFile());
    MarkerForceEstimator alone(*model_alone, WithContacts(contacts));
    int with_forces = 0;
    for (const MarkerFrame& frame : GrowingPush()) {
      const PipelineResult& result = pipeline.Update(frame);
      ExpectSame(result.estimate, alone.Update(frame));
      with_forces += result.estimate.status.ok() ? 1 : 0;
      pipeline.PrepareNext();
      pipeline.Monitor();
    }
    EXPECT_GE(with_forces, 2);
  }
}

TEST(MarkerPipeline, KnowsTheStateOfFramesWithForcesOnly) {
  const auto model = Build(BeamRobot());
  MarkerPipeline pipeline(*model, WithContacts({kTipContact}), robot::CalibrationFile());
  const std::vector<MarkerFrame> frames = GrowingPush();
  const PipelineResult& result = pipeline.Update(frames.front());
  EXPECT_FALSE(result.state_is_known);
  EXPECT_EQ(result.state.code(), StatusCode::kNoCalibration);
  EXPECT_EQ(result.gap.whole.sample_count, 0);
  pipeline.Update(frames.back());
  EXPECT_TRUE(result.state_is_known);
  EXPECT_TRUE(result.state.ok());
  EXPECT_EQ(result.gap.whole.sample_count, 12);
}

}  // namespace
}  // namespace palpate::force_estimation

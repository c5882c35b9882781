// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/proposal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "components/diagnosis/design/places_to_hang.hpp"
#include "components/diagnosis/design/planned_experiment.hpp"
#include "components/diagnosis/faults/catalogue.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {
namespace {

using experiment::ActuatorQuantity;
using experiment::RecordingKind;

constexpr double kLargest_m = 0.007;  ///< of SmallExperiment

std::vector<Proposal> Proposals(const robot::RobotBody& body,
                                const experiment::Experiment& experiment) {
  return BenchProposals(body, Observe(experiment, body));
}

TEST(BenchProposals, HoldEverythingThatABenchCanDo) {
  const robot::RobotBody body = SmallRobot();
  std::set<RecordingKind> kinds;
  std::set<std::string> titles;
  for (const Proposal& proposal : Proposals(body, SmallExperiment(body))) {
    kinds.insert(proposal.recording.kind);
    EXPECT_TRUE(titles.insert(proposal.title).second) << proposal.title;
    const bool by_hand = proposal.weight || proposal.recording.base_tilt_deg;
    EXPECT_EQ(by_hand, !proposal.by_hand.empty()) << proposal.title;
    EXPECT_EQ(proposal.weight.has_value(), !proposal.recording.loads.empty()) << proposal.title;
  }
  for (const RecordingKind kind :
       {RecordingKind::kRamp, RecordingKind::kHold, RecordingKind::kKnownLoad,
        RecordingKind::kCoContraction, RecordingKind::kBaseTilted, RecordingKind::kSecondSpeed}) {
    EXPECT_TRUE(kinds.contains(kind)) << ToString(kind);
  }
}

TEST(BenchProposals, BeginAndEndAtZeroAndGoAQuarterFartherAtMost) {
  const robot::RobotBody body = SmallRobot();
  double most_m = 0.0;
  for (const Proposal& proposal : Proposals(body, SmallExperiment(body))) {
    ASSERT_TRUE(proposal.recording.actuation) << proposal.title;
    const experiment::Actuation& actuation = *proposal.recording.actuation;
    EXPECT_EQ(actuation.t_s.front(), 0.0);
    EXPECT_EQ(actuation.t_s.back(), proposal.duration_s);
    EXPECT_TRUE(std::is_sorted(actuation.t_s.begin(), actuation.t_s.end(), std::less_equal<>()));
    ASSERT_EQ(actuation.columns.size(), body.cables.size());
    for (const experiment::ActuatorColumn& column : actuation.columns) {
      EXPECT_EQ(column.quantity, ActuatorQuantity::kDisplacement);
      EXPECT_EQ(column.samples.front(), 0.0);
      EXPECT_EQ(column.samples.back(), 0.0);
      for (const auto& sample : column.samples) most_m = std::max(most_m, std::abs(*sample));
    }
  }
  EXPECT_LE(most_m, 1.25 * kLargest_m);
  EXPECT_GT(most_m, 1.2 * kLargest_m);
}

TEST(BenchProposals, DriveCablesAsTheDataDid) {
  const robot::RobotBody body = SmallRobot();
  experiment::Experiment experiment = SmallExperiment(body);
  for (experiment::Recording& recording : experiment.recordings) {
    auto& columns = recording.actuation->columns;
    columns.erase(columns.begin());
    columns.back().quantity = ActuatorQuantity::kTension;
    for (auto& sample : columns.back().samples) sample = 100.0 * *sample;
  }
  for (const Proposal& proposal : Proposals(body, experiment)) {
    const auto& columns = proposal.recording.actuation->columns;
    ASSERT_EQ(columns.size(), 2U);
    EXPECT_EQ(columns[0].Header(), "aside.displacement_m");
    EXPECT_EQ(columns[1].Header(), "down.tension_N");
    for (const auto& sample : columns[1].samples) {
      EXPECT_GE(*sample, 0.0) << proposal.title;
      EXPECT_LE(*sample, 1.25 * 0.3 + 1e-9) << proposal.title;
    }
  }
}

TEST(BenchProposals, OfABodyWithoutCablesAreWeightsAndTilts) {
  robot::RobotBody body = SmallRobot();
  body.cables.clear();
  experiment::Experiment experiment;
  experiment.recordings = {MakeRecording("a", body, {{0.0, {}}, {5.0, {}}}, 0.5)};
  experiment.recordings.front().actuation.reset();
  const std::vector<Proposal> proposals = Proposals(body, experiment);
  ASSERT_EQ(proposals.size(), 6U);  // and both at once
  for (const Proposal& proposal : proposals) {
    EXPECT_FALSE(proposal.recording.actuation) << proposal.title;
    EXPECT_FALSE(proposal.by_hand.empty()) << proposal.title;
  }
  body.gravity_m_s2.setZero();
  EXPECT_TRUE(Proposals(body, experiment).empty());
}

TEST(BenchProposals, HangWeightsDownwardsOffATiltedBase) {
  const robot::RobotBody body = SmallRobot();
  int tilted = 0;
  for (const Proposal& proposal : Proposals(body, SmallExperiment(body))) {
    if (!proposal.weight) continue;
    ASSERT_EQ(proposal.recording.loads.size(), 1U) << proposal.title;
    const Eigen::Vector3d world_N =
        BaseRotation(proposal.recording) * proposal.recording.loads.front().force_N;
    EXPECT_LT((world_N - proposal.weight->mass_kg * body.gravity_m_s2).norm(), 1e-12)
        << proposal.title;
    tilted += proposal.recording.base_tilt_deg ? 1 : 0;
  }
  EXPECT_EQ(tilted, 2);
}

TEST(PlacesToHang, AreTheFarEndAndAnother) {
  const robot::RobotBody body = SmallRobot();
  const auto places_m = PlacesToHang(body);
  ASSERT_EQ(places_m.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT((places_m[k] - body.feature_points[k].rest_m).norm(), 1e-3) << k;
  }
  EXPECT_EQ(MassToHang_kg(body), 2e-3);  // of 20 g
  EXPECT_EQ(WordsForPlace(body, body.markers[1].point.rest_m), "at marker m1");
  EXPECT_EQ(WordsForPlace(body, places_m[0]), "at (93, 12, 19) mm, 8 mm from marker m0");
}

TEST(ObserveProposals, GoOnAfterTheExperimentFromWhereTheCameraStood) {
  const robot::RobotBody body = SmallRobot();
  experiment::Experiment experiment = SmallExperiment(body);
  experiment.recordings.back().kind = RecordingKind::kCameraMoved;
  const ObservedExperiment observed = Observe(experiment, body);
  const std::vector<Proposal> proposals = BenchProposals(body, observed);
  const ObservedExperiment planned = ObserveProposals(experiment, observed, body, proposals);
  ASSERT_EQ(planned.recordings.size(), observed.recordings.size() + proposals.size());
  std::vector<int> samples(planned.recordings.size(), 0);
  for (const Sample& sample : planned.samples) {
    ++samples[static_cast<std::size_t>(sample.recording)];
    EXPECT_EQ(sample.frame_t_s.size(), 1U);
    EXPECT_GE(sample.count.minCoeff(), 1);
    EXPECT_GT(sample.t_s, observed.timeline.end_s.back());
    const auto r = static_cast<std::size_t>(sample.recording) - observed.recordings.size();
    EXPECT_EQ(sample.loads.size(), proposals[r].recording.loads.size());
  }
  for (std::size_t r = 0; r < planned.recordings.size(); ++r) {
    const bool made = r < observed.recordings.size();
    EXPECT_EQ(samples[r] > 0, !made) << planned.recordings[r].name;
    EXPECT_LE(samples[r], 20) << planned.recordings[r].name;
    if (made) continue;
    // The hold is the last whose camera stood where it usually does and whose base was level.
    EXPECT_EQ(planned.recordings[r].pose_of, 1);
    EXPECT_TRUE(planned.recordings[r].T_measurement_robot.isApprox(
        observed.recordings[1].T_measurement_robot));
  }
  EXPECT_EQ(planned.sigma_m, observed.sigma_m);
}

TEST(PredictProposals, SeeFromWhereTheCameraStoodAsFarAsThatIsKnown) {
  const robot::RobotBody body = SmallRobot();
  experiment::Experiment experiment = SmallExperiment(body);
  experiment.recordings[2].base_tilt_deg.reset();
  experiment.recordings[3].kind = RecordingKind::kCameraMoved;
  const ObservedExperiment observed = Observe(experiment, body, {.most_samples = 14});
  const HypothesisSet hypotheses(MakeFaultModels({.body = body, .observed = observed}, {}), {});
  const Fit as_built = Fitter(observed, body, hypotheses, {}, 1).AsBuilt();
  const std::vector<Proposal> proposals = BenchProposals(body, observed);
  const ObservedExperiment planned = ObserveProposals(experiment, observed, body, proposals);
  std::vector<int> all(static_cast<std::size_t>(hypotheses.size()));
  std::iota(all.begin(), all.end(), 0);
  const LinearModel model = PredictProposals(planned, body, hypotheses, as_built, all, {}, 1);
  ASSERT_GT(model.J.rows(), 0);
  const auto columns_of = [&](const std::string& id) {
    std::vector<bool> seen;
    for (int k = 0; k < hypotheses.size(); ++k) {
      if (hypotheses.model(k).name().id != id) continue;
      seen.push_back(!model.J.middleCols(hypotheses.first(k), hypotheses.count(k)).isZero());
    }
    return seen;
  };
  // One of each pose: that of the third recording, in which the camera stood last, and the moved.
  EXPECT_EQ(columns_of("extrinsics"), (std::vector<bool>{true, false}));
  // It may have been moved before the third recording, which it stood for, or before the fourth.
  EXPECT_EQ(columns_of("camera_moved"), (std::vector<bool>{true, false}));
  EXPECT_EQ(planned.recordings.back().pose_of, 2);
}

}  // namespace
}  // namespace palpate::diagnosis

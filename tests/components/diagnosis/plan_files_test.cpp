// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/design/plan_files.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "libs/app/yaml.hpp"
#include "libs/core/file.hpp"
#include "libs/scenario/scenario.hpp"
#include "tests/components/diagnosis/small_robot.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::diagnosis {
namespace {

namespace fs = std::filesystem;

class PlanFiles : public testing::Test {
 protected:
  static PlannedRecording Plan(const Proposal& proposal) {
    return {.ranked = {.proposal = proposal, .worst_rival = {}, .expected_ln_bayes_factor = 12.34},
            .name = "next_" + ToString(proposal.recording.kind),
            .tells = "a mass from a force"};
  }

  /// A scenario that goes on with the plan.
  scenario::RecordingPlan OnTheBench() const {
    WriteFile(folder_ / "scenario.yaml",
              "name: bench\nmarkers: {rate_hz: 5}\nrecordings:\n  - {name: a, duration_s: 1}\n" +
                  ReadFile(folder_ / "plan/recording.scenario.yaml"));
    return scenario::ReadScenario(folder_ / "scenario.yaml", app::LoadYaml).recordings.back();
  }

  const test_support::TestFolder own_folder_;
  const fs::path folder_ = own_folder_.path();
  const robot::RobotBody body_ = SmallRobot();
};

TEST_F(PlanFiles, AreReadBackAsTheRecordingThatWasPlanned) {
  for (const Proposal& proposal : BenchProposals(body_, Observe(SmallExperiment(body_), body_))) {
    SCOPED_TRACE(proposal.title);
    WritePlan(Plan(proposal), folder_ / "plan");
    const auto read = experiment::ReadRecording(folder_ / "plan", app::LoadYaml);
    const experiment::Recording& planned = proposal.recording;
    EXPECT_EQ(read.kind, planned.kind);
    EXPECT_EQ(read.base_tilt_deg, planned.base_tilt_deg);
    EXPECT_FALSE(read.markers);
    ASSERT_TRUE(read.actuation);
    EXPECT_EQ(read.actuation->t_s, planned.actuation->t_s);
    ASSERT_EQ(read.actuation->columns.size(), planned.actuation->columns.size());
    for (std::size_t c = 0; c < read.actuation->columns.size(); ++c) {
      EXPECT_EQ(read.actuation->columns[c].Header(), planned.actuation->columns[c].Header());
      EXPECT_EQ(read.actuation->columns[c].samples, planned.actuation->columns[c].samples);
    }
    ASSERT_EQ(read.loads.size(), planned.loads.size());
    for (std::size_t k = 0; k < read.loads.size(); ++k) {
      EXPECT_EQ(read.loads[k].position_m, planned.loads[k].position_m);
      EXPECT_EQ(read.loads[k].force_N, planned.loads[k].force_N);
    }
    const std::string by_hand = ReadFile(folder_ / "plan/by_hand.txt");
    EXPECT_THAT(by_hand, testing::HasSubstr(proposal.title));
    EXPECT_THAT(by_hand, testing::HasSubstr("a mass from a force"));
    EXPECT_THAT(by_hand, testing::HasSubstr(proposal.by_hand.substr(
                             std::min<std::size_t>(1, proposal.by_hand.size()))));
  }
}

TEST_F(PlanFiles, AreWhatTheVirtualBenchDoes) {
  for (const Proposal& proposal : BenchProposals(body_, Observe(SmallExperiment(body_), body_))) {
    SCOPED_TRACE(proposal.title);
    WritePlan(Plan(proposal), folder_ / "plan");
    const scenario::RecordingPlan bench = OnTheBench();
    const experiment::Recording& planned = proposal.recording;
    EXPECT_EQ(bench.name, "next_" + ToString(planned.kind));
    EXPECT_EQ(bench.kind, ToString(planned.kind));
    EXPECT_EQ(bench.duration_s, proposal.duration_s);
    EXPECT_EQ(bench.notes, proposal.title);
    EXPECT_EQ(bench.base_tilt_deg, planned.base_tilt_deg.value_or(Eigen::Vector2d::Zero()));
    for (double t_s = 0.0; t_s <= proposal.duration_s; t_s += 0.37) {
      const Eigen::VectorXd told_m = bench.commands.At(t_s);
      for (std::size_t c = 0; c < bench.commands.cables.size(); ++c) {
        const auto* column = planned.actuation->Find(bench.commands.cables[c],
                                                     experiment::ActuatorQuantity::kDisplacement);
        ASSERT_NE(column, nullptr);
        EXPECT_NEAR(told_m[static_cast<Eigen::Index>(c)], planned.actuation->ValueAt(*column, t_s),
                    1e-12);
      }
    }
    ASSERT_EQ(bench.weights.size(), proposal.weight ? 1U : 0U);
    if (!proposal.weight) continue;
    const scenario::HungWeight& weight = bench.weights.front();
    EXPECT_EQ(weight.position_m, planned.loads.front().position_m);
    EXPECT_EQ(weight.patch_radius_m, planned.loads.front().patch_radius_m);
    const Eigen::Vector3d world_N = BaseRotation(planned) * planned.loads.front().force_N;
    EXPECT_LT((weight.mass_kg * body_.gravity_m_s2 - world_N).norm(), 1e-12);
  }
}

TEST_F(PlanFiles, OfAnotherPlanTakeThePlaceOfThoseBefore) {
  Proposal weight;
  Proposal tension;
  for (const Proposal& one : BenchProposals(body_, Observe(SmallExperiment(body_), body_))) {
    if (one.weight) weight = one;
    if (!one.weight) tension = one;
  }
  for (experiment::ActuatorColumn& column : tension.recording.actuation->columns) {
    column.quantity = experiment::ActuatorQuantity::kTension;
  }
  const fs::path plan = folder_ / "plan";
  WritePlan(Plan(weight), plan);
  EXPECT_TRUE(fs::exists(plan / "loads.csv"));
  WriteFile(plan / "markers.note", "mine");
  WritePlan(Plan(tension), plan);
  EXPECT_FALSE(fs::exists(plan / "loads.csv"));
  EXPECT_FALSE(fs::exists(plan / "recording.scenario.yaml"));  // it can command no tension
  RemovePlan(plan);
  EXPECT_FALSE(fs::exists(plan / "by_hand.txt"));
  EXPECT_TRUE(fs::exists(plan / "markers.note"));
}

TEST_F(PlanFiles, AreOfARecordingThatSortsAfterAll) {
  experiment::Experiment experiment = SmallExperiment(body_);
  const auto kind = experiment::RecordingKind::kBaseTilted;
  EXPECT_EQ(NextName(experiment, kind), "next_base_tilted");
  experiment.recordings.back().name = "next_ramp";
  EXPECT_EQ(NextName(experiment, kind), "next_ramp_next_base_tilted");
}

TEST_F(PlanFiles, OfARankingLieBehindTheBestUntilThereIsAnother) {
  const fs::path plan = folder_ / "plan";
  std::vector<PlannedRecording> ranking;
  for (const Proposal& proposal : BenchProposals(body_, Observe(SmallExperiment(body_), body_))) {
    ranking.push_back(Plan(proposal));
  }
  ASSERT_GT(ranking.size(), 10U);
  WritePlans(ranking, folder_);
  const auto title = [](const fs::path& folder) {
    return experiment::ReadRecording(folder, app::LoadYaml).notes;
  };
  EXPECT_EQ(title(plan), ranking[0].ranked.proposal.title);
  EXPECT_EQ(title(folder_ / "plan_others/02"), ranking[1].ranked.proposal.title);
  EXPECT_EQ(title(folder_ / "plan_others/10"), ranking[9].ranked.proposal.title);
  WriteFile(folder_ / "plan_others/03/markers.csv", "measured");
  WritePlans({ranking.back()}, folder_);
  EXPECT_EQ(title(plan), ranking.back().ranked.proposal.title);
  EXPECT_FALSE(fs::exists(folder_ / "plan_others/02"));
  EXPECT_EQ(ReadFile(folder_ / "plan_others/03/markers.csv"), "measured");
  EXPECT_FALSE(fs::exists(folder_ / "plan_others/03/recording.yaml"));
  WritePlans({}, folder_);
  EXPECT_FALSE(fs::exists(plan / "recording.yaml"));
}

}  // namespace
}  // namespace palpate::diagnosis

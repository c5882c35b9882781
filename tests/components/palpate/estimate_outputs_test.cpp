// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "components/palpate/compare_verb.hpp"
#include "components/palpate/estimate/estimate_run.hpp"
#include "components/palpate/estimate/estimate_verb.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/simulate/sealed_answer.hpp"
#include "components/palpate/solve_verb.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/csv_table.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {
namespace {

using experiment::CsvTable;
using test_support::MessageOf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr double kFirst_N = 0.03;
constexpr double kSecond_N = 0.02;

/// A bar with eight markers, on which a load of 0.03 N hangs for a second at its tip, then one of
/// 0.02 N in its middle; markers as `palpate solve` computes them, at 10 Hz.
class EstimateOutputs : public testing::Test {
 protected:
  EstimateOutputs() {
    robot_ = WriteBarRobot(folder_);
    std::string text = ReadFile(robot_);
    std::string markers = "markers:";
    for (int i = 1; i <= 8; ++i) {
      markers += "\n  - {name: m" + std::to_string(i) + ", position_m: [0.0" + std::to_string(i) +
                 ", " + (i % 2 == 0 ? "0.0" : "0.02") + ", 0.015]}";
    }
    text = std::regex_replace(text, std::regex("markers:.*"), markers);
    robot_ = folder_.Write("eight.yaml", text);
    loads_ = folder_.Write("exp/recordings/r1/loads.csv",
                           "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n"
                           "0,0.075,0.01,0.02,0,0,-0.03,0.006\n"
                           "1,0.045,0.01,0.02,0,0,-0.02,0.006\n");
    folder_.Write("exp/recordings/r1/recording.yaml", "kind: known_load\n");
    WriteSettings("");
  }

  void WriteSettings(const std::string& more) const {
    folder_.Write("exp/experiment.yaml", "frame: robot\nmarkers_sigma_m: 1.0e-5\n" + more);
  }

  void Measure() {
    SolveOptions solve;
    solve.robot = robot_;
    solve.loads = loads_;
    std::string times = "t_s\n";
    for (int i = 0; i < 20; ++i) times += std::to_string(0.1 * i) + "\n";
    solve.actuation = folder_.Write("a.csv", times);
    solve.out = folder_ / "solved";
    ASSERT_EQ(Solve(solve), 0);
    std::filesystem::copy_file(solve.out / "markers.csv",
                               folder_ / "exp/recordings/r1/markers.csv");
    options_.robot = robot_;
    options_.data = folder_ / "exp";
    options_.out = folder_ / "forces.csv";
  }

  /// The true forces as `palpate simulate` stores them.
  std::filesystem::path WriteAnswer(const std::string& recording) const {
    Answer answer;
    RecordingTruth& truth = answer.recordings.emplace_back();
    truth.name = recording;
    const CsvTable markers = CsvTable::Read(folder_ / "solved/markers.csv");
    for (int i = 0; i < 20; ++i) {
      const bool first = i < 10;
      TrueForces frame{0.1 * i, {}};
      // In the middle between two markers, 5 mm above them.
      const std::size_t row = 8 * static_cast<std::size_t>(i) + (first ? 6 : 3);
      Eigen::Vector3d position_m(0.0, 0.0, 0.005);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const auto column = static_cast<std::size_t>(axis) + 2;
        position_m[axis] += 0.5 * (markers.Number(row, column) + markers.Number(row + 1, column));
      }
      frame.forces.push_back({first ? "tip" : "middle",
                              position_m,
                              {first ? 0.075 : 0.045, 0.01, 0.02},
                              {0.0, 0.0, first ? -kFirst_N : -kSecond_N}});
      truth.frames.push_back(frame);
    }
    return folder_.Write("exp.answer.json", FormatAnswer(answer));
  }

  std::string Output() {
    testing::internal::CaptureStdout();
    const int exit_code = Estimate(options_);
    std::string text = testing::internal::GetCapturedStdout();
    EXPECT_EQ(exit_code, 0) << text;
    return text;
  }

  TestFolder folder_;
  std::filesystem::path robot_;
  std::filesystem::path loads_;
  EstimateOptions options_;
};

TEST_F(EstimateOutputs, KnownLoadsAreContactsOfKnownPlaceAndUnknownForce) {
  Measure();
  EXPECT_THAT(Output(), AllOf(HasSubstr("load_1: 0.0"), HasSubstr("; known load 0.0300 N"),
                              HasSubstr("; known load 0.0200 N")));
  const CsvTable forces = CsvTable::Read(options_.out);
  ASSERT_EQ(forces.rows(), 20U);
  for (std::size_t row = 0; row < forces.rows(); ++row) {
    const bool first = row < 10;
    EXPECT_EQ(forces.Text(row, 2), first ? "load_1" : "load_2") << row;
    EXPECT_EQ(forces.Text(row, 11), "ok") << row;
    const Eigen::Vector3d force_N(forces.Number(row, 6), forces.Number(row, 7),
                                  forces.Number(row, 8));
    const double known_N = first ? kFirst_N : kSecond_N;
    EXPECT_LE(std::abs(force_N.norm() - known_N), forces.Number(row, 9)) << row;
    EXPECT_NEAR(force_N.z(), -known_N, 0.05 * known_N) << row;
  }
}

TEST_F(EstimateOutputs, ContactsThatAreGivenReplaceKnownLoads) {
  Measure();
  options_.contacts = {"here: 0.075, 0.01, 0.02, 0.006"};
  EXPECT_THAT(Output(), AllOf(HasSubstr("here: "), Not(HasSubstr("load_1"))));
}

TEST_F(EstimateOutputs, DrawForcesOverTime) {
  Measure();
  options_.plot = folder_ / "forces.svg";
  Output();
  EXPECT_THAT(ReadFile(options_.plot),
              AllOf(HasSubstr("<svg"), HasSubstr("load_1"), HasSubstr("load_2"),
                    HasSubstr("forces in r1"), Not(HasSubstr("true"))));
  options_.answer = WriteAnswer("r1");
  Output();
  EXPECT_THAT(ReadFile(options_.plot), AllOf(HasSubstr("tip"), HasSubstr("true")));
}

TEST_F(EstimateOutputs, DrawOneFileForEachOfSeveralRecordings) {
  Measure();
  std::filesystem::copy(folder_ / "exp/recordings/r1", folder_ / "exp/recordings/r2");
  options_.plot = folder_ / "forces.svg";
  Output();
  EXPECT_TRUE(std::filesystem::exists(folder_ / "forces_r1.svg"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "forces_r2.svg"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "forces.svg"));
}

TEST_F(EstimateOutputs, CompareWithTheGroundTruth) {
  Measure();
  options_.answer = WriteAnswer("r1");
  // Steady after 0.3 s of each force: frames 3 to 9 and 13 to 19.
  EXPECT_THAT(Output(),
              AllOf(HasSubstr("forces of 0.003 N or more"),
                    HasSubstr("truth: 14 of 14 steady forces detected; error of |F| "),
                    HasSubstr("100 % inside the 95 % interval; false alarms in 0 of 20 frames")));
  options_.json = true;
  const auto json = nlohmann::json::parse(Output());
  EXPECT_EQ(json[0]["comparison"]["steady_forces"], 14);
  EXPECT_EQ(json[0]["comparison"]["missed"], 0);
  EXPECT_LT(json[0]["comparison"]["relative_error_p95"], 0.05);
  EXPECT_EQ(json[0]["comparison"]["coverage_of_ci95"], 1.0);
  EXPECT_EQ(json[0]["contacts"][0]["known_load_N"], 0.03);
}

/// One evaluation, from the frames and from the file.
TEST_F(EstimateOutputs, HaveTheNumbersOfCompare) {
  Measure();
  options_.answer = WriteAnswer("r1");
  options_.json = true;
  const auto estimated = nlohmann::json::parse(Output());
  CompareOptions compare;
  compare.estimated = options_.out;
  compare.truth = options_.answer;
  compare.robot = robot_;
  compare.json = true;
  testing::internal::CaptureStdout();
  EXPECT_EQ(Compare(compare), 0);
  const auto compared = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  EXPECT_EQ(compared["recordings"][0]["comparison"], estimated[0]["comparison"]);
  EXPECT_EQ(compared["all"]["steady_forces"], 14);
  EXPECT_TRUE(compared["all"].contains("nees_per_degree"));
}

TEST_F(EstimateOutputs, SayWhereTheGroundTruthLacksARecording) {
  Measure();
  options_.answer = WriteAnswer("another");
  EXPECT_THAT(Output(), HasSubstr("truth: the file has none of this recording"));
}

TEST_F(EstimateOutputs, RefuseAGroundTruthThatIsNone) {
  Measure();
  options_.answer = WriteAnswer("r1");
  WriteSettings("answer_sha256: " + std::string(64, 'a') + "\n");
  EXPECT_THAT(MessageOf([&] { Estimate(options_); }),
              HasSubstr("is the ground truth of another experiment"));
  WriteSettings("");
  options_.answer = folder_.Write("other.json", "{\"recordings\": 3}");
  EXPECT_THAT(MessageOf([&] { Estimate(options_); }),
              HasSubstr("other.json: is not a ground truth of palpate simulate"));
  options_.answer = folder_ / "absent.json";
  EXPECT_THAT(MessageOf([&] { Estimate(options_); }), HasSubstr("absent.json: cannot be read"));
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(EstimateOutputs, ThinFramesToTheRate) {
  Measure();
  options_.rate_Hz = 5.0;
  Output();
  const CsvTable forces = CsvTable::Read(options_.out);
  ASSERT_EQ(forces.rows(), 10U);
  EXPECT_NEAR(forces.Number(1, 1), 0.2, 1e-9);
  options_.rate_Hz = -1.0;
  EXPECT_THAT(MessageOf([&] { Estimate(options_); }), HasSubstr("--rate: must be 0 or more"));
}

TEST_F(EstimateOutputs, AnInterruptedRunLeavesTheForcesSoFar) {
  Measure();
  options_.plot = folder_ / "forces.svg";
  experiment::Experiment experiment = experiment::ReadExperiment(options_.data, app::LoadYaml);
  const EstimateSettings settings = ReadEstimateSettings(experiment, {}, {}, {});
  const auto model = LoadRobot(options_.robot);
  int frames = 0;
  EstimateRun run(options_, settings, &experiment, model.get(), [&] { return frames++ >= 5; });
  run.Estimate(offline::PlanEstimates(experiment, {}, "").front());
  EXPECT_THAT(
      MessageOf<app::Interrupted>([&] { run.Finish(); }),
      AllOf(HasSubstr("after 5 of 20 frames: their forces are in "), HasSubstr("forces.csv")));
  EXPECT_EQ(CsvTable::Read(options_.out).rows(), 5U);
  EXPECT_TRUE(std::filesystem::exists(options_.plot));
}

TEST_F(EstimateOutputs, ARunInterruptedBeforeItsFirstFrameWritesNothing) {
  Measure();
  experiment::Experiment experiment = experiment::ReadExperiment(options_.data, app::LoadYaml);
  const EstimateSettings settings = ReadEstimateSettings(experiment, {}, {}, {});
  const auto model = LoadRobot(options_.robot);
  EstimateRun run(options_, settings, &experiment, model.get(), [] { return true; });
  run.Estimate(offline::PlanEstimates(experiment, {}, "").front());
  EXPECT_THAT(MessageOf<app::Interrupted>([&] { run.Finish(); }), HasSubstr("nothing was written"));
  EXPECT_FALSE(std::filesystem::exists(options_.out));
}

TEST_F(EstimateOutputs, OutputsAreCheckedBeforeTheWork) {
  Measure();
  options_.robot = "no_such_robot";  // would be refused next
  options_.out = folder_ / "no/such/folder/forces.csv";
  EXPECT_THAT(MessageOf([&] { Estimate(options_); }), HasSubstr("cannot be written"));
  options_.out = folder_ / "forces.csv";
  options_.plot = folder_ / "no/such/folder/forces.svg";
  EXPECT_THAT(MessageOf([&] { Estimate(options_); }), HasSubstr("forces.svg: cannot be written"));
}

TEST(KeptFrames, AreTheFirstOfEachPeriod) {
  EXPECT_EQ(offline::KeptFrames({5.0, 5.1, 5.2, 5.3, 5.9}, 5.0),
            (std::vector<bool>{true, false, true, false, true}));
  EXPECT_EQ(offline::KeptFrames({0.0, 0.1, 0.2}, 0.0), (std::vector<bool>{true, true, true}));
  EXPECT_EQ(offline::KeptFrames({0.0, 0.1, 0.2}, 1000.0), (std::vector<bool>{true, true, true}));
  EXPECT_TRUE(offline::KeptFrames({}, 5.0).empty());
}

}  // namespace
}  // namespace palpate::command

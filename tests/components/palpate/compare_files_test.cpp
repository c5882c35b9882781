// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "components/palpate/compare/comparison_output.hpp"
#include "components/palpate/compare/file_comparison.hpp"
#include "components/palpate/compare/force_file.hpp"
#include "components/palpate/compare_verb.hpp"
#include "components/palpate/simulate/sealed_answer.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::command {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

constexpr const char* kEstimateHeader =
    "recording,t_s,contact,x_m,y_m,z_m,fx_N,fy_N,fz_N,ci95_N,location_ci95_m,status,"
    "cov_xx_N2,cov_xy_N2,cov_xz_N2,cov_yy_N2,cov_yz_N2,cov_zz_N2\n";
constexpr const char* kPlainHeader = "t_s,contact,x_m,y_m,z_m,fx_N,fy_N,fz_N\n";

class CompareFiles : public testing::Test {
 protected:
  ForceFile Read(const std::string& name, const std::string& text) const {
    return ReadForceFile(folder_.Write(name, text));
  }

  /// A push of 1 N down at x = 0.1 m, at 10 Hz from 0 to 2 s.
  ForceFile PushTruth() const {
    std::string text = kPlainHeader;
    for (int i = 0; i <= 20; ++i) text += FormatNumber(0.1 * i) + ",ball,0.1,0,0,0,0,-1\n";
    return Read("truth.csv", text);
  }

  std::string VerbOutput(const CompareOptions& options) const {
    testing::internal::CaptureStdout();
    EXPECT_EQ(Compare(options), 0);
    return testing::internal::GetCapturedStdout();
  }

  TestFolder folder_;
};

TEST_F(CompareFiles, EveryMetricIsThatOfItsFormula) {
  // Two frames, off by (0.06, 0, -0.08) N and (0, 0, 0.1) N, and by 3 and 1 mm.
  const ForceFile estimated =
      Read("forces.csv",
           std::string(kPlainHeader) + "1.0,c,0.103,0,0,0.06,0,-1.08\n1.55,c,0.101,0,0,0,0,-0.9\n");
  const FileComparison found = CompareForces(estimated, PushTruth(), {});
  const ForceScore score = found.all.All();
  ASSERT_EQ(score.frames, 2);
  const double first_N = std::hypot(0.06, 1.08) - 1.0;
  EXPECT_NEAR(score.bias_N, 0.5 * (first_N - 0.1), 1e-12);
  EXPECT_NEAR(score.mean_relative_error, 0.5 * (first_N + 0.1), 1e-12);
  EXPECT_NEAR(score.p95_error_N, 0.1, 1e-12);
  EXPECT_NEAR(score.p95_location_error_m, 0.003, 1e-12);
  EXPECT_NEAR(score.mean_direction_error_rad, 0.5 * std::atan2(0.06, 1.08), 1e-12);
  // Quantile takes the upper of two.
  EXPECT_NEAR(score.median_along_N, 0.1, 1e-12);
  EXPECT_NEAR(score.median_across_N, 0.06, 1e-12);
  EXPECT_TRUE(std::isnan(score.coverage));
  EXPECT_TRUE(std::isnan(score.location_coverage));
  EXPECT_EQ(score.consistency.forces(), 0);
  EXPECT_EQ(ToTable(found.all).find("nan"), std::string::npos);
  EXPECT_FALSE(ToJson(found.all).contains("coverage_of_ci95"));
}

TEST_F(CompareFiles, IntervalsAndCovariancesAreCheckedAgainstTheTruth) {
  const std::string rest = ",0.05,0.002,ok,0.01,0,0,0.01,0,0.0025\n";
  const ForceFile estimated = Read(
      "forces.csv", std::string(kEstimateHeader) + "r,1.0,c,0.101,0,0,0,0,-1.04" + rest +
                        "r,1.1,c,0.103,0,0,0.3,0,-1" + rest + "r,1.2,,,,,,,,,,no_contact,,,,,,\n");
  const ForceFile truth = PushTruth();
  const FileComparison found = CompareForces(estimated, truth, {});
  EXPECT_EQ(found.recordings.at(0).name, "r");
  EXPECT_EQ(found.all.due(), 3);
  EXPECT_EQ(found.all.misses(), 1);
  const ForceScore score = found.all.All();
  EXPECT_EQ(score.coverage, 1.0);
  EXPECT_EQ(score.location_coverage, 0.5);
  const auto& consistency = score.consistency;
  EXPECT_EQ(consistency.contacts(), 1);  // two frames of one contact
  EXPECT_NEAR(consistency.NeesPerDegree(), 0.5 * (0.0016 / 0.0025 + 9.0) / 3.0, 1e-9);
  EXPECT_EQ(consistency.ShareWithin95(), 0.5);
  EXPECT_THAT(ToTable(found.all), HasSubstr("(1 contacts)"));
}

TEST_F(CompareFiles, CountMissedAndFalseContacts) {
  const ForceFile estimated = Read("forces.csv", std::string(kPlainHeader) +
                                                     "1.0,,,,,,,\n"
                                                     "1.1,a,0.1,0,0,0,0,-1\n"
                                                     "1.1,b,0.2,0,0,0,0,-1\n");
  const FileComparison found = CompareForces(estimated, PushTruth(), {});
  EXPECT_EQ(found.all.frames(), 2);
  EXPECT_EQ(found.all.misses(), 1);
  EXPECT_EQ(found.all.false_alarms(), 1);
  FileComparisonRules wide;
  wide.same_place_m = 0.11;
  EXPECT_EQ(CompareForces(estimated, PushTruth(), wide).all.false_alarms(), 1);  // one for one
  FileComparisonRules narrow;
  narrow.same_place_m = 0.0;
  EXPECT_EQ(CompareForces(estimated, PushTruth(), narrow).all.false_alarms(), 1);
}

TEST_F(CompareFiles, TimesOfOtherRatesAndClocksArePaired) {
  const ForceFile estimated = Read("forces.csv", std::string(kPlainHeader) +
                                                     "1001.033,c,0.1,0,0,0,0,-1\n"
                                                     "1001.066,c,0.1,0,0,0,0,-1\n"
                                                     "1009.0,c,0.1,0,0,0,0,-1\n");
  try {
    CompareForces(estimated, PushTruth(), {});
    ADD_FAILURE() << "no time is in both";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("1001.033 to 1009.000 s"), HasSubstr("--time-offset")));
  }
  FileComparisonRules rules;
  rules.time_offset_s = -1000.0;
  const FileComparison found = CompareForces(estimated, PushTruth(), rules);
  EXPECT_EQ(found.all.found(), 2);
  EXPECT_EQ(found.recordings.at(0).without_truth, 1);
  rules.timing.longest_gap_s = 0.05;
  EXPECT_THROW(CompareForces(estimated, PushTruth(), rules), RunError);
  rules.timing.same_time_s = 0.05;
  EXPECT_EQ(CompareForces(estimated, PushTruth(), rules).all.found(), 2);
}

TEST_F(CompareFiles, SilenceIsNoContactWhereItIsSaid) {
  const ForceFile estimated =
      Read("forces.csv", std::string(kPlainHeader) + "0.5,c,0.1,0,0,0,0,-1\n");
  const FileComparison found = CompareForces(estimated, PushTruth(), {});
  EXPECT_EQ(found.all.misses(), 0);
  EXPECT_THAT(found.notes, Contains(HasSubstr("--silence-is-no-contact")));
  FileComparisonRules rules;
  rules.silence_is_no_contact = true;
  const FileComparison silent = CompareForces(estimated, PushTruth(), rules);
  EXPECT_EQ(silent.all.found(), 1);
  EXPECT_EQ(silent.all.misses(), 10);  // 1.1 to 2.0 s
}

TEST_F(CompareFiles, LoadsHoldUntilTheNext) {
  const ForceFile loads = Read("loads.csv",
                               "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N\n"
                               "0,0.1,0,0,0,0,-0.5\n4,0.1,0,0,0,0,0\n");
  EXPECT_EQ(loads.kind, ForceFile::Kind::kLoads);
  const ForceFile estimated = Read("forces.csv", std::string(kPlainHeader) +
                                                     "2,c,0.1,0,0,0,0,-0.5\n"
                                                     "5,c,0.1,0,0,0,0,-0.5\n");
  const FileComparison found = CompareForces(estimated, loads, {});
  EXPECT_EQ(found.all.found(), 1);
  EXPECT_EQ(found.all.false_alarms(), 1);
  EXPECT_THAT(found.notes, Contains(HasSubstr("undeformed body")));
}

TEST_F(CompareFiles, RecordingsPairByNameOrAreChosen) {
  const std::string truth_rows = "r1,1,a,0.1,0,0,0,0,-1\nr2,1,a,0.1,0,0,0,0,-2\n";
  const std::string header = std::string("recording,") + kPlainHeader;
  const ForceFile truth = Read("truth.csv", header + truth_rows);
  const FileComparison both = CompareForces(truth, truth, {});
  ASSERT_THAT(both.recordings, SizeIs(2));
  EXPECT_EQ(both.all.found(), 2);
  EXPECT_EQ(both.all.All().mean_relative_error, 0.0);
  const ForceFile nameless = Read("forces.csv", std::string(kPlainHeader) + "1,c,0.1,0,0,0,0,-2\n");
  EXPECT_THAT(MessageOf([&] { CompareForces(nameless, truth, {}); }),
              AllOf(HasSubstr("TRUTH has r1, r2"), HasSubstr("--recording")));
  FileComparisonRules rules;
  rules.recordings = {"r2"};
  EXPECT_EQ(CompareForces(nameless, truth, rules).all.All().mean_relative_error, 0.0);
  rules.recordings = {"r3"};
  EXPECT_THAT(MessageOf([&] { CompareForces(truth, truth, rules); }),
              HasSubstr("'r3' is in neither file"));
  const ForceFile other = Read("other.csv", header + "r7,1,a,0.1,0,0,0,0,-1\n");
  EXPECT_THAT(MessageOf([&] { CompareForces(other, truth, {}); }),
              HasSubstr("no recording is in both files"));
}

TEST_F(CompareFiles, AWordThatIsNoStatusIsRefusedWhereItIs) {
  EXPECT_THAT(MessageOf([&] {
                Read("forces.csv",
                     "t_s,contact,x_m,y_m,z_m,fx_N,fy_N,fz_N,status\n"
                     "1,a,0,0,0,0,0,1,fine\n");
              }),
              AllOf(HasSubstr("forces.csv:2:"), HasSubstr("'fine'"), HasSubstr("no_contact")));
  EXPECT_THAT(MessageOf([&] { Read("empty.csv", kPlainHeader); }), HasSubstr("has no row"));
}

TEST_F(CompareFiles, AnIntervalFollowsFromTheCovarianceWhereItIsAbsent) {
  const ForceFile read = Read("forces.csv",
                              "t_s,contact,x_m,y_m,z_m,fx_N,fy_N,fz_N,cov_xx_N2,cov_xy_N2,"
                              "cov_xz_N2,cov_yy_N2,cov_yz_N2,cov_zz_N2\n"
                              "1,a,0,0,0,0,0,5,0.0001,0,0,0.0001,0,0.0004\n");
  EXPECT_NEAR(read.of_recording.at("")[0].contacts[0].ci95_N, 1.96 * 0.02, 1e-4);
}

/// A simulated truth, and estimates whose errors are drawn from the covariance that they state.
TEST_F(CompareFiles, DrawnErrorsAreConsistentAndThoseOfAnotherCovarianceAreNot) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 0.05);
  Answer answer;
  std::string rows[2];
  for (int k = 0; k < 60; ++k) {
    const std::string name = "r" + std::to_string(k);
    RecordingTruth& truth = answer.recordings.emplace_back();
    truth.name = name;
    truth.frames.push_back({0.0, {{"tool", {0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.0, -1.0}}}});
    std::string force;
    for (const double true_N : {0.0, 0.0, -1.0})
      force += FormatNumber(true_N + normal(random)) + ",";
    const std::string head = name + ",0,c,0.1,0,0," + force + "0.1,0,ok,";
    rows[0] += head + "0.0025,0,0,0.0025,0,0.0025\n";
    rows[1] += head + "0.00125,0,0,0.00125,0,0.00125\n";
  }
  const auto truth = folder_.Write("exp.answer.json", FormatAnswer(answer));
  const auto compare = [&](const std::string& text) {
    CompareOptions options;
    options.estimated = folder_.Write("forces.csv", kEstimateHeader + text);
    options.truth = truth;
    options.json = true;
    return nlohmann::json::parse(VerbOutput(options)).at("all");
  };
  const auto right = compare(rows[0]);
  EXPECT_EQ(right.at("contacts"), 60);
  EXPECT_GE(right.at("nees_per_degree"), right.at("nees_per_degree_expected").at(0));
  EXPECT_LE(right.at("nees_per_degree"), right.at("nees_per_degree_expected").at(1));
  const auto halved = compare(rows[1]);
  EXPECT_GT(halved.at("nees_per_degree"), halved.at("nees_per_degree_expected").at(1));
}

/// Places off by (0, 3) and (4, 0) mm, one standard deviation each; across the surface, z, none.
TEST_F(CompareFiles, PlacesAreNormalisedAlongTheSurface) {
  const auto row = [](const char* time, const char* place_m) {
    return "," + std::string(time) + ",ball," + place_m +
           ",0,0,0,-1,0.1,0.01,ok,0.01,0,0,0.01,0,0.01,1.6e-5,0,0,9e-6,0,0\n";
  };
  const std::string header =
      std::string(kEstimateHeader).substr(0, std::string(kEstimateHeader).size() - 1) +
      ",location_cov_xx_m2,location_cov_xy_m2,location_cov_xz_m2,location_cov_yy_m2,"
      "location_cov_yz_m2,location_cov_zz_m2\n";
  CompareOptions options;
  options.estimated =
      folder_.Write("forces.csv", header + row("1", "0.1,0.003") + row("1.1", "0.104,0"));
  PushTruth();
  options.truth = folder_ / "truth.csv";
  options.json = true;
  const auto all = nlohmann::json::parse(VerbOutput(options)).at("all");
  EXPECT_NEAR(all.at("location_nees_per_degree").get<double>(), 0.5, 1e-9);
}

TEST_F(CompareFiles, TheVerbRefusesOptionsBelowZero) {
  CompareOptions options;
  options.estimated = options.truth =
      folder_.Write("f.csv", std::string(kPlainHeader) + "1,c,0.1,0,0,0,0,-2\n");
  EXPECT_THAT(VerbOutput(options), HasSubstr("1 of 1 steady forces detected"));
  options.same_place_m = -1.0;
  EXPECT_THAT(MessageOf([&] { Compare(options); }),
              AllOf(HasSubstr("--same-place"), HasSubstr("-1")));
  options.same_place_m = 0.04;
  options.truth = folder_ / "absent.csv";
  EXPECT_THAT(MessageOf([&] { Compare(options); }), HasSubstr("absent.csv"));
}

}  // namespace
}  // namespace palpate::command

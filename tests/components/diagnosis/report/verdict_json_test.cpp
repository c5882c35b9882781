// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/verdict_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/components/diagnosis/report/example_result.hpp"

namespace palpate::diagnosis {
namespace {

using nlohmann::json;

json Written(const DiagnosisResult& result) { return json::parse(FormatVerdict(result)); }

TEST(VerdictJson, HoldsWhatArchitectureShows) {
  const DiagnosisResult result = FrictionExample();
  const json verdict = Written(result);
  EXPECT_EQ(verdict["verdict"], "cause");
  ASSERT_EQ(verdict["causes"].size(), 1U);
  const json& cause = verdict["causes"][0];
  EXPECT_EQ(cause["id"], "cable_friction");
  EXPECT_EQ(cause["where"], "cable:north");
  EXPECT_EQ(cause["parameters"]["mu"]["value"], 0.2134);
  EXPECT_EQ(cause["parameters"]["mu"]["ci95"], json({0.1951, 0.2322}));
  EXPECT_EQ(cause["probability"], 0.97);
  ASSERT_EQ(verdict["alternatives"].size(), result.rivals.size());
  EXPECT_EQ(verdict["alternatives"][0]["id"], "backlash");
  EXPECT_EQ(verdict["alternatives"][0]["where"], "cable:north");
  EXPECT_EQ(verdict["alternatives"][0]["probability"], 0.017);
  EXPECT_EQ(verdict["indistinguishable_from"], json::array());
  const json& rms = verdict["residual_m_rms"];
  EXPECT_EQ(rms["before"], result.model_error.before_m);
  EXPECT_EQ(rms["after"], result.model_error.after_m);
  EXPECT_EQ(rms["heldout_before"], result.model_error.heldout_before_m);
  EXPECT_EQ(rms["heldout_after"], result.model_error.heldout_after_m);
  EXPECT_EQ(rms["noise"], result.model_error.noise_m);
  EXPECT_EQ(rms["healthy"], result.model_error.null_model_m);
  EXPECT_EQ(rms["heldout_gain_ci95"][0], result.model_error.heldout_gain_low_m);
  EXPECT_EQ(rms.size(), 7U);
  EXPECT_EQ(verdict["force_error_N_rms"]["before"], result.force_error.before_N);
  EXPECT_EQ(verdict["force_error_N_rms"]["after"], result.force_error.after_N);
  EXPECT_EQ(verdict["force_error_N_rms"]["forces"], 140);
  EXPECT_EQ(cause["in_file"][0]["what"], "friction of cable `north`");
  EXPECT_EQ(cause["in_file"][0]["before"], 0.0);
  EXPECT_EQ(cause["in_file"][0]["after"], 0.2134);
  EXPECT_EQ(verdict["simulated_healthy"]["accused"], 4);
  EXPECT_EQ(verdict["clear_evidence"], 10.0);
  ASSERT_EQ(verdict["smallest_findable"].size(), 3U);
  EXPECT_EQ(verdict["smallest_findable"][0]["id"], "cable_friction");
  EXPECT_EQ(verdict["smallest_findable"][0]["value"], 0.061);
  EXPECT_TRUE(verdict["smallest_findable"][2]["value"].is_null());
  EXPECT_EQ(verdict["next_experiment"]["title"], result.experiments[0].title);
  EXPECT_EQ(verdict["next_experiment"]["separates"][1]["id"], "backlash");
  ASSERT_EQ(verdict["next_experiment"]["others"].size(), 1U);
  EXPECT_EQ(verdict["next_experiment"]["others"][0]["title"], result.experiments[1].title);
  EXPECT_EQ(verdict["recordings"].size(), result.recordings.size());
  EXPECT_EQ(verdict["data_hash"], result.data_hash);
}

TEST(VerdictJson, HoldsTheForcesThatWouldDoWhatIsLeft) {
  const ResidualForces forces{.recording = "r1",
                              .place_m = Eigen::Matrix3Xd::Constant(3, 2, 0.01),
                              .before_N = Eigen::Matrix3Xd::Constant(3, 2, 0.2),
                              .after_N = Eigen::Matrix3Xd::Constant(3, 2, 0.1)};
  DiagnosisResult result = FrictionExample();
  result.residual_forces = forces;
  const json written = Written(result)["residual_forces"];
  EXPECT_EQ(written["recording"], "r1");
  ASSERT_EQ(written["forces"].size(), 2U);
  EXPECT_EQ(written["forces"][1]["at_m"], json({0.01, 0.01, 0.01}));
  EXPECT_EQ(written["forces"][1]["before_N"], json({0.2, 0.2, 0.2}));
  EXPECT_EQ(written["forces"][1]["after_N"], json({0.1, 0.1, 0.1}));
  EXPECT_EQ(Written(DataUnfitExample())["residual_forces"]["forces"], json::array());
}

TEST(VerdictJson, SaysWhatIsLeastLikeNoise) {
  DiagnosisResult result = FrictionExample();
  result.residual_test = {false, "runs in recording r1", 4.7, 3.7, 0.31};
  EXPECT_EQ(Written(result)["what_is_left"], json({{"is_noise", false},
                                                   {"test", "runs in recording r1"},
                                                   {"surprise", 4.7},
                                                   {"surprise_limit", 3.7},
                                                   {"excess", 0.31}}));
  EXPECT_TRUE(Written(DataUnfitExample())["what_is_left"].is_null());
}

TEST(VerdictJson, SpellsEveryVerdict) {
  std::vector<std::string> spelled;
  for (const DiagnosisResult& result : AllExamples()) spelled.push_back(Written(result)["verdict"]);
  EXPECT_THAT(spelled, testing::ElementsAre("cause", "indistinguishable", "partly_explained",
                                            "unexplained", "no_fault", "data_unfit"));
}

TEST(VerdictJson, ListsSeveralPlaces) {
  DiagnosisResult result = FrictionExample();
  result.causes[0].name = {"swapped_cables", {"cable:north", "cable:west"}};
  result.indistinguishable_from = {{"drive_coupling", {"cable:east", "cable:west"}}};
  const json verdict = Written(result);
  EXPECT_EQ(verdict["causes"][0]["where"], json({"cable:north", "cable:west"}));
  EXPECT_EQ(verdict["indistinguishable_from"][0]["where"], json({"cable:east", "cable:west"}));
}

TEST(VerdictJson, WritesNullForWhatIsNotKnown) {
  DiagnosisResult result = FrictionExample();
  result.causes[0].parameters[0].ci95_high = std::numeric_limits<double>::infinity();
  result.model_error.heldout_after_m = std::numeric_limits<double>::quiet_NaN();
  result.experiments.clear();
  const json verdict = Written(result);
  EXPECT_TRUE(verdict["causes"][0]["parameters"]["mu"]["ci95"][1].is_null());
  EXPECT_TRUE(verdict["residual_m_rms"]["heldout_after"].is_null());
  EXPECT_TRUE(verdict["next_experiment"].is_null());
  EXPECT_TRUE(Written(DataUnfitExample())["residual_m_rms"]["before"].is_null());
}

TEST(VerdictJson, ReadsBackWhateverTheNamesHold) {
  DiagnosisResult result = FrictionExample();
  result.recordings[0].name = "a \"b\"\n\\ <c> \x01";
  result.reason = "no UTF-8: \xFF";
  const json verdict = Written(result);
  EXPECT_EQ(verdict["recordings"][0]["name"], result.recordings[0].name);
  EXPECT_EQ(verdict["reason"], "no UTF-8: \xEF\xBF\xBD");
}

}  // namespace
}  // namespace palpate::diagnosis

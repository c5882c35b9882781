// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/joined_diagnosis.hpp"

#include <gtest/gtest.h>

namespace palpate::diagnosis {
namespace {

/// One recording with the noise of 1, as if robots within their tolerances left this there.
Diagnosis Leaves(double null_model_m, const std::string& cause) {
  Diagnosis diagnosis;
  DiagnosisResult& result = diagnosis.result;
  result.verdict = Verdict::kCause;
  result.reason = "Made up.";
  result.recordings = {{.name = "r",
                        .kind = "ramp",
                        .samples = 4,
                        .before_m = 2.0 * null_model_m,
                        .null_model_m = null_model_m,
                        .after_m = 1.0,
                        .heldout_before_m = 1.5 * null_model_m,
                        .heldout_after_m = 1.1,
                        .noise_m = 1.0}};
  result.model_error = {2.0 * null_model_m, null_model_m, 1.0, 1.5 * null_model_m, 1.1, 1.0};
  if (!cause.empty()) {
    NamedCause& named = result.causes.emplace_back();
    named.name = {cause, {"body"}};
    named.explained_share = 0.8;
  }
  return diagnosis;
}

TEST(JoinedDiagnosis, BeginsAtTheFileAndEndsOnTheFinerMesh) {
  Diagnosis of_file = Leaves(5.0, "discretisation");
  for (const char* id : {"density", "payload"}) {
    of_file.result.rivals.emplace_back().name = {id, {"body"}};
  }
  const DiagnosisResult result = Joined(of_file, Leaves(3.0, "density")).result;
  ASSERT_EQ(result.causes.size(), 2U);
  EXPECT_EQ(result.causes[0].name.id, "discretisation");
  EXPECT_EQ(result.causes[1].name.id, "density");
  ASSERT_EQ(result.rivals.size(), 1U);
  EXPECT_EQ(result.rivals[0].name.id, "payload");
  // 5^2 - 1 of squares beyond the noise, of which 3^2 - 1 stay.
  EXPECT_NEAR(result.causes[0].explained_share, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(result.causes[1].explained_share, 0.8 / 3.0, 1e-12);
  EXPECT_EQ(result.model_error.before_m, of_file.result.model_error.before_m);
  EXPECT_EQ(result.recordings[0].null_model_m, of_file.result.recordings[0].null_model_m);
  EXPECT_EQ(result.recordings[0].after_m, 1.0);
  EXPECT_EQ(result.verdict, Verdict::kCause);
}

TEST(JoinedDiagnosis, IsOfTheMeshAloneWhereNothingIsWrongBesideIt) {
  Diagnosis of_finer = Leaves(1.0, "");
  of_finer.result.verdict = Verdict::kNoFault;
  const DiagnosisResult result = Joined(Leaves(5.0, "discretisation"), of_finer).result;
  ASSERT_EQ(result.causes.size(), 1U);
  EXPECT_EQ(result.verdict, Verdict::kCause);
  EXPECT_EQ(result.causes[0].explained_share, 1.0);
}

TEST(JoinedDiagnosis, ExplainsAPartWhereMoreIsWrongThatNoCauseExplains) {
  Diagnosis of_finer = Leaves(3.0, "");
  of_finer.result.verdict = Verdict::kUnexplained;
  EXPECT_EQ(Joined(Leaves(5.0, "discretisation"), of_finer).result.verdict,
            Verdict::kPartlyExplained);
}

TEST(JoinedDiagnosis, SaysWhereTheFinerMeshCouldNotBeDiagnosed) {
  Diagnosis of_finer;
  of_finer.result = Unfit("no sample could be simulated");
  const DiagnosisResult result = Joined(Leaves(5.0, "discretisation"), of_finer).result;
  EXPECT_EQ(result.causes.size(), 1U);
  EXPECT_FALSE(result.search_complete);
  EXPECT_NE(result.reason.find("no sample could be simulated"), std::string::npos);
}

TEST(JoinedDiagnosis, IsOfTheFileWhereThatOfTheFinerMeshWasInterrupted) {
  Diagnosis of_finer = Leaves(1.0, "");
  of_finer.result.interrupted = true;
  const DiagnosisResult result = Joined(Leaves(5.0, "discretisation"), of_finer).result;
  EXPECT_EQ(result.causes.size(), 1U);
  EXPECT_TRUE(result.interrupted);
  EXPECT_FALSE(result.search_complete);
}

}  // namespace
}  // namespace palpate::diagnosis

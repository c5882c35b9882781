// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include "libs/core/error.hpp"
#include "tests/support/test_folder.hpp"
#include "tests/system/blind/verdict.hpp"

/// verdict.json as docs/experiment.md describes it.
namespace palpate::blind {
namespace {

const std::string kVerdict = R"({"verdict": "cause",
"causes": [{"id": "cable_friction", "where": "cable:north",
            "parameters": {"mu": {"value": 0.21, "ci95": [0.19, 0.23]}}, "probability": 0.97}],
"alternatives": [{"id": "swapped_cables", "where": ["cable:north", "cable:east"],
                  "probability": 0.01}],
"indistinguishable_from": [{"id": "backlash", "where": "cable:north"}],
"residual_m_rms": {"before": 0.0041, "after": 0.0008, "heldout_before": 0.0041,
                   "heldout_after": 0.0009, "noise": 0.0007}, "next_experiment": {}})";

class BlindVerdict : public testing::Test {
 protected:
  Verdict Read(const std::string& text) { return ReadVerdict(folder_.Write("verdict.json", text)); }
  /// What is said where `from` is replaced.
  std::string Complaint(const std::string& from, const std::string& to) {
    std::string text = kVerdict;
    text.replace(text.find(from), from.size(), to);
    try {
      Read(text);
    } catch (const RunError& error) {
      return error.what();
    }
    return "";
  }
  test_support::TestFolder folder_;
};

TEST_F(BlindVerdict, IsReadAsItIsWritten) {
  const Verdict verdict = Read(kVerdict);
  EXPECT_EQ(verdict.verdict, "cause");
  ASSERT_EQ(verdict.causes.size(), 1u);
  EXPECT_EQ(verdict.causes[0].id, "cable_friction");
  EXPECT_EQ(verdict.causes[0].probability, 0.97);
  EXPECT_EQ(verdict.causes[0].parameters.at("mu").ci95_high, 0.23);
  EXPECT_THAT(verdict.alternatives[0].where, testing::ElementsAre("cable:north", "cable:east"));
  EXPECT_EQ(verdict.indistinguishable_from[0].id, "backlash");
  EXPECT_EQ(verdict.residuals_m.heldout_after, 0.0009);
  ASSERT_EQ(verdict.First(2).size(), 2u);
  EXPECT_EQ(verdict.First(2)[1]->id, "backlash");
  EXPECT_EQ(verdict.First(9).size(), 3u);
}

TEST_F(BlindVerdict, IsRefusedWhereItIsNone) {
  EXPECT_NE(Complaint(R"("verdict": "cause")", R"("verdict": "guilty")"), "");
  EXPECT_NE(Complaint("0.97", "1.2"), "");
  EXPECT_NE(Complaint("0.97", "null"), "");
  EXPECT_NE(Complaint("[0.19, 0.23]", "[0.23, 0.19]"), "");
  EXPECT_NE(Complaint("[0.19, 0.23]", "[null, 0.19]"), "");
  EXPECT_NE(Complaint(R"("id": "backlash", )", ""), "");
  EXPECT_NE(Complaint(R"("alternatives")", R"("others")"), "");
  EXPECT_NE(Complaint(R"({"verdict")", R"("verdict")"), "");
  EXPECT_NE(Complaint(R"("causes")", R"("causes": [], "those")"), "");
  EXPECT_EQ(Complaint("0.0009", "null"), "");  // it was not cross-validated
}

}  // namespace
}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/vocabulary/verdict_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "components/diagnosis/vocabulary/number_text.hpp"
#include "tests/components/diagnosis/report/example_result.hpp"
#include "tests/support/not_a_number.hpp"

namespace palpate::diagnosis {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(NumberText, ShowsAParameterAsPreciselyAsItIsKnown) {
  EXPECT_EQ(DescribeParameter({"mu", 0.2134, 0.1951, 0.2322}).whole, "mu = 0.213 \u00B1 0.019");
  EXPECT_EQ(DescribeParameter({"offset_m", 0.00213, 0.00183, 0.00243}).whole,
            "offset = 2.1 \u00B1 0.3 mm");
  EXPECT_EQ(DescribeParameter({"k_N_m", 1512.0, 1304.0, 1720.0}).whole, "k = 1512 \u00B1 208 N/m");
  EXPECT_EQ(DescribeParameter({"mass_kg", 0.02, 0.016, 0.024}).whole, "mass = 20 \u00B1 4 g");
  EXPECT_EQ(DescribeParameter({"compliance_rad_Nm", 0.5, 0.46, 0.54}).unit, "rad/(N m)");
  EXPECT_EQ(DescribeParameter({"C2_over_C1", 0.5, 0.46, 0.54}).name, "C2/C1");
}

TEST(NumberText, WritesALopsidedIntervalOut) {
  const ParameterText text = DescribeParameter({"tau_s", 31.0, 17.0, 58.0});
  EXPECT_EQ(text.whole, "tau = 31 s, 17 to 58");
  EXPECT_EQ(text.interval, "17 to 58");
}

TEST(NumberText, SaysWhatIsNotKnown) {
  EXPECT_EQ(LengthText(kNaN), "not known");
  EXPECT_EQ(ProbabilityText(kNaN), "not known");
  EXPECT_EQ(ProbabilityText(1e-9), "< 0.001");
  EXPECT_EQ(DescribeParameter({"mu", 0.2, kNaN, kNaN}).interval, "not known");
  EXPECT_EQ(DescribeParameter({"mu", 0.2, kNaN, kNaN}).whole, "mu = 0.200");
}

TEST(NumberText, GivesNoIntervalToWhatWasWorkedOut) {
  EXPECT_EQ(DescribeParameter({"relative_error", 0.2349, 0.2349, 0.2349}).interval, "computed");
  DiagnosisResult result = FrictionExample();
  result.causes.front().parameters = {{"relative_error", 0.2349, 0.2349, 0.2349}};
  EXPECT_EQ(VerdictHeadline(result), "Friction of cable north, relative error = 0.235, p = 0.97.");
}

TEST(VerdictWords, SayTheCauseItsSizeAndHowSure) {
  EXPECT_EQ(VerdictHeadline(FrictionExample()),
            "Friction of cable north, mu = 0.213 \u00B1 0.019 (95 %), p = 0.97.");
  const std::string all = VerdictParagraph(FrictionExample());
  EXPECT_THAT(all, HasSubstr("Explains: 83 % of the misfit beyond noise and tolerances."));
  EXPECT_THAT(all, HasSubstr("Left-out error, without and with: 0.52"));
  EXPECT_THAT(all, HasSubstr("Force error at known loads, without and with: 0.120 \u2192 0.0310 N "
                             "(RMS, 140 forces in 2 recordings)"));
  EXPECT_THAT(all, HasSubstr(" mm (noise 0.300 mm), a gain of 0."));
  EXPECT_THAT(
      all, HasSubstr("In the files: friction of cable `north`: 0.00 \u2192 0.213 \u00B1 0.019."));
  EXPECT_THAT(all, HasSubstr("A healthy robot would be accused in 2.0 % of cases (4 of 200"));
  EXPECT_THAT(all, HasSubstr("Seen in: 02_ramp_north, 06_hold_north"));
  EXPECT_THAT(all, HasSubstr("Ruled out: backlash of cable north, creep of the body"));
  EXPECT_THAT(all, HasSubstr("Not identifiable from: none."));
  EXPECT_THAT(all, HasSubstr("Not yet certain: whether it is friction of cable north or backlash "
                             "of cable north. Do next: ramp of cable north to 12 mm"));
}

TEST(VerdictWords, SayWhereNoRecordingWouldSettleAQuestion) {
  DiagnosisResult result = FrictionExample();
  result.experiments.front().expected_ln_bayes_factor = 1.24;
  const std::string all = VerdictParagraph(result);
  EXPECT_THAT(all, HasSubstr("No proposed recording settles it: their effects are alike in all of "
                             "them. Best: ramp of cable north to 12 mm, twice as slowly, expected "
                             "ln BF 1.2, where 3.0 is a clear answer."));
  EXPECT_THAT(all, Not(HasSubstr("Do next")));
  result.experiments.clear();
  EXPECT_THAT(VerdictParagraph(result), Not(HasSubstr("Not yet certain")));
}

TEST(VerdictWords, SayTheValueInTheTermsOfTheFile) {
  DiagnosisResult result = FrictionExample();
  result.causes.front().in_file = {{"E of `middle`", "kPa", 250.0, 179.0, 169.0, 189.0}};
  EXPECT_THAT(ChangeTexts(result),
              testing::ElementsAre("E of `middle`: 250 \u2192 179 \u00B1 10 kPa"));
}

TEST(VerdictWords, BoundTheShareOfHealthyRobotsWhereNoneWasAccused) {
  DiagnosisResult result = FrictionExample();
  result.simulated_healthy.accused = 0;
  EXPECT_EQ(
      HealthyText(result),
      "A healthy robot would be accused in less than 1.5 % of cases (0 of 200 simulated), as a "
      "cause needs ln BF 10");
  result.simulated_healthy.drawn = 0;
  EXPECT_EQ(HealthyText(result), "");
}

TEST(VerdictWords, NameEachOfSeveralCauses) {
  EXPECT_EQ(VerdictHeadline(TwoCausesExample()),
            "Friction of cable north, mu = 0.213 \u00B1 0.019 (95 %), p = 0.97; and creep of the "
            "body, g = 0.12 \u00B1 0.02, tau = 31 s, 17 to 58 (95 %), p = 0.91.");
  EXPECT_THAT(VerdictParagraph(TwoCausesExample()), HasSubstr("Not cross-validated: creep of the"));
}

TEST(VerdictWords, DoNotRuleOutWhatFitsAlike) {
  DiagnosisResult result = IndistinguishableExample();
  result.rivals[0].probability = 0.04;
  EXPECT_EQ(VerdictHeadline(result),
            "There is a fault, and 2 causes are not identifiable: friction of cable north and "
            "backlash of cable north.");
  const std::string all = VerdictParagraph(result);
  EXPECT_THAT(all, HasSubstr("Not identifiable from: backlash of cable north."));
  EXPECT_THAT(all, Not(HasSubstr("Ruled out: backlash")));
}

TEST(VerdictWords, SayWhereNoCauseIsNamed) {
  EXPECT_THAT(VerdictHeadline(PartlyExplainedExample()),
              HasSubstr("Residuals beyond the noise remain"));
  EXPECT_THAT(VerdictHeadline(UnexplainedExample()),
              HasSubstr("no fault of the catalogue explains"));
  EXPECT_THAT(VerdictHeadline(HealthyExample()),
              HasSubstr("within noise and manufacturing tolerances, p = 0.96."));
  EXPECT_EQ(
      VerdictHeadline(DataUnfitExample()),
      "The data are unfit for a diagnosis: the markers of recording 04_ramp_south stand still "
      "while its cable moves 8 mm.");
  for (const DiagnosisResult& result : {HealthyExample(), UnexplainedExample()}) {
    EXPECT_THAT(VerdictParagraph(result), HasSubstr("as the robot file has it"));
    EXPECT_THAT(VerdictParagraph(result), Not(HasSubstr("not known")));
  }
  EXPECT_THAT(VerdictParagraph(DataUnfitExample()), Not(HasSubstr("Error")));
}

}  // namespace
}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include "tests/system/blind/acceptance.hpp"
#include "tests/system/blind/judge/made_up.hpp"
#include "tests/system/blind/parameter_errors.hpp"

/// Each figure of the judge, one verdict at a time.
namespace palpate::blind {
namespace {

using scenario::ActiveEffect;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const ActiveEffect kGain{.id = "cable_gain", .where = {"cable:north"}, .parameters = {{"g", 0.1}}};
const ActiveEffect kDense{.id = "density", .where = {"body"}, .parameters = {{"factor", 1.2}}};
const ActiveEffect kLateBody{.id = "lag", .where = {"body"}, .parameters = {{"delay_s", 0.1}}};

CaseRecord Case(CaseKind kind, std::vector<ActiveEffect> truth) {
  CaseRecord record{.kind = kind, .truth = std::move(truth)};
  record.sizes_m.assign(record.truth.size(), 1e-3);
  return record;
}

CaseRecord Case(CaseKind kind, std::vector<ActiveEffect> truth,
                const std::vector<ActiveEffect>& named) {
  CaseRecord record = Case(kind, std::move(truth));
  record.verdict = Verdict{.verdict = named.empty() ? "no_fault" : "cause"};
  for (const ActiveEffect& effect : named) record.verdict->causes.push_back(Accused(effect));
  return record;
}

CaseRecord One(const std::vector<ActiveEffect>& named) {
  return Case(CaseKind::kOneCause, {kGain}, named);
}

TEST(BlindScore, TheFirstThatIsNamedCounts) {
  EXPECT_EQ(Judge({One({kGain})}).top1.hits, 1);
  const Score second = Judge({One({kDense, kGain})});
  EXPECT_EQ(second.top1.hits, 0);
  EXPECT_EQ(second.top3.hits, 1);
  EXPECT_EQ(Outcome(One({kDense, kGain})), "AMONG THREE");
  EXPECT_EQ(Outcome(One({})), "MISSED");
}

TEST(BlindScore, ThreeAreTakenFromCausesThenRivalsThenAlternatives) {
  CaseRecord record = One({kDense});
  ActiveEffect other = kDense;
  other.id = "lag";
  record.verdict->indistinguishable_from = {Accused(kDense), Accused(other)};
  record.verdict->alternatives = {Accused(kGain)};
  EXPECT_EQ(Judge({record}).top3.hits, 1);  // the first is named twice
  other.id = "temperature";
  record.verdict->indistinguishable_from.push_back(Accused(other));
  EXPECT_EQ(Judge({record}).top3.hits, 0);  // there it is the fourth
}

TEST(BlindScore, AnotherPlaceIsAnotherCause) {
  ActiveEffect elsewhere = kGain;
  elsewhere.where = {"cable:south"};
  const Score score = Judge({One({elsewhere})});
  EXPECT_EQ(score.top1.hits, 0);
  EXPECT_EQ(score.place.hits, 0);
  EXPECT_EQ(score.place.count, 1);
  EXPECT_EQ(Judge({One({kDense})}).place.count, 0);
}

TEST(BlindScore, SwappedCablesHaveNoOrderAndCoupledOnesHave) {
  for (const std::string id : {"swapped_cables", "drive_coupling"}) {
    const ActiveEffect pair{.id = id, .where = {"cable:north", "cable:east"}, .parameters = {}};
    const ActiveEffect turned{.id = id, .where = {"cable:east", "cable:north"}, .parameters = {}};
    const Score score = Judge({Case(CaseKind::kOneCause, {pair}, {turned})});
    EXPECT_EQ(score.top1.hits, id == "swapped_cables" ? 1 : 0) << id;
  }
}

TEST(BlindScore, ATwinIsAsGood) {
  const ActiveEffect spring{
      .id = "cable_elasticity", .where = {"cable:north"}, .parameters = {{"k_N_m", 1000.0}}};
  ActiveEffect soft = spring;
  soft.id = "cable_cutting";
  EXPECT_EQ(Judge({Case(CaseKind::kOneCause, {spring}, {soft})}).top1.hits, 1);
  EXPECT_EQ(Judge({Case(CaseKind::kOneCause, {soft}, {kGain})}).top1.hits, 0);
}

TEST(BlindScore, WhatIsTooSmallToSeeIsNotHeldAgainstAnybody) {
  CaseRecord record = One({});
  record.sizes_m = {2.9e-4};
  EXPECT_EQ(Judge({record}).top1.count, 0);
  record.sizes_m = {3.1e-4};
  EXPECT_EQ(Judge({record}).top1.count, 1);
  CaseRecord two = Case(CaseKind::kTwoCauses, {kGain, kDense}, {});
  two.sizes_m = {1e-3, 1.9e-4};
  EXPECT_EQ(Judge({two}).both.count, 0);
  two.sizes_m = {1e-3, 2.1e-4};
  EXPECT_EQ(Judge({two}).both.count, 1);
  CaseRecord outside = Case(CaseKind::kOutside, {kGain}, {});
  outside.sizes_m = {2e-4};
  EXPECT_EQ(Judge({outside}).flagged.count, 0);
}

TEST(BlindScore, OfTwoCausesBothOneOrAThird) {
  const auto score = [](const std::vector<ActiveEffect>& named) {
    return Judge({Case(CaseKind::kTwoCauses, {kGain, kDense}, named)});
  };
  EXPECT_EQ(score({kDense, kGain}).both.hits, 1);
  EXPECT_EQ(score({kDense, kGain}).third.hits, 0);
  EXPECT_EQ(score({kDense}).both.hits, 0);
  EXPECT_EQ(score({kDense}).one.hits, 1);
  EXPECT_EQ(score({kDense, kGain, kLateBody}).both.hits, 1);
  EXPECT_EQ(score({kDense, kGain, kLateBody}).third.hits, 1);
  EXPECT_EQ(score({kLateBody}).one.hits, 0);
}

TEST(BlindScore, HealthyRobotsAreAccusedByCausesAndByIndistinguishableOnes) {
  EXPECT_EQ(Judge({Case(CaseKind::kHealthy, {}, {})}).false_accusations.hits, 0);
  EXPECT_EQ(Judge({Case(CaseKind::kHealthy, {}, {kGain})}).false_accusations.hits, 1);
  CaseRecord record = Case(CaseKind::kHealthy, {}, {});
  record.verdict->verdict = "indistinguishable";
  EXPECT_EQ(Judge({record}).false_accusations.hits, 1);
  record.verdict->verdict = "unexplained";
  EXPECT_EQ(Judge({record}).false_accusations.hits, 0);
  EXPECT_EQ(Judge({record}).false_flags.hits, 1);
}

TEST(BlindScore, OutsideOfTheCatalogueIsFlaggedNotNamed) {
  for (const std::string verdict : {"unexplained", "partly_explained", "cause", "no_fault"}) {
    CaseRecord record = Case(CaseKind::kOutside, {kGain}, {});
    record.verdict->verdict = verdict;
    const bool flagged = verdict == "unexplained" || verdict == "partly_explained";
    EXPECT_EQ(Judge({record}).flagged.hits, flagged ? 1 : 0) << verdict;
    EXPECT_EQ(Judge({record}).false_flags.count, 0);
  }
}

TEST(BlindScore, CorruptedDataAreUnfitAndNeverACause) {
  CaseRecord record = Case(CaseKind::kCorrupted, {kGain}, {kGain});
  EXPECT_EQ(Judge({record}).unfit.hits, 0);
  record.verdict->verdict = "data_unfit";
  EXPECT_EQ(Judge({record}).unfit.hits, 0);
  record.verdict->causes.clear();
  EXPECT_EQ(Judge({record}).unfit.hits, 1);
}

TEST(BlindScore, CasesThatWereNotMadeCountNowhereElse) {
  CaseRecord record = Case(CaseKind::kOneCause, {kGain});
  record.not_made = "not converged";
  const Score score = Judge({record});
  EXPECT_EQ(score.not_made, 1);
  EXPECT_EQ(score.top1.count + score.without_verdict.count + score.wrongly_unfit.count, 0);
}

TEST(BlindScore, ParametersComeByNameVectorsAsAWhole) {
  const ActiveEffect force{
      .id = "permanent_force",
      .where = {"body"},
      .parameters = {
          {"fx_N", 0.3}, {"fy_N", 0.4}, {"fz_N", 0.0}, {"x_m", 0.01}, {"y_m", 0.0}, {"z_m", 0.1}}};
  std::map<std::string, Estimate> told = {{"fx_N", {0.3, 0.25, 0.35}},  {"fy_N", {0.4, 0.3, 0.5}},
                                          {"fz_N", {0.05, 0.01, 0.09}}, {"x_m", {0.01, 0, 0.1}},
                                          {"y_m", {0.0, -1, 1}},        {"z_m", {0.104, 0.1, 0.2}}};
  ParameterErrors errors = CompareParameters(force, told);
  EXPECT_THAT(errors.of_value, ElementsAre(testing::DoubleNear(0.1, 1e-12)));
  EXPECT_THAT(errors.of_place_m, ElementsAre(testing::DoubleNear(0.004, 1e-12)));
  EXPECT_EQ(errors.covered.hits, 5);
  EXPECT_EQ(errors.covered.count, 6);
  told.erase("fz_N");
  errors = CompareParameters(force, told);
  EXPECT_THAT(errors.of_value, IsEmpty());
  EXPECT_EQ(errors.told.hits, 5);
  EXPECT_EQ(errors.covered.count, 5);
}

TEST(BlindScore, ABentShapesSizeCountsAndNotItsSign) {
  for (const double drawn_m : {0.002, -0.002}) {
    const ActiveEffect bent{
        .id = "plastic_set", .where = {"body"}, .parameters = {{"tip_m", drawn_m}}};
    const ParameterErrors right = CompareParameters(bent, {{"tip_m", {0.0022, 0.0018, 0.0026}}});
    EXPECT_EQ(right.covered.hits, 1);
    EXPECT_NEAR(right.of_value.at(0), 0.1, 1e-9);
    const ParameterErrors wrong = CompareParameters(bent, {{"tip_m", {-0.002, -0.003, -0.001}}});
    EXPECT_EQ(wrong.covered.hits, 0);
    EXPECT_EQ(wrong.covered.count, 1);
  }
}

TEST(BlindScore, AFactorsErrorIsAlsoThatOfTheFault) {
  const ParameterErrors errors = CompareParameters(kDense, {{"factor", {1.26, 1.1, 1.3}}});
  EXPECT_THAT(errors.of_value, ElementsAre(testing::DoubleNear(0.05, 1e-12)));
  EXPECT_THAT(errors.of_fault, ElementsAre(testing::DoubleNear(0.3, 1e-12)));
}

TEST(BlindScore, HeldOutGainIsCountedAboveTheNoise) {
  CaseRecord record = One({kGain});
  record.verdict->residuals_m = {.before = 5e-4, .heldout_after = 4e-4, .noise = 3e-4};
  EXPECT_THAT(Judge({record}).heldout_gains, ElementsAre(testing::DoubleNear(9.0 / 16.0, 1e-12)));
}

TEST(BlindAcceptance, BinomialTailsAreThoseOfTheClosedForm) {
  EXPECT_NEAR(BinomialAtMost(0, 10, 0.3), std::pow(0.7, 10), 1e-12);
  EXPECT_NEAR(BinomialAtMost(9, 10, 0.3), 1.0 - std::pow(0.3, 10), 1e-12);
  EXPECT_NEAR(BinomialAtMost(1, 3, 0.5), 0.5, 1e-12);
  EXPECT_EQ(BinomialAtMost(9, 10, 1.0), 0.0);
  EXPECT_EQ(BinomialAtMost(10, 10, 1.0), 1.0);
}

TEST(BlindAcceptance, FewCasesCondemnNobodyByChanceAndManyDo) {
  Score score;
  score.top1 = {8, 9};
  EXPECT_THAT(Missed(score), IsEmpty());
  score.top1 = {5, 9};
  EXPECT_THAT(Missed(score), ElementsAre(HasSubstr("named first: 5 of 9")));
  score.top1 = {80, 90};
  EXPECT_THAT(Missed(score), IsEmpty());
  score.top1 = {76, 90};
  EXPECT_THAT(Missed(score), ElementsAre(HasSubstr("named first")));
  score.top1 = {800, 900};
  EXPECT_THAT(Missed(score), ElementsAre(HasSubstr("named first")));
}

TEST(BlindAcceptance, OneCorruptedCaseThatIsTakenForSoundIsOneTooMany) {
  Score score;
  score.unfit = {99, 100};
  EXPECT_THAT(Missed(score), ElementsAre(HasSubstr("corrupted data refused")));
}

TEST(BlindAcceptance, MediansAndProbabilitiesAreVerifiedToo) {
  Score score;
  score.parameter_errors.assign(40, 0.06);
  score.heldout_gains.assign(40, 0.8);
  score.forecasts.assign(40, {.probability = 0.5, .right = true});
  EXPECT_EQ(Missed(score).size(), 3u);
  score.parameter_errors.assign(40, 0.04);
  score.heldout_gains.assign(40, 0.92);
  score.forecasts.assign(40, {.probability = 0.97, .right = true});
  EXPECT_THAT(Missed(score), IsEmpty());
}

}  // namespace
}  // namespace palpate::blind

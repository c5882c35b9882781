// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "tests/system/blind/acceptance.hpp"
#include "tests/system/blind/cause_menu.hpp"
#include "tests/system/blind/judge/made_up.hpp"

/// That the blind tests can fail: verdicts that know nothing of the answers, and what they score.
namespace palpate::blind {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint64_t kProofSeed = 20261101;
constexpr int kProofCases = 800;

std::vector<CaseRecord> OfKind(std::vector<CaseRecord> records, CaseKind kind) {
  std::erase_if(records, [&](const CaseRecord& record) { return record.kind != kind; });
  return records;
}

/// Beyond four standard deviations of a binomial share.
double FourSigma(double share, int count) { return 4.0 * std::sqrt(share * (1.0 - share) / count); }

TEST(BlindProofs, WhoKnowsTheAnswersReachesEverything) {
  const Score score = Judge(RightRecords(kProofSeed, kProofCases));
  // A 95 % interval that always covers the truth is too wide by definition, and is judged so.
  Acceptance acceptance;
  acceptance.covered_at_most = 1.0;
  EXPECT_THAT(Missed(score, acceptance), IsEmpty());
  EXPECT_THAT(Missed(score), ElementsAre(HasSubstr("parameters inside their intervals")));
  EXPECT_EQ(score.top1.count, 9 * kProofCases / 20);
  EXPECT_EQ(score.top1.value(), 1.0);
  EXPECT_EQ(score.both.count, 3 * kProofCases / 20);
  EXPECT_EQ(score.false_accusations.count, 5 * kProofCases / 20);
  EXPECT_EQ(score.flagged.count, 2 * kProofCases / 20);
  EXPECT_EQ(score.unfit.count, kProofCases / 20);
}

TEST(BlindProofs, ShuffledAnswersScoreAtChance) {
  auto records = OfKind(RightRecords(kProofSeed, kProofCases), CaseKind::kOneCause);
  std::map<std::string, int> times;
  for (const CaseRecord& record : records) {
    ++times[record.truth[0].id + testing::PrintToString(record.truth[0].where)];
  }
  double chance = 0.0;
  const double count = static_cast<double>(records.size());
  for (const auto& [name, n] : times) chance += (n / count) * (n / count);
  std::vector<Verdict> verdicts;
  for (const CaseRecord& record : records) verdicts.push_back(*record.verdict);
  std::mt19937_64 random(kProofSeed);
  std::shuffle(verdicts.begin(), verdicts.end(), random);
  for (std::size_t i = 0; i < records.size(); ++i) records[i].verdict = verdicts[i];
  const Score score = Judge(records);
  EXPECT_LT(chance, 0.05);
  EXPECT_NEAR(score.top1.value(), chance, FourSigma(chance, score.top1.count));
  EXPECT_THAT(Missed(score), Contains(HasSubstr("one cause, named first")));
  EXPECT_THAT(Missed(score), Contains(HasSubstr("probabilities")));
}

/// north -> west -> south -> east -> north, wherever a cable is named.
std::string Relabelled(const std::string& where) {
  static const std::map<std::string, std::string> kNext = {{"cable:north", "cable:west"},
                                                           {"cable:west", "cable:south"},
                                                           {"cable:south", "cable:east"},
                                                           {"cable:east", "cable:north"}};
  const auto found = kNext.find(where);
  return found == kNext.end() ? where : found->second;
}

TEST(BlindProofs, RelabelledCablesPermuteTheAnswer) {
  auto records = OfKind(RightRecords(kProofSeed, kProofCases), CaseKind::kOneCause);
  Share of_cables;
  for (CaseRecord& record : records) {
    for (std::string& where : record.verdict->causes[0].where) where = Relabelled(where);
    const bool is_cable = record.truth[0].where[0].rfind("cable:", 0) == 0;
    const Score score = Judge({record});
    EXPECT_EQ(score.top1.hits, is_cable ? 0 : 1) << Describe(record.truth[0]);
    of_cables.Add(is_cable);
    for (std::string& where : record.truth[0].where) where = Relabelled(where);
  }
  EXPECT_GT(of_cables.hits, 50);
  EXPECT_EQ(Judge(records).top1.value(), 1.0);
}

TEST(BlindProofs, NoFaultEverywhereFindsNothingAndAccusesNobody) {
  auto records = DrawnRecords(kProofSeed, kProofCases);
  for (CaseRecord& record : records) record.verdict = Verdict{.verdict = "no_fault"};
  const Score score = Judge(records);
  EXPECT_EQ(score.top1.hits, 0);
  EXPECT_EQ(score.top3.hits, 0);
  EXPECT_EQ(score.one.hits, 0);
  EXPECT_EQ(score.flagged.hits, 0);
  EXPECT_EQ(score.unfit.hits, 0);
  EXPECT_EQ(score.false_accusations.hits, 0);
  EXPECT_EQ(score.false_flags.hits, 0);
  EXPECT_TRUE(score.forecasts.empty());
  EXPECT_EQ(Missed(score).size(), 6u);
}

TEST(BlindProofs, OneCauseEverywhereAccusesAllAndIsRightByChance) {
  auto records = DrawnRecords(kProofSeed, kProofCases);
  const scenario::ActiveEffect always{
      .id = "cable_gain", .where = {"cable:north"}, .parameters = {{"g", 0.09}}};
  int there = 0;
  for (CaseRecord& record : records) {
    record.verdict = Verdict{.verdict = "cause", .causes = {Accused(always)}};
    const bool is_it = record.kind == CaseKind::kOneCause && record.truth[0].id == always.id &&
                       record.truth[0].where == always.where;
    there += is_it ? 1 : 0;
  }
  const Score score = Judge(records);
  EXPECT_EQ(score.false_accusations.value(), 1.0);
  EXPECT_EQ(score.top1.hits, there);
  EXPECT_LT(score.top1.value(), 0.05);
  EXPECT_EQ(score.both.hits, 0);
  EXPECT_GT(score.third.value(), 0.9);
  EXPECT_GT(CalibrationError(score.forecasts), 0.8);
  EXPECT_THAT(Missed(score), Contains(HasSubstr("healthy robots accused")));
}

TEST(BlindProofs, DataUnfitEverywhereIsNoWayOut) {
  auto records = DrawnRecords(kProofSeed, kProofCases);
  for (CaseRecord& record : records) record.verdict = Verdict{.verdict = "data_unfit"};
  const Score score = Judge(records);
  EXPECT_EQ(score.unfit.value(), 1.0);
  EXPECT_EQ(score.wrongly_unfit.value(), 1.0);
  EXPECT_THAT(Missed(score), Contains(HasSubstr("sound data refused")));
}

TEST(BlindProofs, WhoSaysNothingReachesNothing) {
  auto records = DrawnRecords(kProofSeed, kProofCases);
  for (CaseRecord& record : records) record.no_verdict = "exit code 1";
  const Score score = Judge(records);
  EXPECT_EQ(score.without_verdict.hits, kProofCases);
  EXPECT_EQ(score.top1.hits, 0);
  EXPECT_EQ(score.false_accusations.value(), 1.0);
  EXPECT_EQ(score.unfit.hits, 0);
}

}  // namespace
}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/score.hpp"

#include <algorithm>
#include <limits>

#include "libs/core/check.hpp"
#include "tests/system/blind/parameter_errors.hpp"

namespace palpate::blind {

namespace {

using scenario::ActiveEffect;

bool IsLarge(const CaseRecord& record, const Limits& limits) {
  const double least_m = record.truth.size() > 1
                             ? limits.each_of_two_sigmas * limits.sigma_m
                             : std::max(limits.single_m, limits.single_sigmas * limits.sigma_m);
  return std::all_of(record.sizes_m.begin(), record.sizes_m.end(),
                     [&](double size_m) { return size_m >= least_m; });
}

bool IsNamed(const ActiveEffect& effect, const std::vector<Suspect>& suspects) {
  return std::any_of(suspects.begin(), suspects.end(),
                     [&](const Suspect& suspect) { return suspect.Names(effect); });
}

bool IsThere(const Suspect& suspect, const std::vector<ActiveEffect>& truth) {
  return std::any_of(truth.begin(), truth.end(),
                     [&](const ActiveEffect& effect) { return suspect.Names(effect); });
}

bool NamesAbsentOne(const CaseRecord& record) {
  const auto& causes = record.verdict->causes;
  return std::any_of(causes.begin(), causes.end(),
                     [&](const Suspect& suspect) { return !IsThere(suspect, record.truth); });
}

bool IsFirst(const CaseRecord& record) {
  const auto& causes = record.verdict->causes;
  return !causes.empty() && causes.front().Names(record.truth.front());
}

bool IsAmongThree(const CaseRecord& record) {
  const auto first = record.verdict->First(3);
  return std::any_of(first.begin(), first.end(),
                     [&](const Suspect* suspect) { return suspect->Names(record.truth.front()); });
}

bool HasPlaces(const ActiveEffect& effect) {
  const scenario::Place place = scenario::FindEffect(effect.id)->place;
  using enum scenario::Place;
  return place != kBody && place != kBase && place != kCamera;
}

void ScoreOneCause(const CaseRecord& record, Score* score) {
  const ActiveEffect& effect = record.truth.front();
  const bool has_verdict = record.verdict.has_value();
  const bool first = has_verdict && IsFirst(record);
  score->top1.Add(first);
  score->top1_of[effect.id].Add(first);
  score->top3.Add(has_verdict && IsAmongThree(record));
  if (!has_verdict || record.verdict->causes.empty()) return;
  if (record.verdict->causes.front().IsOfKind(effect) && HasPlaces(effect)) score->place.Add(first);
  if (!first) return;
  score->another.Add(NamesAbsentOne(record));
  const Residuals& rms_m = record.verdict->residuals_m;
  const double noise_m2 = rms_m.noise * rms_m.noise;
  const double before_m2 = rms_m.before * rms_m.before - noise_m2;
  const double after_m2 = rms_m.heldout_after * rms_m.heldout_after - noise_m2;
  if (before_m2 > 0.0) score->heldout_gains.push_back(1.0 - after_m2 / before_m2);
}

void ScoreTwoCauses(const CaseRecord& record, Score* score) {
  int named = 0;
  if (record.verdict) {
    for (const ActiveEffect& effect : record.truth) {
      named += IsNamed(effect, record.verdict->causes) ? 1 : 0;
    }
  }
  score->both.Add(named == 2);
  score->one.Add(named >= 1);
  score->third.Add(record.verdict && NamesAbsentOne(record));
}

void ScoreParameters(const CaseRecord& record, Score* score) {
  for (const Suspect& suspect : record.verdict->causes) {
    for (const ActiveEffect& effect : record.truth) {
      if (suspect.id != effect.id || !suspect.Names(effect)) continue;
      const ParameterErrors errors = CompareParameters(effect, suspect.parameters);
      score->covered.hits += errors.covered.hits;
      score->covered.count += errors.covered.count;
      score->told.hits += errors.told.hits;
      score->told.count += errors.told.count;
      const auto append = [](const std::vector<double>& from, std::vector<double>* to) {
        to->insert(to->end(), from.begin(), from.end());
      };
      append(errors.of_value, &score->parameter_errors);
      append(errors.of_fault, &score->fault_errors);
      append(errors.of_place_m, &score->place_errors_m);
    }
  }
}

void ScoreSoundData(const CaseRecord& record, const Limits& limits, Score* score) {
  const bool has_verdict = record.verdict.has_value();
  score->wrongly_unfit.Add(!has_verdict || record.verdict->verdict == "data_unfit");
  if (record.kind == CaseKind::kOutside) {
    if (IsLarge(record, limits)) score->flagged.Add(has_verdict && record.verdict->IsFlagged());
  } else {
    score->false_flags.Add(has_verdict && record.verdict->IsFlagged());
  }
  if (record.kind == CaseKind::kHealthy) {
    score->false_accusations.Add(!has_verdict || record.verdict->Accuses());
  }
  if (record.kind == CaseKind::kOneCause && IsLarge(record, limits)) ScoreOneCause(record, score);
  if (record.kind == CaseKind::kTwoCauses && IsLarge(record, limits)) ScoreTwoCauses(record, score);
  if (!has_verdict) return;
  ScoreParameters(record, score);
  if (record.verdict->causes.empty()) return;
  const Suspect& first = record.verdict->causes.front();
  score->forecasts.push_back({first.probability, IsThere(first, record.truth)});
}

}  // namespace

Score Judge(const std::vector<CaseRecord>& records, const Limits& limits) {
  Score score;
  for (const CaseRecord& record : records) {
    ++score.cases;
    if (!record.not_made.empty()) {
      ++score.not_made;
      continue;
    }
    score.without_verdict.Add(!record.verdict);
    if (record.kind == CaseKind::kCorrupted) {
      score.unfit.Add(record.verdict && record.verdict->verdict == "data_unfit" &&
                      record.verdict->causes.empty());
    } else {
      ScoreSoundData(record, limits, &score);
    }
  }
  return score;
}

std::string Outcome(const CaseRecord& record, const Limits& limits) {
  if (!record.not_made.empty()) return "not made";
  if (!record.verdict) return "no verdict";
  const Verdict& verdict = *record.verdict;
  if (record.kind == CaseKind::kCorrupted) {
    return verdict.verdict == "data_unfit" ? "refused" : "TAKEN FOR SOUND";
  }
  if (verdict.verdict == "data_unfit") return "REFUSED";
  if (record.kind == CaseKind::kHealthy) return verdict.Accuses() ? "ACCUSED" : "acquitted";
  const std::string small = IsLarge(record, limits) ? "" : " (small)";
  if (record.kind == CaseKind::kOutside) {
    return (verdict.IsFlagged() ? "flagged" : "NOT FLAGGED") + small;
  }
  const auto named =
      std::count_if(record.truth.begin(), record.truth.end(),
                    [&](const ActiveEffect& effect) { return IsNamed(effect, verdict.causes); });
  const std::string absent = NamesAbsentOne(record) ? " AND ANOTHER" : "";
  if (record.kind == CaseKind::kTwoCauses) {
    return "named " + std::to_string(named) + " of 2" + absent + small;
  }
  if (IsFirst(record)) return "named" + absent + small;
  return (IsAmongThree(record) ? "AMONG THREE" : "MISSED") + small;
}

}  // namespace palpate::blind

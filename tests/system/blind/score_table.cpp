// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/score_table.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>

#include <cmath>

#include "libs/core/statistics.hpp"

namespace palpate::blind {

namespace {

constexpr int kNameWidth = 44;

/// E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209.
std::string Interval(const Share& share) {
  constexpr double kZ = kSigmas95;
  const double n = share.count;
  const double p = share.value();
  const double middle = (p + kZ * kZ / (2.0 * n)) / (1.0 + kZ * kZ / n);
  const double half =
      kZ / (1.0 + kZ * kZ / n) * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n));
  return fmt::format("{:.0f} to {:.0f}", 100.0 * std::max(0.0, middle - half),
                     100.0 * std::min(1.0, middle + half));
}

void Row(std::ostream& out, const char* what, const Share& share, const std::string& wanted) {
  if (share.count == 0) {
    fmt::print(out, "{:<{}}{:>9}\n", what, kNameWidth, "-");
    return;
  }
  fmt::print(out, "{:<{}}{:>5}/{:<5}{:>7.1f} %{:>13} %   {}\n", what, kNameWidth, share.hits,
             share.count, 100.0 * share.value(), Interval(share), wanted);
}

void Number(std::ostream& out, const char* what, double value, std::size_t count,
            const std::string& wanted) {
  if (count == 0) {
    fmt::print(out, "{:<{}}{:>9}\n", what, kNameWidth, "-");
    return;
  }
  fmt::print(out, "{:<{}}{:>10.3g}   of {:<12} {}\n", what, kNameWidth, value, count, wanted);
}

std::string AtLeast(double share) { return fmt::format(">= {:.3g} %", 100.0 * share); }
std::string AtMost(double share) { return fmt::format("<= {:.3g} %", 100.0 * share); }

std::string NameOf(const Suspect& suspect) {
  std::string text = suspect.id + " [";
  for (const std::string& where : suspect.where) {
    text += (text.back() == '[' ? "" : ", ") + where;
  }
  return text + "]";
}

std::string Said(const CaseRecord& record) {
  if (!record.not_made.empty()) return record.not_made;
  if (!record.verdict) return record.no_verdict;
  std::string text = record.verdict->verdict;
  for (const Suspect& cause : record.verdict->causes) {
    text += fmt::format(", {} p {:.2f}", NameOf(cause), cause.probability);
    for (const auto& [name, estimate] : cause.parameters) {
      text += fmt::format(" {} {:.3g} ({:.3g} to {:.3g})", name, estimate.value, estimate.ci95_low,
                          estimate.ci95_high);
    }
  }
  return text;
}

void PrintCauses(std::ostream& out, const Score& score) {
  for (const auto& [cause, share] : score.top1_of) {
    fmt::print(out, "  {:<{}}{:>5}/{}\n", cause, kNameWidth - 2, share.hits, share.count);
  }
}

}  // namespace

void PrintCase(std::ostream& out, const CaseRecord& record) {
  fmt::print(out, "seed {} {}", record.seed, ToString(record.kind));
  if (record.kind == CaseKind::kCorrupted) fmt::print(out, ", {}", ToString(record.corruption));
  for (std::size_t i = 0; i < record.truth.size(); ++i) {
    fmt::print(out, ", {}", Describe(record.truth[i]));
    if (i < record.sizes_m.size()) fmt::print(out, " ({:.2f} mm)", 1e3 * record.sizes_m[i]);
  }
  fmt::print(out, " | {} | {} | {:.0f} s\n", Outcome(record), Said(record), record.diagnosis_s);
  out.flush();
}

void PrintScore(std::ostream& out, const Score& score, const Acceptance& acceptance) {
  const Acceptance& a = acceptance;
  fmt::print(out, "\n{:<{}}{:>11}{:>9}{:>15}   wanted\n", "blind tests of diagnosis", kNameWidth,
             "", "", "95 %");
  Row(out, "one cause: named first", score.top1, AtLeast(a.top1_at_least));
  PrintCauses(out, score);
  Row(out, "  among the first three", score.top3, AtLeast(a.top3_at_least));
  Row(out, "  of the right kind: the right place", score.place, "");
  Row(out, "  named, and another that is not there", score.another, "");
  Row(out, "healthy: accused", score.false_accusations, AtMost(a.false_accusations_at_most));
  Row(out, "two causes: both named", score.both, AtLeast(a.both_at_least));
  Row(out, "  one named at least", score.one, AtLeast(a.one_at_least));
  Row(out, "  a third that is not there", score.third, AtMost(a.third_at_most));
  Row(out, "outside of the catalogue: flagged", score.flagged, AtLeast(a.flagged_at_least));
  Row(out, "inside: flagged", score.false_flags, AtMost(a.false_flags_at_most));
  Row(out, "corrupted data: refused", score.unfit, AtLeast(a.unfit_at_least));
  Row(out, "sound data: refused", score.wrongly_unfit, AtMost(a.wrongly_unfit_at_most));
  Row(out, "parameters inside their 95 % intervals", score.covered,
      fmt::format("{:.3g} to {:.3g} %", 100.0 * a.covered_at_least, 100.0 * a.covered_at_most));
  Row(out, "  told at all", score.told, "");
  Number(out, "  error over value, median", Median(score.parameter_errors),
         score.parameter_errors.size(), fmt::format("<= {:.3g}", a.median_parameter_error_at_most));
  Number(out, "  error over fault, median", Median(score.fault_errors), score.fault_errors.size(),
         "");
  Number(out, "  place of a load, median error, mm", 1e3 * Median(score.place_errors_m),
         score.place_errors_m.size(), "");
  Number(out, "held-out gain, median", Median(score.heldout_gains), score.heldout_gains.size(),
         fmt::format(">= {:.3g}", a.median_heldout_gain_at_least));
  Number(out, "calibration error of probabilities", CalibrationError(score.forecasts),
         score.forecasts.size(), fmt::format("<= {:.3g}", a.calibration_error_at_most));
  Number(out, "  by chance, were they right", CalibrationErrorByChance(score.forecasts),
         score.forecasts.size(), "");
  Row(out, "without a verdict", score.without_verdict, AtMost(a.without_verdict_at_most));
  Row(out, "not made", {score.not_made, score.cases}, AtMost(a.not_made_at_most));
}

}  // namespace palpate::blind

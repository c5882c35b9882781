// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/report_tables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "components/diagnosis/report/html_table.hpp"
#include "components/diagnosis/vocabulary/number_text.hpp"
#include "components/diagnosis/vocabulary/verdict_words.hpp"
#include "libs/plot/axis_ticks.hpp"

namespace palpate::diagnosis {

namespace {

constexpr std::size_t kMostRivals = 20;
constexpr const char* kDash = "\u2013";

std::string DecimalText(double value, int decimals) {
  return std::isfinite(value) ? plot::FixedText(value, decimals) : kDash;
}

std::string MillimetreCell(double value_m) { return DecimalText(1e3 * value_m, 2); }

std::string JoinedOrDash(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return text.empty() ? kDash : text;
}

/// A cause's parameters, one row each; what belongs to the cause stands in the first.
void AddRows(const NamedCause& cause, const DiagnosisResult& result, HtmlTable* table) {
  const std::string checked = cause.cross_validated ? "yes" : "no";
  std::vector<std::string> of_cause = {WordsFor(cause.name, result),
                                       ProbabilityText(cause.probability),
                                       DecimalText(cause.ln_bayes_factor, 1),
                                       PercentText(cause.explained_share),
                                       checked,
                                       JoinedOrDash(cause.seen_in)};
  const std::size_t rows = std::max<std::size_t>(1, cause.parameters.size());
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<std::string> row = {of_cause[0], kDash, kDash, kDash};
    if (i < cause.parameters.size()) {
      const ParameterText text = DescribeParameter(cause.parameters[i]);
      row = {of_cause[0], text.name, text.value + (text.unit.empty() ? "" : " " + text.unit),
             text.interval};
    }
    row.insert(row.end(), of_cause.begin() + 1, of_cause.end());
    table->rows.push_back(row);
    of_cause.assign(of_cause.size(), "");
  }
}

}  // namespace

std::string CauseTable(const DiagnosisResult& result) {
  if (result.causes.empty()) return "";
  HtmlTable table;
  table.head = {"cause", "parameter", "value",           "95 % interval", "p",
                "ln BF", "explains",  "cross-validated", "seen in"};
  table.numeric = {false, false, true, true, true, true, true, false, false};
  for (const NamedCause& cause : result.causes) AddRows(cause, result, &table);
  return FormatTable(table) +
         Element("p",
                 "ln BF: logarithm of the Bayes factor against the same model without the cause. "
                 "Cross-validated: the cause lowers the error in left-out recordings.");
}

std::string RivalTable(const DiagnosisResult& result) {
  if (result.rivals.empty()) return "";
  HtmlTable table;
  table.head = {"cause", "p", "ln BF", "correlation", "why it was not named"};
  table.numeric = {false, true, true, true, false};
  const std::size_t shown = std::min(result.rivals.size(), kMostRivals);
  for (std::size_t i = 0; i < shown; ++i) {
    const Rival& rival = result.rivals[i];
    table.rows.push_back({WordsFor(rival.name, result), ProbabilityText(rival.probability),
                          DecimalText(rival.ln_bayes_factor, 1),
                          DecimalText(rival.canonical_correlation, 2), rival.why_not});
  }
  std::string note =
      "ln BF: against the null model. Correlation: canonical correlation of its effect with that "
      "of "
      "the first named cause, from 0 to 1.";
  if (shown < result.rivals.size()) {
    note += " " + std::to_string(result.rivals.size() - shown) +
            " less probable ones are left out; palpate diagnose --explain ID describes each.";
  }
  return FormatTable(table) + Element("p", note);
}

std::string ExperimentTable(const DiagnosisResult& result) {
  if (result.experiments.empty()) {
    if (result.verdict == Verdict::kDataUnfit) return "";
    return Element("p", "No experiment was ranked.");
  }
  HtmlTable table;
  table.head = {"", "experiment", "by hand", "separates", "expected ln BF"};
  table.numeric = {true, false, false, false, true};
  constexpr int kMostShown = 10;
  int rank = 0;
  for (const ExperimentProposal& one : result.experiments) {
    if (rank == kMostShown) break;
    table.rows.push_back({std::to_string(++rank), one.title,
                          one.by_hand.empty() ? "nothing" : one.by_hand,
                          WordsFor(one.first, result) + " / " + WordsFor(one.second, result),
                          DecimalText(one.expected_ln_bayes_factor, 1)});
  }
  return FormatTable(table) + Element("p",
                                      "The best is first. Expected ln BF of the pair of causes "
                                      "that the experiment separates least well; above " +
                                          NumberText(kClearAnswer_lnBF, 2) + " is a clear answer.");
}

std::string RecordingTable(const DiagnosisResult& result) {
  if (result.recordings.empty()) return "";
  HtmlTable table;
  table.head = {"recording",
                "kind",
                "samples",
                "before (mm)",
                "null model (mm)",
                "after (mm)",
                "left out, null model (mm)",
                "left out, after (mm)",
                "noise (mm)"};
  table.numeric = {false, false, true, true, true, true, true, true, true};
  for (const RecordingError& one : result.recordings) {
    table.rows.push_back({one.name, one.kind, std::to_string(one.samples),
                          MillimetreCell(one.before_m), MillimetreCell(one.null_model_m),
                          MillimetreCell(one.after_m), MillimetreCell(one.heldout_before_m),
                          MillimetreCell(one.heldout_after_m), MillimetreCell(one.noise_m)});
  }
  const ErrorSummary& error = result.model_error;
  table.rows.push_back({"all", "", "", MillimetreCell(error.before_m),
                        MillimetreCell(error.null_model_m), MillimetreCell(error.after_m),
                        MillimetreCell(error.heldout_before_m),
                        MillimetreCell(error.heldout_after_m), MillimetreCell(error.noise_m)});
  return FormatTable(table);
}

std::string FindableTable(const DiagnosisResult& result) {
  if (result.findable.empty()) return "";
  HtmlTable table;
  table.head = {"fault", "parameter", "smallest size that would be named"};
  table.numeric = {false, false, true};
  for (const FindableSize& one : result.findable) {
    const ParameterText text = DescribeParameter({one.parameter, one.value, one.value, one.value});
    const bool known = std::isfinite(one.value);
    table.rows.push_back({one.words, text.name,
                          known ? text.value + (text.unit.empty() ? "" : " " + text.unit)
                                : "none that is plausible"});
  }
  return Element("p", HealthyText(result)) + FormatTable(table) +
         Element("p",
                 "Smaller ones cannot be seen in these data: ln BF 10 and three manufacturing "
                 "tolerances, by the linear model of the null model.");
}

std::string IdentityList(const DiagnosisResult& result) {
  if (result.identities.empty()) return "";
  std::string html = "<ul>\n";
  for (const std::string& identity : result.identities) html += Element("li", identity);
  return html + "</ul>\n";
}

std::string HowToRepeat(const DiagnosisResult& result) {
  const std::vector<std::pair<std::string, std::string>> facts = {
      {"robot", result.robot},
      {"data", result.data},
      {"data hash", result.data_hash},
      {"version", "palpate " + result.version},
      {"took", NumberText(result.duration_s, 3) + " s"}};
  std::string html = result.command.empty() ? "" : Element("pre", result.command);
  html += "<dl class=\"facts\">\n";
  for (const auto& [name, text] : facts) html += Element("dt", name) + Element("dd", text);
  return html + "</dl>\n";
}

}  // namespace palpate::diagnosis

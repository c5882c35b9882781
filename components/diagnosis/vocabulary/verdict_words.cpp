// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/vocabulary/verdict_words.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "components/diagnosis/vocabulary/number_text.hpp"

namespace palpate::diagnosis {

namespace {

/// More parameters than these stand in the table only.
constexpr std::size_t kMostParameters = 2;
constexpr std::size_t kMostRuledOut = 4;
/// Who is less probable than that counts as ruled out.
constexpr double kRuledOut = 0.05;

std::string Capitalised(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

/// A sentence ends with one full stop.
std::string Sentence(std::string text) {
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
  return text.empty() ? text : text + ".";
}

std::string JoinedOrNone(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return text.empty() ? "none" : text;
}

std::string WordsOf(const NamedCause& cause, const DiagnosisResult& result) {
  return WordsFor(cause.name, result);
}

/// "friction of cable north, mu = 0.21 ± 0.02 (95 %), p = 0.97"
std::string CauseText(const NamedCause& cause, const DiagnosisResult& result) {
  std::string text = WordsOf(cause, result);
  const std::size_t shown = std::min(cause.parameters.size(), kMostParameters);
  for (std::size_t i = 0; i < shown; ++i) {
    text += ", " + DescribeParameter(cause.parameters[i]).whole;
  }
  const bool fitted = std::any_of(
      cause.parameters.begin(), cause.parameters.end(),
      [](const FittedParameter& parameter) { return parameter.ci95_high > parameter.ci95_low; });
  if (fitted) text += " (95 %)";
  return text + ", p = " + ProbabilityText(cause.probability);
}

std::string CausesText(const DiagnosisResult& result) {
  std::vector<std::string> texts;
  for (const NamedCause& cause : result.causes) texts.push_back(CauseText(cause, result));
  std::string text;
  for (const std::string& one : texts) text += (text.empty() ? "" : "; and ") + one;
  return Capitalised(text);
}

std::vector<std::string> Names(const std::vector<CauseName>& names, const DiagnosisResult& result) {
  std::vector<std::string> words;
  for (const CauseName& name : names) words.push_back(WordsFor(name, result));
  return words;
}

std::vector<std::string> RuledOut(const DiagnosisResult& result) {
  std::vector<std::string> words;
  const auto& alike = result.indistinguishable_from;
  for (const Rival& rival : result.rivals) {
    const bool is_alike = std::find(alike.begin(), alike.end(), rival.name) != alike.end();
    if (is_alike || !(rival.probability < kRuledOut) || words.size() == kMostRuledOut) continue;
    words.push_back(WordsFor(rival.name, result));
  }
  return words;
}

std::vector<std::string> SeenIn(const DiagnosisResult& result) {
  std::vector<std::string> names;
  for (const NamedCause& cause : result.causes) {
    for (const std::string& name : cause.seen_in) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

std::string Explained(const DiagnosisResult& result) {
  const std::string of = " of the misfit beyond noise and tolerances";
  if (result.causes.size() == 1) return PercentText(result.causes[0].explained_share) + of;
  std::vector<std::string> texts;
  for (const NamedCause& cause : result.causes) {
    texts.push_back(WordsOf(cause, result) + " " + PercentText(cause.explained_share));
  }
  return JoinedOrNone(texts) + of;
}

/// Three digits: what a cause gains may be a small part of what is left.
std::string FineText(double value_m) { return NumberText(1e3 * value_m, 3); }

/// "4.10 → 0.80 mm (noise 0.70 mm)"
std::string Change(double before_m, double after_m, double noise_m) {
  return FineText(before_m) + " \u2192 " + FineText(after_m) + " mm (noise " + FineText(noise_m) +
         " mm)";
}

/// What the causes change: against the robot without them, its tolerances fitted as theirs are.
std::string Gain(const ErrorSummary& error) {
  if (!std::isfinite(error.heldout_before_m) || !std::isfinite(error.heldout_after_m)) {
    return "not known; where it was fitted " +
           Change(error.null_model_m, error.after_m, error.noise_m);
  }
  std::string text = Change(error.heldout_before_m, error.heldout_after_m, error.noise_m);
  if (!std::isfinite(error.heldout_gain_low_m)) return text;
  return text + ", a gain of " + FineText(error.heldout_gain_low_m) + " to " +
         FineText(error.heldout_gain_high_m) + " mm (95 %)";
}

/// What is wrong where no cause was named.
std::string Error(const ErrorSummary& error) {
  std::string text = LengthText(error.before_m) + " as the robot file has it";
  if (std::isfinite(error.heldout_before_m)) {
    text += ", " + LengthText(error.heldout_before_m) + " in left-out recordings";
  }
  return text + " (noise " + LengthText(error.noise_m) + ")";
}

/// "E of `middle`: 250 → 179 ± 10 kPa"
std::string ChangeText(const ChangedValue& value) {
  const ParameterText after =
      DescribeParameter({value.words, value.after, value.ci95_low, value.ci95_high});
  const std::string text = after.whole.substr(value.words.size() + std::string(" = ").size());
  return value.words + ": " + NumberText(value.before, 3) + " \u2192 " + text +
         (value.unit.empty() ? "" : " " + value.unit);
}

/// "0.120 → 0.031 N (RMS, 140 forces in 2 recordings)"
std::string ForceErrorText(const ForceError& error) {
  if (!error.why_not.empty()) return "not known: " + error.why_not;
  if (error.forces == 0) return "";
  return NumberText(error.before_N, 3) + " \u2192 " + NumberText(error.after_N, 3) + " N (RMS, " +
         std::to_string(error.forces) + " forces in " + std::to_string(error.recordings) +
         (error.recordings == 1 ? " recording)" : " recordings)");
}

void AddCauses(const DiagnosisResult& result, std::vector<VerdictDetail>* details) {
  details->push_back({"Explains", Explained(result)});
  details->push_back({"Left-out error, without and with", Gain(result.model_error)});
  const std::string force_error = ForceErrorText(result.force_error);
  if (!force_error.empty())
    details->push_back({"Force error at known loads, without and with", force_error});
  std::string changes;
  for (const std::string& one : ChangeTexts(result)) changes += (changes.empty() ? "" : "; ") + one;
  if (!changes.empty()) details->push_back({"In the files", changes});
  details->push_back({"Seen in", JoinedOrNone(SeenIn(result))});
  std::vector<std::string> once;
  for (const NamedCause& cause : result.causes) {
    if (!cause.cross_validated) once.push_back(WordsOf(cause, result));
  }
  if (!once.empty()) details->push_back({"Not cross-validated", JoinedOrNone(once)});
  details->push_back({"Ruled out", JoinedOrNone(RuledOut(result))});
  details->push_back(
      {"Not identifiable from", JoinedOrNone(Names(result.indistinguishable_from, result))});
}

/// What the data leave open, and the recording that would settle it, or that none would.
void AddNextExperiment(const DiagnosisResult& result, std::vector<VerdictDetail>* details) {
  const ExperimentProposal& next = result.experiments.front();
  const std::string pair = WordsFor(next.first, result) + " or " + WordsFor(next.second, result);
  const std::string recording =
      next.title + (next.by_hand.empty() ? "" : "; by hand: " + next.by_hand);
  details->push_back({"Not yet certain", "whether it is " + pair});
  if (next.expected_ln_bayes_factor >= kClearAnswer_lnBF) {
    details->push_back({"Do next", recording});
    return;
  }
  details->push_back({"No proposed recording settles it",
                      "their effects are alike in all of them. Best: " + recording +
                          ", expected ln BF " + NumberText(next.expected_ln_bayes_factor, 2) +
                          ", where " + NumberText(kClearAnswer_lnBF, 2) + " is a clear answer"});
}

}  // namespace

std::string Enumeration(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? " and " : ", ";
    text += items[i];
  }
  return text;
}

std::vector<std::string> ChangeTexts(const DiagnosisResult& result) {
  std::vector<std::string> texts;
  for (const NamedCause& cause : result.causes) {
    for (const ChangedValue& value : cause.in_file) texts.push_back(ChangeText(value));
  }
  return texts;
}

std::string HealthyText(const DiagnosisResult& result) {
  const SimulatedHealthy& healthy = result.simulated_healthy;
  if (healthy.drawn == 0) return {};
  // The upper end of 95 % where none was accused (the rule of three).
  constexpr double kNoneOf = 3.0;
  const double share = healthy.accused > 0 ? static_cast<double>(healthy.accused) / healthy.drawn
                                           : kNoneOf / healthy.drawn;
  return "A healthy robot would be accused in " +
         std::string(healthy.accused > 0 ? "" : "less than ") + NumberText(100.0 * share, 2) +
         " % of cases (" + std::to_string(healthy.accused) + " of " +
         std::to_string(healthy.drawn) + " simulated), as a cause needs ln BF " +
         NumberText(result.clear_evidence, 2);
}

std::string WordsFor(const CauseName& name, const DiagnosisResult& result) {
  for (const NamedCause& cause : result.causes) {
    if (cause.name == name && !cause.words.empty()) return cause.words;
  }
  for (const Rival& rival : result.rivals) {
    if (rival.name == name && !rival.words.empty()) return rival.words;
  }
  if (name.id == "no_fault") return "the nominal robot";
  return name.where.empty() ? name.id : name.id + " (" + JoinedOrNone(name.where) + ")";
}

std::string VerdictLabel(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoFault: return "No fault";
    case Verdict::kCause: return "Cause found";
    case Verdict::kIndistinguishable: return "Causes not identifiable";
    case Verdict::kPartlyExplained: return "Partly explained";
    case Verdict::kUnexplained: return "Unexplained";
    case Verdict::kDataUnfit: break;
  }
  return "Data unfit";
}

std::string VerdictHeadline(const DiagnosisResult& result) {
  const std::string causes = CausesText(result);
  switch (result.verdict) {
    case Verdict::kNoFault:
      return "The residuals are within noise and manufacturing tolerances, p = " +
             ProbabilityText(result.no_fault_probability) + ".";
    case Verdict::kCause: return Sentence(causes);
    case Verdict::kIndistinguishable: {
      std::vector<std::string> alike;
      for (const NamedCause& cause : result.causes) alike.push_back(WordsOf(cause, result));
      for (const std::string& name : Names(result.indistinguishable_from, result)) {
        if (std::find(alike.begin(), alike.end(), name) == alike.end()) alike.push_back(name);
      }
      return "There is a fault, and " + std::to_string(alike.size()) +
             " causes are not identifiable: " + Sentence(Enumeration(alike));
    }
    case Verdict::kPartlyExplained:
      return Sentence(causes) + " Residuals beyond the noise remain unexplained.";
    case Verdict::kUnexplained:
      return "The model error is " + LengthText(result.model_error.before_m) + " (noise " +
             LengthText(result.model_error.noise_m) + "); no fault of the catalogue explains it.";
    case Verdict::kDataUnfit: break;
  }
  return "The data are unfit for a diagnosis: " +
         Sentence(result.reason.empty() ? "no reason was given" : result.reason);
}

std::vector<VerdictDetail> VerdictDetails(const DiagnosisResult& result) {
  std::vector<VerdictDetail> details;
  const bool reason_said = result.verdict == Verdict::kDataUnfit || result.reason.empty();
  if (!reason_said) details.push_back({"Why", Sentence(Capitalised(result.reason))});
  if (!result.causes.empty()) {
    AddCauses(result, &details);
  } else if (std::isfinite(result.model_error.before_m)) {
    details.push_back({"Error", Error(result.model_error)});
  }
  if (const std::string healthy = HealthyText(result); !healthy.empty())
    details.push_back({"False accusations", Sentence(healthy)});
  if (!result.experiments.empty()) AddNextExperiment(result, &details);
  return details;
}

std::string VerdictParagraph(const DiagnosisResult& result) {
  std::string text = VerdictHeadline(result);
  for (const VerdictDetail& detail : VerdictDetails(result)) {
    text += " " + detail.label + ": " + Sentence(detail.text);
  }
  return text;
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/scenario/effect_places.hpp"
#include "tests/system/blind/cause_menu.hpp"

namespace palpate::blind {

namespace {

using Json = nlohmann::json;

const std::set<std::string> kVerdicts = {"no_fault",         "cause",       "indistinguishable",
                                         "partly_explained", "unexplained", "data_unfit"};

Estimate EstimateFrom(const Json& json) {
  const Estimate estimate{.value = json.at("value"),
                          .ci95_low = json.at("ci95").at(0),
                          .ci95_high = json.at("ci95").at(1)};
  if (!(estimate.ci95_low <= estimate.ci95_high))
    throw RunError("an interval ends before it begins");
  return estimate;
}

Suspect SuspectFrom(const Json& json, bool with_probability) {
  Suspect suspect;
  suspect.id = json.at("id");
  const Json& where = json.at("where");
  if (where.is_string()) {
    suspect.where = {where.get<std::string>()};
  } else {
    suspect.where = where.get<std::vector<std::string>>();
  }
  if (suspect.id.empty() || suspect.where.empty())
    throw RunError("a cause has no name or no place");
  if (with_probability) {
    suspect.probability = json.at("probability");
    if (!(suspect.probability >= 0.0 && suspect.probability <= 1.0)) {
      throw RunError("the probability of " + suspect.id + " is none");
    }
  }
  const Json parameters = json.value("parameters", Json::object());
  for (const auto& [name, value] : parameters.items()) {
    suspect.parameters[name] = EstimateFrom(value);
  }
  return suspect;
}

std::vector<Suspect> SuspectsFrom(const Json& json, const std::string& key, bool with_probability) {
  std::vector<Suspect> suspects;
  for (const Json& suspect : json.at(key)) {
    suspects.push_back(SuspectFrom(suspect, with_probability));
  }
  return suspects;
}

double NumberOr(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  if (found == json.end() || found->is_null()) return std::numeric_limits<double>::quiet_NaN();
  return *found;
}

Verdict VerdictFrom(const Json& json) {
  Verdict verdict;
  verdict.verdict = json.at("verdict");
  if (!kVerdicts.contains(verdict.verdict)) throw RunError("verdict '" + verdict.verdict + "'");
  verdict.causes = SuspectsFrom(json, "causes", true);
  if (verdict.verdict == "cause" && verdict.causes.empty()) throw RunError("no cause is named");
  verdict.alternatives = SuspectsFrom(json, "alternatives", true);
  verdict.indistinguishable_from = SuspectsFrom(json, "indistinguishable_from", false);
  const Json residuals = json.value("residual_m_rms", Json::object());
  verdict.residuals_m = {.before = NumberOr(residuals, "before"),
                         .heldout_after = NumberOr(residuals, "heldout_after"),
                         .noise = NumberOr(residuals, "noise")};
  return verdict;
}

bool SameName(const Suspect& a, const Suspect& b) { return a.id == b.id && a.where == b.where; }

}  // namespace

bool Suspect::IsOfKind(const scenario::ActiveEffect& effect) const {
  const std::vector<std::string> twins = TwinsOf(effect);
  return id == effect.id || std::find(twins.begin(), twins.end(), id) != twins.end();
}

bool Suspect::Names(const scenario::ActiveEffect& effect) const {
  const auto* kind = scenario::FindEffect(id);
  return kind != nullptr && IsOfKind(effect) && scenario::SamePlace(*kind, where, effect.where);
}

bool Verdict::Accuses() const { return !causes.empty() || verdict == "indistinguishable"; }

std::vector<const Suspect*> Verdict::First(std::size_t count) const {
  std::vector<const Suspect*> first;
  for (const auto* list : {&causes, &indistinguishable_from, &alternatives}) {
    for (const Suspect& suspect : *list) {
      const bool is_there = std::any_of(first.begin(), first.end(), [&](const Suspect* other) {
        return SameName(*other, suspect);
      });
      if (!is_there && first.size() < count) first.push_back(&suspect);
    }
  }
  return first;
}

Verdict ReadVerdict(const std::filesystem::path& file) {
  try {
    return VerdictFrom(Json::parse(ReadFile(file)));
  } catch (const Json::exception& error) {
    throw RunError(file.string() + ": " + error.what());
  } catch (const RunError& error) {
    throw RunError(file.string() + ": " + error.what());
  }
}

}  // namespace palpate::blind

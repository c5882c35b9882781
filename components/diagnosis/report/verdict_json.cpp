// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/verdict_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace palpate::diagnosis {

namespace {

using Json = nlohmann::ordered_json;

/// JSON knows no NaN and no infinity.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json Where(const CauseName& name) {
  return name.where.size() == 1 ? Json(name.where.front()) : Json(name.where);
}

Json ToJson(const CauseName& name) { return {{"id", name.id}, {"where", Where(name)}}; }

Json ToJson(const ChangedValue& value) {
  return {{"what", value.words},
          {"unit", value.unit},
          {"before", Number(value.before)},
          {"after", Number(value.after)},
          {"ci95", Json::array({Number(value.ci95_low), Number(value.ci95_high)})}};
}

Json ToJson(const NamedCause& cause) {
  Json parameters = Json::object();
  for (const FittedParameter& parameter : cause.parameters) {
    parameters[parameter.name] = {
        {"value", Number(parameter.value)},
        {"ci95", Json::array({Number(parameter.ci95_low), Number(parameter.ci95_high)})}};
  }
  Json json = ToJson(cause.name);
  json["parameters"] = parameters;
  json["probability"] = Number(cause.probability);
  json["words"] = cause.words;
  json["ln_bayes_factor"] = Number(cause.ln_bayes_factor);
  json["explained_share"] = Number(cause.explained_share);
  json["cross_validated"] = cause.cross_validated;
  json["seen_in"] = cause.seen_in;
  json["in_file"] = Json::array();
  for (const ChangedValue& value : cause.in_file) json["in_file"].push_back(ToJson(value));
  return json;
}

Json ToJson(const Rival& rival) {
  Json json = ToJson(rival.name);
  json["probability"] = Number(rival.probability);
  json["words"] = rival.words;
  json["ln_bayes_factor"] = Number(rival.ln_bayes_factor);
  json["likeness"] = Number(rival.canonical_correlation);
  json["why_not"] = rival.why_not;
  return json;
}

Json ToJson(const RecordingError& recording) {
  return {{"name", recording.name},
          {"kind", recording.kind},
          {"samples", recording.samples},
          {"residual_m_rms",
           {{"before", Number(recording.before_m)},
            {"healthy", Number(recording.null_model_m)},
            {"after", Number(recording.after_m)},
            {"heldout_before", Number(recording.heldout_before_m)},
            {"heldout_after", Number(recording.heldout_after_m)},
            {"noise", Number(recording.noise_m)}}}};
}

Json ToJson(const ErrorSummary& error) {
  return {{"before", Number(error.before_m)},
          {"healthy", Number(error.null_model_m)},
          {"after", Number(error.after_m)},
          {"heldout_before", Number(error.heldout_before_m)},
          {"heldout_after", Number(error.heldout_after_m)},
          {"heldout_gain_ci95",
           Json::array({Number(error.heldout_gain_low_m), Number(error.heldout_gain_high_m)})},
          {"noise", Number(error.noise_m)}};
}

Json ToJson(const ForceError& error) {
  if (error.forces == 0) return nullptr;
  return {{"before", Number(error.before_N)},
          {"after", Number(error.after_N)},
          {"forces", error.forces},
          {"recordings", error.recordings}};
}

Json Vector(const Eigen::Vector3d& v) {
  return Json::array({Number(v.x()), Number(v.y()), Number(v.z())});
}

Json ToJson(const ResidualForces& forces) {
  Json list = Json::array();
  for (Eigen::Index k = 0; k < forces.place_m.cols(); ++k) {
    list.push_back({{"at_m", Vector(forces.place_m.col(k))},
                    {"before_N", Vector(forces.before_N.col(k))},
                    {"after_N", Vector(forces.after_N.col(k))}});
  }
  return {{"recording", forces.recording}, {"forces", list}};
}

Json ToJson(const ResidualTest& left) {
  if (left.test.empty()) return nullptr;
  return {{"is_noise", left.is_noise},
          {"test", left.test},
          {"surprise", Number(left.surprise)},
          {"surprise_limit", Number(left.surprise_limit)},
          {"excess", Number(left.excess)}};
}

Json ToJson(const SimulatedHealthy& healthy) {
  return {{"drawn", healthy.drawn},
          {"accused", healthy.accused},
          {"ln_bayes_factor_98", Number(healthy.ln_bayes_factor_98)}};
}

Json ToJson(const FindableSize& one) {
  Json json = ToJson(one.name);
  json["parameter"] = one.parameter;
  json["value"] = Number(one.value);
  return json;
}

Json ToJson(const ExperimentProposal& one) {
  return {{"title", one.title},
          {"by_hand", one.by_hand},
          {"separates", Json::array({ToJson(one.first), ToJson(one.second)})},
          {"expected_ln_bayes_factor", Number(one.expected_ln_bayes_factor)}};
}

/// The best, and the others behind it.
Json NextExperiment(const std::vector<ExperimentProposal>& experiments) {
  if (experiments.empty()) return nullptr;
  Json next = ToJson(experiments.front());
  next["others"] = Json::array();
  for (std::size_t k = 1; k < experiments.size(); ++k) {
    next["others"].push_back(ToJson(experiments[k]));
  }
  return next;
}

template <typename T>
Json List(const std::vector<T>& items) {
  Json list = Json::array();
  for (const T& item : items) list.push_back(ToJson(item));
  return list;
}

}  // namespace

std::string FormatVerdict(const DiagnosisResult& result) {
  const Json json = {{"verdict", ToString(result.verdict)},
                     {"reason", result.reason},
                     {"search_complete", result.search_complete},
                     {"interrupted", result.interrupted},
                     {"causes", List(result.causes)},
                     {"alternatives", List(result.rivals)},
                     {"indistinguishable_from", List(result.indistinguishable_from)},
                     {"no_fault_probability", Number(result.no_fault_probability)},
                     {"other_probability", Number(result.other_probability)},
                     {"what_is_left", ToJson(result.residual_test)},
                     {"simulated_healthy", ToJson(result.simulated_healthy)},
                     {"clear_evidence", Number(result.clear_evidence)},
                     {"model_discrepancy",
                      {{"cables", Number(result.cable_discrepancy)},
                       {"stiffness", Number(result.stiffness_discrepancy)}}},
                     {"smallest_findable", List(result.findable)},
                     {"residual_m_rms", ToJson(result.model_error)},
                     {"force_error_N_rms", ToJson(result.force_error)},
                     {"next_experiment", NextExperiment(result.experiments)},
                     {"recordings", List(result.recordings)},
                     {"residual_forces", ToJson(result.residual_forces)},
                     {"robot", result.robot},
                     {"data", result.data},
                     {"data_hash", result.data_hash},
                     {"version", result.version},
                     {"command", result.command}};
  // Names come from files: bytes that are no UTF-8 must not stop the verdict.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate::diagnosis

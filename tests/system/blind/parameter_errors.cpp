// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/parameter_errors.hpp"

#include <cmath>
#include <set>

#include "libs/core/check.hpp"

namespace palpate::blind {

namespace {

/// Squares, summed over the components of one vector.
struct Squares {
  double error = 0.0;
  double truth = 0.0;
  double fault = 0.0;
  bool complete = true;
};

/// "force" for fx_N, ...; a scalar is a vector of its own.
std::string VectorOf(const std::string& parameter) {
  static const std::map<std::string, std::string> kVectors = {
      {"x_m", "place"},       {"y_m", "place"},  {"z_m", "place"},  {"fx_N", "force"},
      {"fy_N", "force"},      {"fz_N", "force"}, {"nx", "normal"},  {"ny", "normal"},
      {"nz", "normal"},       {"dy_m", "moved"}, {"dz_m", "moved"}, {"theta_x_deg", "tilt"},
      {"theta_y_deg", "tilt"}};
  const auto found = kVectors.find(parameter);
  return found == kVectors.end() ? parameter : found->second;
}

double NominalOf(const scenario::ActiveEffect& effect, const std::string& parameter) {
  const auto* kind = scenario::FindEffect(effect.id);
  PALPATE_CHECK(kind != nullptr, effect.id);
  for (const auto& known : kind->parameters) {
    if (known.name == parameter && std::isfinite(known.healthy)) return known.healthy;
  }
  return 0.0;
}

}  // namespace

double WhatIsToTell(const std::string& parameter, double drawn) {
  static const std::set<std::string> kSizes = {"tip_m", "d_m", "translation_m", "rotation_rad"};
  return kSizes.count(parameter) > 0 ? std::abs(drawn) : drawn;
}

ParameterErrors CompareParameters(const scenario::ActiveEffect& truth,
                                  const std::map<std::string, Estimate>& told) {
  ParameterErrors errors;
  std::map<std::string, Squares> vectors;
  for (const auto& [name, drawn] : truth.parameters) {
    const double value = WhatIsToTell(name, drawn);
    Squares& squares = vectors[VectorOf(name)];
    const auto found = told.find(name);
    errors.told.Add(found != told.end());
    if (found == told.end()) {
      squares.complete = false;
      continue;
    }
    const Estimate& estimate = found->second;
    errors.covered.Add(estimate.ci95_low <= value && value <= estimate.ci95_high);
    squares.error += std::pow(estimate.value - value, 2);
    squares.truth += std::pow(value, 2);
    squares.fault += std::pow(value - NominalOf(truth, name), 2);
  }
  for (const auto& [name, squares] : vectors) {
    if (!squares.complete) continue;
    if (name == "place") {
      errors.of_place_m.push_back(std::sqrt(squares.error));
      continue;
    }
    if (squares.truth > 0.0) errors.of_value.push_back(std::sqrt(squares.error / squares.truth));
    if (squares.fault > 0.0) errors.of_fault.push_back(std::sqrt(squares.error / squares.fault));
  }
  return errors;
}

}  // namespace palpate::blind

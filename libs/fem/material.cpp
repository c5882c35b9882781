// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/material.hpp"

#include <array>
#include <utility>

#include "libs/core/check.hpp"

namespace palpate::fem {

namespace {

constexpr std::array<std::pair<MaterialModel, std::string_view>, 6> kNames{{
    {MaterialModel::kLinear, "linear"},
    {MaterialModel::kCorotational, "corotational"},
    {MaterialModel::kStVenantKirchhoff, "st_venant_kirchhoff"},
    {MaterialModel::kNeoHookean, "neo_hookean"},
    {MaterialModel::kStableNeoHookean, "stable_neo_hookean"},
    {MaterialModel::kYeoh, "yeoh"},
}};

}  // namespace

std::string_view ToString(MaterialModel model) {
  for (const auto& [known_model, name] : kNames) {
    if (known_model == model) return name;
  }
  PALPATE_CHECK(false, static_cast<int>(model));
  return {};
}

std::string_view ToString(Volumetric volumetric) {
  return volumetric == Volumetric::kMeanDilatation ? "mean_dilatation" : "pointwise";
}

bool ParseMaterialModel(std::string_view name, MaterialModel* model) {
  for (const auto& [known_model, known_name] : kNames) {
    if (known_name == name) {
      *model = known_model;
      return true;
    }
  }
  return false;
}

std::vector<std::string> MaterialModelNames() {
  std::vector<std::string> names;
  for (const auto& [model, name] : kNames) names.emplace_back(name);
  return names;
}

bool IsYeohMonotone(double c20_over_c10, double c30_over_c10) {
  // 1 + 2 c20 s + 3 c30 s^2 > 0 for all s >= 0.
  if (c30_over_c10 < 0.0) return false;
  return c20_over_c10 >= 0.0 || c20_over_c10 * c20_over_c10 < 3.0 * c30_over_c10;
}

}  // namespace palpate::fem

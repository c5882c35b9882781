// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/material_effects.hpp"

#include <map>
#include <string>

#include "libs/core/error.hpp"

namespace palpate::virtual_robot {

namespace {

using scenario::ActiveEffect;

void ScaleBody(const ActiveEffect& effect, BenchBody* body) {
  const double factor = PositiveValue(effect, "factor");
  for (fem::Material& material : body->materials) material.youngs_modulus_Pa *= factor;
}

void ScaleRegion(const ActiveEffect& effect, BenchBody* body) {
  const int region = PlaceOf(effect, "region", body->region_names);
  body->materials[static_cast<size_t>(region) + 1].youngs_modulus_Pa *=
      PositiveValue(effect, "factor");
}

void SetPoissonsRatio(const ActiveEffect& effect, BenchBody* body) {
  for (fem::Material& material : body->materials) material.poissons_ratio = Value(effect, "nu");
}

/// Any material becomes Yeoh's of the same small-strain modulus; one that is keeps its C30.
void Stiffen(const ActiveEffect& effect, BenchBody* body) {
  for (fem::Material& material : body->materials) {
    if (material.model != fem::MaterialModel::kYeoh) material.c30_over_c10 = 0.0;
    material.model = fem::MaterialModel::kYeoh;
    material.c20_over_c10 = Value(effect, "C2_over_C1");
  }
}

void ScaleDensity(const ActiveEffect& effect, BenchBody* body) {
  body->density_kg_m3 *= PositiveValue(effect, "factor");
}

void AddCreep(const ActiveEffect& effect, BenchBody* body) {
  const double g = NonNegativeValue(effect, "g");
  const double tau_s = PositiveValue(effect, "tau_s");
  if (g > 0.0) body->prony.push_back({g, tau_s});
}

/// In the place of what the robot file has.
void SetSoftening(const ActiveEffect& effect, BenchBody* body) {
  const fem::MullinsLaw law{.r = PositiveValue(effect, "r"), .m_J_m3 = PositiveValue(effect, "m")};
  if (!(law.r > 1.0)) throw InputError("effect mullins: r must be greater than 1");
  body->softening = law;
}

const std::map<std::string, void (*)(const ActiveEffect&, BenchBody*)>& Handlers() {
  static const std::map<std::string, void (*)(const ActiveEffect&, BenchBody*)> handlers = {
      {"youngs_modulus", ScaleBody},
      {"regional_stiffness", ScaleRegion},
      {"poissons_ratio", SetPoissonsRatio},
      {"stiffening", Stiffen},
      {"density", ScaleDensity},
      {"viscoelastic_creep", AddCreep},
      {"mullins", SetSoftening}};
  return handlers;
}

}  // namespace

void ApplyMaterialEffects(const Effects& effects, BenchBody* body) {
  for (const ActiveEffect& effect : effects) {
    const auto handler = Handlers().find(effect.id);
    if (handler != Handlers().end()) handler->second(effect, body);
  }
}

}  // namespace palpate::virtual_robot

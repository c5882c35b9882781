// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <map>
#include <string>
#include <vector>

#include "libs/scenario/effect.hpp"
#include "tests/system/blind/share.hpp"
#include "tests/system/blind/verdict.hpp"

namespace palpate::blind {

/// How a verdict's parameters of a cause that is there compare with the truth.
struct ParameterErrors {
  Share covered;  ///< of those in the verdict: the truth is inside the 95 % interval
  Share told;     ///< in the verdict, of the true ones
  // Components of a vector (a force, a direction, ...) are one parameter here; those that are 0, or
  // that the verdict does not tell, are left out.
  std::vector<double> of_value;    ///< |error| / |truth|
  std::vector<double> of_fault;    ///< |error| / |truth - nominal|
  std::vector<double> of_place_m;  ///< where a load acts: |error|
};

/// What of a true parameter a verdict can tell: of what goes where the seed says its size.
double WhatIsToTell(const std::string& parameter, double drawn);

/// `told`: estimates by name, as in verdict.json. The truth's directions that the seed draws have
/// no parameter.
ParameterErrors CompareParameters(const scenario::ActiveEffect& truth,
                                  const std::map<std::string, Estimate>& told);

}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/silicones.hpp"

#include <fmt/core.h>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

const std::vector<Silicone>& Silicones() {
  // Data sheets of Smooth-On (100 % modulus 10, 12, 22, 49, 86 psi; specific gravity).
  constexpr double kPsi_Pa = 6894.757;
  static const std::vector<Silicone> silicones = {
      {"ecoflex_00_30", "Ecoflex 00-30", 10 * kPsi_Pa, 1070.0},
      {"ecoflex_00_50", "Ecoflex 00-50", 12 * kPsi_Pa, 1070.0},
      {"dragon_skin_10", "Dragon Skin 10", 22 * kPsi_Pa, 1070.0},
      {"dragon_skin_20", "Dragon Skin 20", 49 * kPsi_Pa, 1080.0},
      {"dragon_skin_30", "Dragon Skin 30", 86 * kPsi_Pa, 1080.0}};
  return silicones;
}

std::vector<std::string> SiliconeNames() {
  std::vector<std::string> names;
  for (const Silicone& silicone : Silicones()) names.push_back(silicone.name);
  return names;
}

const Silicone& FindSilicone(const std::string& name) {
  for (const Silicone& silicone : Silicones()) {
    if (silicone.name == name) return silicone;
  }
  throw InputError("there is no silicone '" + Excerpt(name) + "'" +
                   DidYouMean(name, SiliconeNames()) + "; there is " + Listed(SiliconeNames()));
}

std::string ModulusRangeText() {
  return fmt::format("{:.0f} to {:.0f} kPa", 1e-3 * Silicones().front().YoungsModulus_Pa(),
                     1e-3 * Silicones().back().YoungsModulus_Pa());
}

}  // namespace palpate::command

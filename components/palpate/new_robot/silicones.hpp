// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

namespace palpate::command {

/// A silicone rubber as its maker describes it.
struct Silicone {
  std::string name;       ///< "dragon_skin_10"
  std::string title;      ///< as it is sold
  double modulus_100_Pa;  ///< nominal stress at 100 % strain, of the data sheet
  double density_kg_m3;

  /// Young's modulus at small strain of the neo-Hookean material of that stress: the nominal stress
  /// at a stretch of 2 is mu (2 - 1 / 4), and E = 3 mu.
  double YoungsModulus_Pa() const { return 3.0 / 1.75 * modulus_100_Pa; }
};

/// What soft robots are often made of, the softest first.
const std::vector<Silicone>& Silicones();
std::vector<std::string> SiliconeNames();
/// Throws InputError where there is none of that name, with "did you mean".
const Silicone& FindSilicone(const std::string& name);

/// The range of the moduli above, as "0.1 to 1 MPa".
std::string ModulusRangeText();

}  // namespace palpate::command

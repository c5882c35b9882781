// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::diagnosis {

/// A parameter of a cause with its 95 % interval; name and unit as in DIAGNOSIS, "Conventions".
struct FittedParameter {
  std::string name;
  double value = 0.0;
  double ci95_low = 0.0;
  double ci95_high = 0.0;
};

}  // namespace palpate::diagnosis

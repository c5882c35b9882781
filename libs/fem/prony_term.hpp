// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::fem {

/// One Prony term: the instantaneous modulus is (1 + sum g) times the long-term one, which is the
/// material's.
struct PronyTerm {
  double g = 0.0;      ///< > 0
  double tau_s = 0.0;  ///< > 0

  bool operator==(const PronyTerm&) const = default;
};

}  // namespace palpate::fem

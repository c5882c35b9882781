// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

namespace palpate::blind {

/// So many of so many.
struct Share {
  int hits = 0;
  int count = 0;

  void Add(bool hit) {
    hits += hit ? 1 : 0;
    ++count;
  }
  /// 0 of none.
  double value() const { return count > 0 ? static_cast<double>(hits) / count : 0.0; }
};

}  // namespace palpate::blind

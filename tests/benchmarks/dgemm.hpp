// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <vector>

namespace palpate::benchmarks {

/// The product of two square matrices by the BLAS in use: what one core can do at most.
class Dgemm {
 public:
  explicit Dgemm(int size);

  double Flops() const { return 2.0 * size_ * size_ * size_; }
  void Multiply();
  double FirstEntry() const { return product_.front(); }

 private:
  int size_;
  std::vector<double> a_, b_, product_;  ///< [size * size]
};

}  // namespace palpate::benchmarks

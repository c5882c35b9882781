// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/fem/sparse/aligned_buffer.hpp"
#include "libs/fem/sparse/dense/front_kernels.hpp"
#include "libs/fem/sparse/front_tree.hpp"

namespace palpate::fem::internal {

/// The factor of all fronts as substitution reads it.
class FactorStore {
 public:
  FactorStore(const FrontTree& tree, int size);

  /// Room for the same numbers in single precision, too.
  void MakeRoomForSingle();
  bool has_room_for_single() const { return rounded_.size() > 0; }

  dense::FactorPanel Panel(int front) {
    return {values_.data() + offset_[At(front)], PivotsOf(front), BelowOf(front)};
  }
  dense::SinglePrecisionPanel Rounded(int front) {
    return {rounded_.data() + offset_[At(front)], PivotsOf(front), BelowOf(front)};
  }
  /// [size] Reciprocals of the factor's diagonal.
  double* inverse() { return inverse_.data(); }
  size_t Bytes() const {
    return values_.bytes() + rounded_.bytes() + sizeof(double) * inverse_.size();
  }

 private:
  int PivotsOf(int front) const { return tree_.fronts()[At(front)].Pivots(); }
  int BelowOf(int front) const { return tree_.fronts()[At(front)].Below(); }

  const FrontTree& tree_;
  std::vector<size_t> offset_;  ///< [fronts]
  AlignedBuffer values_;
  AlignedBufferOf<float> rounded_;  ///< empty where they were not requested
  std::vector<double> inverse_;
};

}  // namespace palpate::fem::internal

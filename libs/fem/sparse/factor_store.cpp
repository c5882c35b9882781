// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/sparse/factor_store.hpp"

namespace palpate::fem::internal {

FactorStore::FactorStore(const FrontTree& tree, int size)
    : tree_(tree), inverse_(static_cast<size_t>(size + dense::kTile)) {
  size_t end = 0;
  for (const Front& front : tree.fronts()) {
    offset_.push_back(end);
    end += dense::FactorPanel::Size(front.Pivots(), front.Below());
  }
  // The last tile is read as a whole.
  values_ = AlignedBuffer(end + dense::kTile * dense::kTile);
}

void FactorStore::MakeRoomForSingle() {
  if (!has_room_for_single()) rounded_ = AlignedBufferOf<float>(values_.size());
}

}  // namespace palpate::fem::internal

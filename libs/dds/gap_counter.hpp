// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>

namespace palpate::dds {

/// Counts the messages of one writer that never came, by the counter that each of them carries.
class GapCounter {
 public:
  /// What a counter says about its message.
  enum class Order {
    kNext,         ///< newer than all before; skipped ones were added to lost()
    kRepeated,     ///< the same once more
    kNewSequence,  ///< the writer restarted
  };

  Order Add(uint64_t counter) {
    if (last_ && counter == *last_) return Order::kRepeated;
    const bool restarted = !last_ || counter < *last_;
    if (!restarted) lost_ += counter - *last_ - 1;
    last_ = counter;
    return restarted ? Order::kNewSequence : Order::kNext;
  }

  uint64_t lost() const { return lost_; }

 private:
  std::optional<uint64_t> last_;
  uint64_t lost_ = 0;
};

}  // namespace palpate::dds

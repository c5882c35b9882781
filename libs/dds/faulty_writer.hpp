// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "libs/dds/commanded_fault.hpp"
#include "libs/dds/falsify.hpp"
#include "libs/dds/message_data.hpp"

namespace palpate::dds {

/// Sends the messages of one writer as the commanded fault of its process wants it.
template <typename T>
class FaultyWriter {
 public:
  explicit FaultyWriter(std::shared_ptr<CommandedFault> fault) : fault_(std::move(fault)) {
    fault_->AddWriter(CanBeFalsified<T>);
  }

  /// Whether DDS took it, or the fault swallowed it: the component does not know.
  bool Write(dds_entity_t writer, const T& message) {
    switch (fault_->kind()) {
      case FaultKind::kNone: break;
      case FaultKind::kOff: return true;
      case FaultKind::kStuck: return Send(writer, Stuck(message));
      case FaultKind::kSlow: return SendLater(writer, message);
      case FaultKind::kGarbage: return Send(writer, Garbled(message));
      case FaultKind::kWrong: return Send(writer, Wrong(message));
    }
    return Send(writer, message);
  }

 private:
  static bool Send(dds_entity_t writer, const T& message) {
    return dds_write(writer, &message) == DDS_RETCODE_OK;
  }
  static bool Send(dds_entity_t writer, const Message<T>& message) {
    return Send(writer, *message);
  }

  const Message<T>& Stuck(const T& message) {
    if (held_since_ != fault_->changes()) {
      held_ = CopyOf(message);
      held_since_ = fault_->changes();
    }
    CopyHead(message, &*held_);
    return held_;
  }

  bool SendLater(dds_entity_t writer, const T& message) {
    std::size_t bytes = 0;
    const auto copy = std::make_shared<Message<T>>(CopyOf(message, &bytes));
    return fault_->SendLater(bytes, [writer, copy] { (void)Send(writer, *copy); });
  }

  Message<T> Garbled(const T& message) {
    Message<T> copy = CopyOf(message);
    Garble(&random_, &*copy);
    return copy;
  }

  static Message<T> Wrong(const T& message) {
    Message<T> copy = CopyOf(message);
    if constexpr (CanBeFalsified<T>) Falsify(&*copy);
    return copy;
  }

  std::shared_ptr<CommandedFault> fault_;
  Message<T> held_;
  std::uint64_t held_since_ = 0;  ///< changes() when it was taken
  std::mt19937_64 random_{1};
};

}  // namespace palpate::dds

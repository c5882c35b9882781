// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <memory>
#include <utility>

#include "idl/message_traits.hpp"
#include "libs/dds/endpoint.hpp"
#include "libs/dds/faulty_writer.hpp"
#include "libs/dds/message.hpp"

namespace palpate::dds {

/// Sends messages of one type on one topic. Made by Participant::CreateWriter.
template <typename T>
class Writer : public Endpoint {
 public:
  Writer(dds_entity_t participant, const TopicSettings& topic, const std::string& ros_name,
         std::function<void()> on_change)
      : Endpoint(Kind::kWriter, participant, topic, ros_name, idl::MessageTraits<T>::Descriptor(),
                 std::move(on_change)) {}

  /// Sends in the caller's thread (up to 25 ms for 2 MB). Returns false, and counts, where DDS did
  /// not take it (slow reliable readers for longer than 100 ms, no memory).
  [[nodiscard]] bool Write(const T& message) {
    const bool sent = faulty_ ? faulty_->Write(handle(), message)
                              : dds_write(handle(), &message) == DDS_RETCODE_OK;
    ++(sent ? sent_count_ : failed_count_);
    return sent;
  }
  [[nodiscard]] bool Write(const Message<T>& message) { return Write(*message); }

  /// From now on messages are sent as the fault wants it.
  void Follow(std::shared_ptr<CommandedFault> fault) {
    faulty_ = std::make_unique<FaultyWriter<T>>(std::move(fault));
  }

  /// Waits until every reliable reader has all that was sent; false where that takes longer.
  [[nodiscard]] bool WaitUntilReceived(std::chrono::nanoseconds at_most) {
    return dds_wait_for_acks(handle(), at_most.count()) == DDS_RETCODE_OK;
  }

  uint64_t sent_count() const { return sent_count_; }
  uint64_t failed_count() const { return failed_count_; }

 private:
  std::unique_ptr<FaultyWriter<T>> faulty_;  ///< nullptr: the process allows no faults
  uint64_t sent_count_ = 0;
  uint64_t failed_count_ = 0;
};

}  // namespace palpate::dds

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

#include "idl/message_traits.hpp"
#include "libs/dds/endpoint.hpp"

namespace palpate::dds {

/// Messages on loan from DDS, oldest first; given back when this goes out of scope.
template <typename T>
class Samples {
 public:
  static constexpr size_t kMaxCount = 32;

  /// Takes what is there now, at most kMaxCount, and adds their number to `taken`. Failure to take
  /// shows as no samples.
  explicit Samples(dds_entity_t reader, std::atomic<uint64_t>* taken = nullptr) : reader_(reader) {
    std::array<dds_sample_info_t, kMaxCount> infos;
    taken_ = dds_take(reader_, pointers_.data(), infos.data(), kMaxCount, kMaxCount);
    for (int i = 0; i < taken_; ++i) {
      const size_t index = static_cast<size_t>(i);
      if (!infos[index].valid_data) continue;
      sent_ns_[valid_count_] = infos[index].source_timestamp;
      valid_[valid_count_++] = static_cast<T*>(pointers_[index]);
    }
    if (taken) *taken += valid_count_;
  }
  Samples(const Samples&) = delete;
  Samples& operator=(const Samples&) = delete;
  ~Samples() {
    if (taken_ > 0) dds_return_loan(reader_, pointers_.data(), taken_);
  }

  class Iterator {
   public:
    Iterator(const Samples* samples, size_t at) : samples_(samples), at_(at) {}
    const T& operator*() const { return *samples_->valid_[at_]; }
    /// When the writer wrote it, on the wall clock of its host.
    int64_t sent_ns() const { return samples_->sent_ns_[at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    const Samples* samples_;
    size_t at_;
  };
  Iterator begin() const { return Iterator(this, 0); }
  Iterator end() const { return Iterator(this, valid_count_); }

 private:
  dds_entity_t reader_;
  std::array<void*, kMaxCount> pointers_{};
  std::array<T*, kMaxCount> valid_{};
  std::array<int64_t, kMaxCount> sent_ns_{};  ///< of the valid ones
  size_t valid_count_ = 0;
  dds_return_t taken_ = 0;
};

/// Receives messages of one type on one topic. Made by Participant::CreateReader.
template <typename T>
class Reader : public Endpoint {
 public:
  Reader(dds_entity_t participant, const TopicSettings& topic, const std::string& ros_name,
         std::function<void()> on_change)
      : Endpoint(Kind::kReader, participant, topic, ros_name, idl::MessageTraits<T>::Descriptor(),
                 std::move(on_change)) {}

  /// The messages that wait, oldest first: `for (const T& message : reader.Take()) ...`
  Samples<T> Take() { return Samples<T>(handle(), taken()); }
};

}  // namespace palpate::dds

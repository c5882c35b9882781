// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

struct ddsi_serdata;

namespace palpate::dds {

/// One message as it came over the wire: CDR with its header of 4 bytes, whatever its type.
/// Copies share the bytes.
class RawMessage {
 public:
  RawMessage() = default;
  /// Takes over a reference to `data`.
  RawMessage(ddsi_serdata* data, std::int64_t source_time_ns, std::uint64_t writer);

  std::string_view cdr() const { return cdr_; }
  /// When it was sent, ns since the epoch.
  std::int64_t source_time_ns() const { return source_time_ns_; }
  /// A number that only messages of one writer share.
  std::uint64_t writer() const { return writer_; }
  /// Keeps the bytes.
  std::shared_ptr<const void> owner() const { return data_; }

 private:
  std::shared_ptr<ddsi_serdata> data_;
  std::string_view cdr_;
  std::int64_t source_time_ns_ = 0;
  std::uint64_t writer_ = 0;
};

}  // namespace palpate::dds

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string_view>

#include "libs/recording/bytes.hpp"
#include "libs/recording/records.hpp"

namespace palpate::recording {

/// Calls `visit(opcode, content, offset of the record)` for each whole record. False where the
/// bytes do not end with one.
template <typename Visit>
[[nodiscard]] bool ForEachRecord(std::string_view records, const Visit& visit) {
  ByteReader reader(records);
  while (reader.left() > 0) {
    const std::uint64_t offset = records.size() - reader.left();
    const auto opcode = reader.Get<Opcode>();
    const std::string_view content = reader.Raw(reader.Get<std::uint64_t>());
    if (!reader.ok()) return false;
    visit(opcode, content, offset);
  }
  return true;
}

}  // namespace palpate::recording

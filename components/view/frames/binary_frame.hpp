// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::view {

/// A binary message for the page: uint32 little-endian N, N bytes of JSON, then the arrays. The
/// JSON has, under "arrays", the type, offset and length of each; offsets count from the end of the
/// JSON. 4 + N and all offsets are multiples of 8, so that a browser reads arrays in place.
class BinaryFrame {
 public:
  /// `fields` gets "kind" and "arrays".
  BinaryFrame(std::string_view kind, nlohmann::json fields);

  /// Each name once; the numbers are copied.
  void Add(const std::string& name, std::span<const float> values);
  void Add(const std::string& name, std::span<const std::uint32_t> values);
  void Add(const std::string& name, std::span<const std::uint8_t> values);

  std::string Bytes() const;

 private:
  void Add(const std::string& name, const char* type, const void* values, std::size_t length,
           std::size_t bytes);

  nlohmann::json fields_;
  std::string arrays_;
};

/// The text of a message without arrays. Numbers that are not finite become null, texts that are no
/// UTF-8 are replaced.
std::string JsonText(const nlohmann::json& fields);

}  // namespace palpate::view

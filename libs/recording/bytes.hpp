// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>

namespace palpate::recording {

static_assert(std::endian::native == std::endian::little, "MCAP is little-endian, as this code is");

/// Appends numbers and texts to a buffer, as MCAP lays them out.
class ByteWriter {
 public:
  explicit ByteWriter(std::string* out) : out_(*out) {}

  template <typename Number>
  void Put(Number number) {
    const std::size_t at = out_.size();
    out_.resize(at + sizeof(number));
    std::memcpy(out_.data() + at, &number, sizeof(number));
  }
  void Raw(std::string_view bytes) { out_.append(bytes); }
  /// With its length in 32 bits in front.
  void Text(std::string_view text) {
    Put(static_cast<std::uint32_t>(text.size()));
    Raw(text);
  }
  void Map(const std::map<std::string, std::string>& map) {
    std::size_t size = 0;
    for (const auto& [key, value] : map) size += 8 + key.size() + value.size();
    Put(static_cast<std::uint32_t>(size));
    for (const auto& [key, value] : map) {
      Text(key);
      Text(value);
    }
  }

 private:
  std::string& out_;
};

/// Takes numbers and texts off bytes of a file that may be cut or damaged: once they do not
/// suffice, ok() is false for good and all that is taken is 0 or empty.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t left() const { return rest_.size(); }

  template <typename Number>
  Number Get() {
    Number number{};
    const std::string_view bytes = Raw(sizeof(number));
    if (ok_) std::memcpy(&number, bytes.data(), sizeof(number));
    return number;
  }
  std::string_view Raw(std::uint64_t size) {
    if (!ok_ || size > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::string_view bytes = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return bytes;
  }
  std::string Text() { return std::string(Raw(Get<std::uint32_t>())); }
  std::map<std::string, std::string> Map() {
    std::map<std::string, std::string> map;
    ByteReader inner(Raw(Get<std::uint32_t>()));
    while (inner.left() > 0 && inner.ok()) {
      std::string key = inner.Text();
      map[std::move(key)] = inner.Text();
    }
    ok_ = ok_ && inner.ok();
    return map;
  }
  std::string_view Rest() { return Raw(rest_.size()); }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace palpate::recording

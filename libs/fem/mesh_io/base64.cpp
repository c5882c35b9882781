// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/base64.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "libs/core/large_pages.hpp"

namespace palpate::fem::mesh_io {

namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::string_view kXmlWhiteSpace = " \t\r\n";

constexpr std::array<int8_t, 256> MakeValues() {
  std::array<int8_t, 256> values{};
  values.fill(-1);
  for (size_t k = 0; k < kAlphabet.size(); ++k) {
    values[static_cast<uint8_t>(kAlphabet[k])] = static_cast<int8_t>(k);
  }
  return values;
}

constexpr std::array<int8_t, 256> kValues = MakeValues();

}  // namespace

std::string EncodeBase64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t start = 0; start < bytes.size(); start += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - start);
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (k < count ? static_cast<uint8_t>(bytes[start + k]) : 0U);
    }
    for (size_t k = 0; k < 4; ++k) {
      text += k <= count ? kAlphabet[bits >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

bool Base64Decoder::DecodeQuad() {
  uint32_t bits = 0;
  size_t letters = 0;
  size_t padding = 0;
  while (letters + padding < 4) {
    position_ = text_.find_first_not_of(kXmlWhiteSpace, position_);
    if (position_ == std::string_view::npos) {
      position_ = text_.size();
      return false;
    }
    const char letter = text_[position_++];
    const int value = kValues[static_cast<uint8_t>(letter)];
    if (letter == '=' ? letters < 2 : (value < 0 || padding > 0)) return false;
    bits = bits << 6 | (letter == '=' ? 0U : static_cast<uint32_t>(value));
    ++(letter == '=' ? padding : letters);
  }
  for (size_t k = 0; k + 1 < letters; ++k) {
    pending_ += static_cast<char>(bits >> (16 - 8 * k) & 255U);
  }
  return true;
}

size_t Base64Decoder::DecodeRun(size_t at_most, char* out) {
  const size_t groups = std::min(at_most, (text_.size() - position_) / 4);
  for (size_t group = 0; group < groups; ++group) {
    const char* letters = text_.data() + position_;
    const auto value = [letters](size_t k) -> int {
      return kValues[static_cast<uint8_t>(letters[k])];
    };
    const int bits = value(0) << 18 | value(1) << 12 | value(2) << 6 | value(3);
    if (bits < 0) return group;  // white space, padding or damage
    *out++ = static_cast<char>(bits >> 16);
    *out++ = static_cast<char>(bits >> 8 & 255);
    *out++ = static_cast<char>(bits & 255);
    position_ += 4;
  }
  return groups;
}

bool Base64Decoder::Read(size_t count, std::string* out) {
  if (count > UpperBound()) return false;
  size_t end = out->size();
  out->reserve(end + count);
  AdviseLargePages(*out);
  out->resize(end + count);
  while (end < out->size()) {
    if (pending_.empty()) end += 3 * DecodeRun((out->size() - end) / 3, out->data() + end);
    if (end == out->size()) break;
    if (pending_.empty() && !DecodeQuad()) return false;
    const size_t taken = pending_.copy(out->data() + end, out->size() - end);
    pending_.erase(0, taken);
    end += taken;
  }
  return true;
}

bool Base64Decoder::AtEnd() const {
  return pending_.empty() &&
         text_.find_first_not_of(kXmlWhiteSpace, position_) == std::string_view::npos;
}

}  // namespace palpate::fem::mesh_io

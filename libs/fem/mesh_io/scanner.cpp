// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_io/scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/limits.hpp"

namespace palpate::fem::mesh_io {

namespace {

std::string Quoted(std::string_view word) {
  constexpr size_t kLongest = 40;
  std::string text = "'";
  for (const char letter : word.substr(0, kLongest)) {
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return text + (word.size() > kLongest ? "...'" : "'");
}

}  // namespace

std::string_view Scanner::TokenOrEnd() {
  const size_t start = bytes_.find_first_not_of(kWhiteSpace, position_);
  last_start_ = std::min(start, bytes_.size());
  position_ = std::min(bytes_.find_first_of(kWhiteSpace, last_start_), bytes_.size());
  return bytes_.substr(last_start_, position_ - last_start_);
}

std::string_view Scanner::Token(const char* what) {
  const std::string_view token = TokenOrEnd();
  if (token.empty()) Fail(std::string("the file ends before ") + what);
  return token;
}

std::string_view Scanner::Peek() const {
  const size_t start = std::min(bytes_.find_first_not_of(kWhiteSpace, position_), bytes_.size());
  return bytes_.substr(start);
}

std::string_view Scanner::Line(const char* what) {
  last_start_ = position_;
  if (position_ >= bytes_.size()) Fail(std::string("the file ends before ") + what);
  const size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
  std::string_view line = bytes_.substr(position_, end - position_);
  position_ = std::min(end + 1, bytes_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string_view Scanner::Bytes(size_t count, const char* what) {
  last_start_ = position_;
  if (count > bytes_.size() - position_) Fail(std::string("the file ends within ") + what);
  position_ += count;
  return bytes_.substr(last_start_, count);
}

void Scanner::SkipPast(std::string_view mark) {
  last_start_ = position_;
  const size_t found = bytes_.find(mark, position_);
  if (found == std::string_view::npos) Fail("the file ends before " + std::string(mark));
  position_ = found + mark.size();
}

double Scanner::Real(ScalarType type, const char* what) {
  double value = 0.0;
  if (binary_) {
    value = DecodeReal(type, Bytes(SizeInBytes(type), what), swap_);
    if (!std::isfinite(value)) Fail(std::string(what) + " is not finite");
    return value;
  }
  const std::string_view token = Token(what);
  if (!ParseFinite(token, &value)) {
    Fail(std::string(what) + ": " + Quoted(token) + " is not a finite number");
  }
  return value;
}

double Scanner::RealOrNan(ScalarType type, const char* what) {
  if (binary_) return DecodeReal(type, Bytes(SizeInBytes(type), what), swap_);
  double value = 0.0;
  return ParseFinite(Token(what), &value) ? value : std::numeric_limits<double>::quiet_NaN();
}

int64_t Scanner::Integer(ScalarType type, int64_t min, int64_t max, const char* what) {
  if (!binary_) return TextInteger(min, max, what);
  const auto value = DecodeInteger(type, Bytes(SizeInBytes(type), what), swap_);
  if (!value || *value < min || *value > max) {
    Fail(std::string(what) + ": " + (value ? std::to_string(*value) : "a value above 2^63") +
         " is outside " + std::to_string(min) + " to " + std::to_string(max));
  }
  return *value;
}

int64_t Scanner::TextInteger(int64_t min, int64_t max, const char* what) {
  const std::string_view token = Token(what);
  int64_t value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) {
    Fail(std::string(what) + ": " + Quoted(token) + " is not an integer");
  }
  if (value < min || value > max) {
    Fail(std::string(what) + ": " + std::to_string(value) + " is outside " + std::to_string(min) +
         " to " + std::to_string(max));
  }
  return value;
}

void Scanner::CheckRoom(int64_t count, size_t bytes_each, const char* what) {
  const size_t room = bytes_.size() - position_ + 1;
  if (count < 0 || static_cast<uint64_t>(count) > room / bytes_each) {
    Fail("the file is too short for " + std::to_string(count) + " " + what);
  }
}

void Scanner::Fail(const std::string& message) const {
  if (binary_) {
    throw InputError(file_ + ": byte " + std::to_string(last_start_) + ": " + message);
  }
  const std::string_view before = bytes_.substr(0, last_start_);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  throw InputError({file_, static_cast<int>(line), static_cast<int>(last_start_ - line_start + 1)},
                   message);
}

}  // namespace palpate::fem::mesh_io

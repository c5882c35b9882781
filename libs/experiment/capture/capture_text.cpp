// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/capture/capture_text.hpp"

#include <algorithm>
#include <cctype>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/cloud/scalar.hpp"
#include "libs/experiment/table_text.hpp"

namespace palpate::experiment {

namespace {

std::string_view Unwrapped(std::string_view cell) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!cell.empty() && is_blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && is_blank(cell.back())) cell.remove_suffix(1);
  const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return quoted ? cell.substr(1, cell.size() - 2) : cell;
}

}  // namespace

CaptureText::CaptureText(const std::filesystem::path& file)
    : file_(file.string()), bytes_(ReadTableText(file)) {
  Rewind();
}

void CaptureText::Rewind() {
  rest_ = bytes_;
  line_number_ = 0;
  cells_.clear();
}

bool CaptureText::NextLine() {
  if (rest_.empty()) return false;
  line_ = TakeLine(&rest_);
  ++line_number_;
  Split(line_);
  return true;
}

void CaptureText::Split(std::string_view line) {
  separator_ = line.find('\t') != std::string_view::npos  ? '\t'
               : line.find(';') != std::string_view::npos ? ';'
                                                          : ',';
  cells_.clear();
  bool in_quotes = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') in_quotes = !in_quotes;
    if (line[i] != separator_ || in_quotes) continue;
    cells_.push_back(Unwrapped(line.substr(begin, i - begin)));
    begin = i + 1;
  }
  cells_.push_back(Unwrapped(line.substr(begin)));
}

std::string_view CaptureText::Cell(std::size_t column) const {
  return column < cells_.size() ? cells_[column] : std::string_view();
}

bool CaptureText::IsBlank() const {
  return std::all_of(cells_.begin(), cells_.end(), [](std::string_view c) { return c.empty(); });
}

std::optional<double> CaptureText::Number(std::size_t column) const {
  const std::string_view cell = Cell(column);
  double value = 0.0;
  if (ParseFinite(cell, &value)) return value;
  if (StandsForMissing(cell)) return std::nullopt;
  if (separator_ == ',' || !ParseWithPointOrComma(cell, &value)) {
    Refuse(column, "'" + Excerpt(cell) + "' is not a finite number");
  }
  return value;
}

double CaptureText::Require(std::size_t column, const std::string& what) const {
  const std::optional<double> value = Number(column);
  if (!value) Refuse(column, what + " is missing");
  return *value;
}

void CaptureText::Refuse(std::size_t column, const std::string& message) const {
  const bool there = column < cells_.size();
  const int place = there ? static_cast<int>(cells_[column].data() - line_.data()) + 1 : 1;
  throw InputError(SourceLocation{file_, line_number_, place}, message);
}

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

bool HasNoName(std::string_view label) {
  const std::string word = LowerCase(label);
  return word.empty() || word.starts_with('*') || word.starts_with("unlabeled") ||
         word.starts_with("unlabelled");
}

bool ParseWithPointOrComma(std::string_view text, double* value) {
  std::string with_point(text);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return ParseFinite(with_point, value);
}

std::optional<double> MetresPerUnit(std::string_view unit) {
  std::string word = LowerCase(unit);
  if (word.ends_with("meters") || word.ends_with("metres")) word.pop_back();
  if (word == "m" || word == "meter" || word == "metre") return 1.0;
  if (word == "cm" || word == "centimeter" || word == "centimetre") return 1e-2;
  if (word == "mm" || word == "millimeter" || word == "millimetre") return 1e-3;
  return std::nullopt;
}

}  // namespace palpate::experiment

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/csv_table.hpp"

#include <algorithm>

#include "libs/core/text.hpp"
#include "libs/experiment/table_text.hpp"

namespace palpate::experiment {

namespace {

std::string_view WithoutBlanks(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view WithoutQuotes(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

// The next line without its end; `rest` moves behind it.
std::string_view TakeLine(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

// Splits a line into its fields, quotes and blanks included.
class FieldSplitter {
 public:
  FieldSplitter(std::string_view line, char separator) : line_(line), separator_(separator) {}

  bool Next(std::string_view& field) {
    if (done_) return false;
    const std::size_t end = EndOfField();
    field = line_.substr(0, end);
    done_ = end == std::string_view::npos;
    if (!done_) line_.remove_prefix(end + 1);
    return true;
  }

 private:
  /// A separator inside quotes is none.
  std::size_t EndOfField() const {
    bool in_quotes = false;
    for (std::size_t i = 0; i < line_.size(); ++i) {
      if (line_[i] == '"') in_quotes = !in_quotes;
      if (line_[i] == separator_ && !in_quotes) return i;
    }
    return std::string_view::npos;
  }

  std::string_view line_;
  char separator_;
  bool done_ = false;
};

char SeparatorOf(std::string_view header) {
  if (header.find(',') != std::string_view::npos) return ',';
  if (header.find(';') != std::string_view::npos) return ';';
  return header.find('\t') != std::string_view::npos ? '\t' : ',';
}

// "0,25" as 0.25.
bool ParseWithComma(std::string_view text, double* value) {
  std::string with_point(text);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return ParseFinite(with_point, value);
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& file)
    : file_(file.string()), bytes_(std::make_unique<const std::string>(ReadTableText(file))) {}

CsvTable CsvTable::Read(const std::filesystem::path& file) {
  CsvTable table(file);
  std::string_view rest = *table.bytes_;
  while (!rest.empty() && (rest.back() == '\n' || rest.back() == '\r')) rest.remove_suffix(1);
  if (rest.empty()) {
    throw InputError(SourceLocation{table.file_, 1, 1}, "the file is empty; a header is expected");
  }
  table.ParseHeader(TakeLine(rest));
  for (int line_number = 2; !rest.empty(); ++line_number) {
    table.ParseRow(TakeLine(rest), line_number);
  }
  table.FindDecimalComma();
  return table;
}

void CsvTable::ParseHeader(std::string_view line) {
  if (line.starts_with('#') || line.starts_with("sep=")) {
    throw InputError(SourceLocation{file_, 1, 1},
                     "'" + Excerpt(line) +
                         "' is no header: remove the lines before the one that names the columns");
  }
  separator_ = SeparatorOf(line);
  FieldSplitter fields(line, separator_);
  for (std::string_view field; fields.Next(field);) {
    const std::string name(WithoutQuotes(WithoutBlanks(field)));
    const int column = static_cast<int>(field.data() - line.data()) + 1;
    const SourceLocation where{file_, 1, column};
    if (name.empty()) throw InputError(where, "a column without a name");
    if (std::find(header_.begin(), header_.end(), name) != header_.end()) {
      throw InputError(where, "column '" + name + "' is given twice");
    }
    header_.push_back(name);
    header_columns_.push_back(column);
  }
}

void CsvTable::ParseRow(std::string_view line, int line_number) {
  FieldSplitter fields(line, separator_);
  std::size_t count = 0;
  for (std::string_view field; fields.Next(field); ++count) {
    const std::string_view text = WithoutQuotes(WithoutBlanks(field));
    if (text.find('"') != std::string_view::npos) {
      const int column = static_cast<int>(field.data() - line.data()) + 1;
      throw InputError(SourceLocation{file_, line_number, column},
                       "a quote inside a field is not understood");
    }
    cells_.push_back(text);
  }
  if (count != header_.size()) {
    throw InputError(SourceLocation{file_, line_number, 1},
                     "the row has " + std::to_string(count) + " fields, the header has " +
                         std::to_string(header_.size()) + ", separated by " +
                         (separator_ == '\t' ? "tabs" : std::string("'") + separator_ + "'"));
  }
}

std::optional<double> CsvTable::OptionalNumber(std::size_t row, std::size_t column) const {
  const std::string_view text = Text(row, column);
  if (text.empty()) return std::nullopt;
  double value = 0.0;
  if (!ParseNumber(text, &value)) {
    Refuse(row, column, "not a finite number (a missing sample is an empty field)");
  }
  return value;
}

std::optional<double> CsvTable::OptionalSample(std::size_t row, std::size_t column) const {
  const std::string_view text = Text(row, column);
  if (StandsForMissing(text)) return std::nullopt;
  return OptionalNumber(row, column);
}

void CsvTable::FindDecimalComma() {
  double value = 0.0;
  decimal_comma_ = std::any_of(cells_.begin(), cells_.end(), [&](std::string_view text) {
    return text.find(',') != std::string_view::npos && ParseWithComma(text, &value);
  });
}

// Where commas are decimal a point could group thousands, and is refused.
bool CsvTable::ParseNumber(std::string_view text, double* value) const {
  if (!decimal_comma_) return ParseFinite(text, value);
  return text.find('.') == std::string_view::npos && ParseWithComma(text, value);
}

double CsvTable::Number(std::size_t row, std::size_t column) const {
  const std::optional<double> value = OptionalNumber(row, column);
  if (!value) Refuse(row, column, "must not be empty");
  return *value;
}

int CsvTable::ColumnOf(std::string_view field) const {
  const char* begin = field.data();
  while (begin != bytes_->data() && *(begin - 1) != '\n') --begin;
  return static_cast<int>(field.data() - begin) + 1;
}

SourceLocation CsvTable::Where(std::size_t row, std::size_t column) const {
  return {file_, Line(row), ColumnOf(Text(row, column))};
}

SourceLocation CsvTable::HeaderWhere(std::size_t column) const {
  return {file_, 1, header_columns_[column]};
}

void CsvTable::Refuse(std::size_t row, std::size_t column, const std::string& message) const {
  throw InputError(Where(row, column),
                   header_[column] + " '" + Excerpt(Text(row, column)) + "': " + message);
}

}  // namespace palpate::experiment

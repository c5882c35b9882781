// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate::experiment {

/// A comma-separated table with one header line, kept as text until a field is asked for.
/// Blanks around a field and quotes about a whole field are dropped; line ends and encodings are
/// those of ReadTableText; empty lines are allowed at the end only. A header without commas may
/// have semicolons or tabs between its fields, as spreadsheets of some countries write them. Then,
/// and in quotes, numbers may have a decimal comma, all of them or none.
class CsvTable {
 public:
  /// Throws InputError with file:line:column where the file cannot be read, is empty, has a row
  /// with more or fewer fields than the header, a quote in a field, a header field that is empty
  /// or given twice.
  static CsvTable Read(const std::filesystem::path& file);

  const std::string& file() const { return file_; }
  const std::vector<std::string>& header() const { return header_; }
  std::size_t rows() const { return cells_.size() / header_.size(); }

  std::string_view Text(std::size_t row, std::size_t column) const {
    return cells_[row * header_.size() + column];
  }
  /// A finite number, or nullopt for an empty field. Throws InputError for anything else.
  std::optional<double> OptionalNumber(std::size_t row, std::size_t column) const;
  /// A finite number; an empty field throws InputError as well.
  double Number(std::size_t row, std::size_t column) const;
  /// As OptionalNumber, and nullopt also for what StandsForMissing, such as NaN.
  std::optional<double> OptionalSample(std::size_t row, std::size_t column) const;

  int Line(std::size_t row) const { return static_cast<int>(row) + 2; }
  SourceLocation Where(std::size_t row, std::size_t column) const;
  SourceLocation HeaderWhere(std::size_t column) const;

  /// Throws InputError at the field: "<column name> '<text>': message".
  [[noreturn]] void Refuse(std::size_t row, std::size_t column, const std::string& message) const;

 private:
  explicit CsvTable(const std::filesystem::path& file);
  void ParseHeader(std::string_view line);
  void ParseRow(std::string_view line, int line_number);
  int ColumnOf(std::string_view field) const;
  bool ParseNumber(std::string_view text, double* value) const;
  void FindDecimalComma();

  std::string file_;
  char separator_ = ',';
  bool decimal_comma_ = false;
  std::unique_ptr<const std::string>
      bytes_;  // what the fields point into; moving keeps its address
  std::vector<std::string> header_;
  std::vector<int> header_columns_;      // in the line, from 1
  std::vector<std::string_view> cells_;  // rows x columns
};

}  // namespace palpate::experiment

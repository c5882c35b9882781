// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::experiment {

/// A table as a capture program exports it: lines of cells, whatever the cells are about. They are
/// separated by ',' or, where the line at hand has some, by tabs or ';', and then a decimal comma
/// is understood. Blanks and quotes around a cell are dropped. See ReadTableText for encodings.
class CaptureText {
 public:
  /// Throws InputError where the file cannot be read.
  explicit CaptureText(const std::filesystem::path& file);

  const std::string& file() const { return file_; }
  std::string_view bytes() const { return bytes_; }
  /// Goes on to the next line; false at the end.
  bool NextLine();
  /// Back to before the first line.
  void Rewind();

  int line_number() const { return line_number_; }
  const std::vector<std::string_view>& cells() const { return cells_; }
  /// Empty where the line has no such cell.
  std::string_view Cell(std::size_t column) const;
  /// No cell holds anything.
  bool IsBlank() const;
  /// nullopt for what StandsForMissing. Throws InputError for what else is no finite number.
  std::optional<double> Number(std::size_t column) const;
  /// Throws InputError also for a missing one; `what` names it.
  double Require(std::size_t column, const std::string& what) const;

  /// Throws InputError at the cell; at most 80 characters of it are shown.
  [[noreturn]] void Refuse(std::size_t column, const std::string& message) const;

 private:
  void Split(std::string_view line);

  std::string file_;
  std::string bytes_;
  std::string_view rest_;
  std::string_view line_;
  int line_number_ = 0;
  char separator_ = ',';
  std::vector<std::string_view> cells_;
};

/// `text` in lower case.
std::string LowerCase(std::string_view text);

/// Whether `label` is what programs call a trajectory that nobody named: "", "*12", "Unlabeled 12".
bool HasNoName(std::string_view label);

/// The whole of `text` as a finite number, with a decimal point or a decimal comma.
bool ParseWithPointOrComma(std::string_view text, double* value);

/// Metres in "mm", "Millimeters", "cm", "m", ...; nullopt for any other word.
std::optional<double> MetresPerUnit(std::string_view unit);

}  // namespace palpate::experiment

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/palpate/solve_rows.hpp"

namespace palpate::command {

/// What is written besides the tables.
struct Extras {
  bool vtu = false;  ///< body_0000.vtu, for ParaView
  bool png = false;  ///< scene_0000.png
};

/// The folder that `palpate solve` fills: nodes_0000.csv (node,x_m,y_m,z_m) and the extras for each
/// row that converged; cables.csv (row,cable,displacement_m,tension_N; the
/// fields of a row that did not converge are empty) and result.json at the end.
class SolveOutput {
 public:
  /// Creates the folder and removes the results of an earlier `solve` from it, so that no old row
  /// is mistaken for a new one. Throws RunError where that fails.
  SolveOutput(std::filesystem::path folder, const robot::RobotModel& model, const Extras& extras);

  /// Writes the row's own files. Throws RunError where they cannot be written.
  void Add(const RowResult& result);

  /// Writes cables.csv and result.json; returns the text of the latter. Throws RunError.
  std::string Finish(const std::vector<std::string>& notes);

 private:
  void AddCables(const RowResult& result);
  void Draw(const RowResult& result) const;
  std::filesystem::path RowFile(const char* stem, int row, const char* extension) const;

  struct RowSummary {
    int row;
    double t_s;
    fem::StaticResult solver;
    double time_s;
    std::vector<std::string> notes;
  };

  std::filesystem::path folder_;
  const robot::RobotModel& model_;
  Extras extras_;
  std::string cables_text_;
  std::vector<RowSummary> rows_;
};

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/palpate/solve_rows.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::command {

/// What is written besides the tables.
struct Extras {
  bool vtu = false;  ///< body_0000.vtu, cables_0000.vtu and body.pvd, for ParaView
  bool png = false;  ///< scene_0000.png
};

/// The folder that `palpate solve` fills. For each row that converged: nodes_0000.csv
/// (node,x_m,y_m,z_m) and the extras. At the end: markers.csv (t_s,marker,x_m,y_m,z_m, robot frame,
/// the frames of the rows that converged), cables.csv (row,cable,displacement_m,tension_N; the
/// fields of a row that did not converge are empty), chambers.csv of a robot that has any
/// (row,chamber,pressure_Pa,volume_m3: above ambient, change from rest) and result.json, which
/// lists all files.
class SolveOutput {
 public:
  /// Creates the folder for `row_count` rows; replaces the results of an earlier `solve`
  /// (MakeRoomForResults). Throws InputError where that is refused, RunError where it fails.
  SolveOutput(std::filesystem::path folder, const robot::RobotModel& model, const Extras& extras,
              int row_count);

  /// Writes the row's own files. Throws RunError where they cannot be written.
  void Add(const RowResult& result);

  /// Writes the rest; returns the text of result.json. `interrupted`: not all rows were added.
  /// Throws RunError.
  std::string Finish(const std::vector<std::string>& notes, bool interrupted);

 private:
  void AddMarkers(const RowResult& result);
  void AddActuators(const RowResult& result);
  void WriteBody(const RowResult& result);
  void Draw(const RowResult& result);
  void WriteTables();
  /// The path of a file of this folder, which result.json will list.
  std::filesystem::path File(const std::string& name);

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
  std::string chambers_text_;
  experiment::MarkerTracks markers_;
  std::vector<RowSummary> rows_;
  std::vector<std::string> files_;
};

}  // namespace palpate::command

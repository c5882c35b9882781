// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/load_cases.hpp"

#include <algorithm>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"

namespace palpate::command {

namespace {

using experiment::Actuation;
using experiment::CableColumn;
using experiment::CableQuantity;
using robot::CableCommand;

void CheckCables(const Actuation& actuation, const std::vector<std::string>& cable_names) {
  for (const CableColumn& column : actuation.columns) {
    if (std::find(cable_names.begin(), cable_names.end(), column.cable) == cable_names.end()) {
      throw InputError(column.where, "the robot has no cable '" + column.cable + "'" +
                                         DidYouMean(column.cable, cable_names));
    }
  }
}

// The column that drives the cable, or nullptr.
const CableColumn* DrivingColumn(const Actuation& actuation, const std::string& cable,
                                 Drive drive) {
  const CableColumn* displacement = actuation.Find(cable, CableQuantity::kDisplacement);
  const CableColumn* tension = actuation.Find(cable, CableQuantity::kTension);
  if (displacement == nullptr || tension == nullptr) {
    return displacement != nullptr ? displacement : tension;
  }
  if (drive == Drive::kNotSaid) {
    throw InputError(tension->where, "cable '" + cable +
                                         "' has a displacement and a tension column; say with "
                                         "--drive displacement|tension which of them is imposed");
  }
  return drive == Drive::kDisplacement ? displacement : tension;
}

CableCommand CommandAt(const Actuation& actuation, const CableColumn& column, double t_s) {
  const bool displacement = column.quantity == CableQuantity::kDisplacement;
  return {displacement ? CableCommand::Kind::kDisplacement : CableCommand::Kind::kTension,
          actuation.ValueAt(column, t_s)};
}

std::vector<double> TimesOf(const std::vector<experiment::KnownLoad>& loads) {
  std::vector<double> times_s;
  for (const experiment::KnownLoad& load : loads) {
    if (times_s.empty() || load.t_s > times_s.back()) {
      times_s.push_back(load.t_s);
    }
  }
  return times_s.empty() ? std::vector<double>{0.0} : times_s;
}

}  // namespace

Actuation ReadActuationRows(const std::filesystem::path& file) {
  const auto table = experiment::CsvTable::Read(file);
  if (table.header() != std::vector<std::string>{"t_s"}) {
    return experiment::ReadActuation(file);
  }
  Actuation actuation;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    actuation.t_s.push_back(experiment::RisingTime(table, row, 0, experiment::Rise::kStrict));
  }
  if (actuation.t_s.empty()) {
    throw InputError({file.string(), 1, 1}, "no row");
  }
  return actuation;
}

LoadCases MakeLoadCases(const std::optional<Actuation>& actuation,
                        const std::vector<experiment::KnownLoad>& loads,
                        const std::vector<std::string>& cable_names, Drive drive) {
  const Actuation driven = actuation.value_or(Actuation{});
  CheckCables(driven, cable_names);
  LoadCases cases;
  std::vector<const CableColumn*> columns;
  for (const std::string& cable : cable_names) {
    columns.push_back(DrivingColumn(driven, cable, drive));
    if (columns.back() == nullptr) {
      cases.notes.push_back("cable " + cable + " is not driven: no tension");
    }
  }
  for (const double t_s : actuation ? driven.t_s : TimesOf(loads)) {
    LoadCase row{t_s, {}, experiment::LoadsAt(loads, t_s)};
    for (const CableColumn* column : columns) {
      row.cables.push_back(column == nullptr ? CableCommand{} : CommandAt(driven, *column, t_s));
    }
    cases.rows.push_back(std::move(row));
  }
  return cases;
}

}  // namespace palpate::command

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

// The columns of one cable; nullptr where the file has none.
struct CableColumns {
  const CableColumn* displacement = nullptr;
  const CableColumn* tension = nullptr;
};

CableColumns ColumnsOf(const Actuation& actuation, const std::string& cable) {
  return {actuation.Find(cable, CableQuantity::kDisplacement),
          actuation.Find(cable, CableQuantity::kTension)};
}

CableCommand CommandAt(const Actuation& actuation, const CableColumns& columns, double t_s,
                       robot::CableInput preferred) {
  const auto value = [&](const CableColumn* column) {
    return column == nullptr ? std::nullopt
                             : std::optional<double>(actuation.ValueAt(*column, t_s));
  };
  return robot::ChooseCommand(value(columns.displacement), value(columns.tension), preferred);
}

void NoteChoice(const std::string& cable, const CableColumns& columns, robot::CableInput preferred,
                std::vector<std::string>* notes) {
  if (columns.displacement == nullptr && columns.tension == nullptr) {
    notes->push_back("cable " + cable + " is not actuated: its tension is 0");
  } else if (columns.displacement != nullptr && columns.tension != nullptr) {
    const bool displacement = preferred == robot::CableInput::kDisplacement;
    notes->push_back("cable " + cable + " has a displacement and a tension: the " +
                     (displacement ? "displacement" : "tension") +
                     " is prescribed (--cable-input)");
  }
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
    throw InputError({file.string(), 1, 1}, "the table has no rows");
  }
  return actuation;
}

LoadCases MakeLoadCases(const std::optional<Actuation>& actuation,
                        const std::vector<experiment::KnownLoad>& loads,
                        const std::vector<std::string>& cable_names, robot::CableInput preferred) {
  const Actuation driven = actuation.value_or(Actuation{});
  CheckCables(driven, cable_names);
  LoadCases cases;
  std::vector<CableColumns> columns;
  for (const std::string& cable : cable_names) {
    columns.push_back(ColumnsOf(driven, cable));
    NoteChoice(cable, columns.back(), preferred, &cases.notes);
  }
  for (const double t_s : actuation ? driven.t_s : TimesOf(loads)) {
    LoadCase row{t_s, {}, experiment::LoadsAt(loads, t_s)};
    for (const CableColumns& of_cable : columns) {
      row.cables.push_back(CommandAt(driven, of_cable, t_s, preferred));
    }
    cases.rows.push_back(std::move(row));
  }
  return cases;
}

}  // namespace palpate::command

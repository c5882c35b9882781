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
using experiment::ActuatorColumn;
using experiment::ActuatorQuantity;
using robot::ActuatorCommand;

// The columns of one actuator; nullptr where the file has none.
struct Columns {
  const ActuatorColumn* displacement = nullptr;
  const ActuatorColumn* tension = nullptr;
};

Columns ColumnsOf(const Actuation& actuation, const std::string& actuator) {
  return {actuation.Find(actuator, ActuatorQuantity::kDisplacement),
          actuation.Find(actuator, ActuatorQuantity::kTension)};
}

ActuatorCommand CommandAt(const Actuation& actuation, const Columns& columns,
                          const robot::ActuatorTraits& traits, double t_s,
                          robot::CableInput preferred) {
  const auto value = [&](const ActuatorColumn* column) {
    return column == nullptr ? std::nullopt
                             : std::optional<double>(actuation.ValueAt(*column, t_s));
  };
  return robot::ChooseCommand(traits, value(columns.displacement), value(columns.tension),
                              preferred);
}

void NoteChoice(const robot::ActuatorTraits& traits, const Columns& columns,
                robot::CableInput preferred, std::vector<std::string>* notes) {
  const bool is_chamber = traits.IsChamber();
  if (columns.displacement == nullptr && columns.tension == nullptr) {
    notes->push_back(traits.Title() + (is_chamber ? " is open to the air: its pressure is 0"
                                                  : " is not actuated: its tension is 0"));
  } else if (columns.displacement != nullptr && columns.tension != nullptr) {
    const std::string displacement = is_chamber ? "volume" : "displacement";
    const std::string tension = is_chamber ? "pressure" : "tension";
    notes->push_back(traits.Title() + " has a " + displacement + " and a " + tension + ": the " +
                     (preferred == robot::CableInput::kDisplacement ? displacement : tension) +
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
                        const std::vector<robot::ActuatorTraits>& actuators,
                        robot::CableInput preferred) {
  const Actuation driven = actuation.value_or(Actuation{});
  std::vector<std::string> cables, chambers;
  for (const robot::ActuatorTraits& one : actuators) {
    (one.IsChamber() ? chambers : cables).push_back(one.name);
  }
  experiment::CheckActuators(driven, cables, chambers);
  LoadCases cases;
  std::vector<Columns> columns;
  for (const robot::ActuatorTraits& one : actuators) {
    columns.push_back(ColumnsOf(driven, one.name));
    NoteChoice(one, columns.back(), preferred, &cases.notes);
  }
  for (const double t_s : actuation ? driven.t_s : TimesOf(loads)) {
    LoadCase row{t_s, {}, experiment::LoadsAt(loads, t_s)};
    for (std::size_t a = 0; a < actuators.size(); ++a) {
      row.cables.push_back(CommandAt(driven, columns[a], actuators[a], t_s, preferred));
    }
    cases.rows.push_back(std::move(row));
  }
  return cases;
}

}  // namespace palpate::command

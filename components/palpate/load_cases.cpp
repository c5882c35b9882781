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
using experiment::ActuationWithGas;
using experiment::ActuatorColumn;
using experiment::ActuatorQuantity;
using robot::ActuatorCommand;

// The columns of one actuator; nullptr where the file has none.
struct Columns {
  const ActuatorColumn* displacement = nullptr;
  const ActuatorColumn* tension = nullptr;
  const experiment::GasColumn* gas = nullptr;
};

Columns ColumnsOf(const ActuationWithGas& inputs, const std::string& actuator) {
  return {inputs.actuation.Find(actuator, ActuatorQuantity::kDisplacement),
          inputs.actuation.Find(actuator, ActuatorQuantity::kTension), inputs.FindGas(actuator)};
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
  if (columns.gas != nullptr) return;
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

ActuationWithGas ReadActuationRows(const std::filesystem::path& file) {
  const auto table = experiment::CsvTable::Read(file);
  if (table.header() != std::vector<std::string>{"t_s"}) {
    return experiment::ReadActuationWithGas(file);
  }
  ActuationWithGas inputs;
  std::vector<double>& t_s = inputs.actuation.t_s;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    t_s.push_back(experiment::RisingTime(table, row, 0, experiment::Rise::kStrict));
  }
  if (t_s.empty()) {
    throw InputError({file.string(), 1, 1}, "the table has no rows");
  }
  return inputs;
}

LoadCases MakeLoadCases(const std::optional<ActuationWithGas>& actuation,
                        const std::vector<experiment::KnownLoad>& loads,
                        const std::vector<robot::ActuatorTraits>& actuators,
                        robot::CableInput preferred) {
  const ActuationWithGas inputs = actuation.value_or(ActuationWithGas{});
  const Actuation& driven = inputs.actuation;
  std::vector<std::string> cables, chambers;
  for (const robot::ActuatorTraits& one : actuators) {
    (one.IsChamber() ? chambers : cables).push_back(one.name);
  }
  experiment::CheckActuators(driven, cables, chambers);
  experiment::CheckGas(inputs, cables, chambers);
  LoadCases cases;
  std::vector<Columns> columns;
  for (const robot::ActuatorTraits& one : actuators) {
    columns.push_back(ColumnsOf(inputs, one.name));
    NoteChoice(one, columns.back(), preferred, &cases.notes);
  }
  for (const double t_s : actuation ? driven.t_s : TimesOf(loads)) {
    LoadCase row{t_s, {}, {}, experiment::LoadsAt(loads, t_s)};
    for (std::size_t a = 0; a < actuators.size(); ++a) {
      row.cables.push_back(CommandAt(driven, columns[a], actuators[a], t_s, preferred));
      if (columns[a].gas == nullptr) continue;
      row.gas.push_back(
          {.actuator = static_cast<int>(a), .air_m3 = inputs.AirAt_m3(*columns[a].gas, t_s)});
    }
    cases.rows.push_back(std::move(row));
  }
  return cases;
}

void CheckAir(const ActuationWithGas& actuation, const std::vector<robot::BodyChamber>& chambers) {
  for (const robot::BodyChamber& chamber : chambers) {
    const experiment::GasColumn* column = actuation.FindGas(chamber.name);
    if (column == nullptr) continue;
    const double holds_m3 = chamber.volume_m3 + chamber.dead_volume_m3;
    for (std::size_t row = 0; row < column->air_m3.size(); ++row) {
      if (column->air_m3[row].value_or(0.0) > -holds_m3) continue;
      throw InputError(column->fields[row], "chamber " + chamber.name + " cannot lose " +
                                                FormatNumber(-*column->air_m3[row]) +
                                                " m3 of air: with its tube it holds " +
                                                FormatNumber(holds_m3) + " m3");
    }
  }
}

}  // namespace palpate::command

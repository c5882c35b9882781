// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/actuation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "libs/core/file.hpp"
#include "libs/core/names.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/actuator_fault.hpp"
#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/gas_inputs.hpp"
#include "libs/experiment/interpolate_samples.hpp"

namespace palpate::experiment {

namespace {

constexpr double kLargestDisplacement_m = 2.0;
constexpr double kLargestVolume_m3 = 0.1;
constexpr double kVacuum_Pa = -101325.0;
constexpr const char* kDisplacementSuffix = ".displacement_m";
constexpr const char* kTensionSuffix = ".tension_N";
constexpr const char* kVolumeSuffix = ".volume_m3";
constexpr const char* kPressureSuffix = ".pressure_Pa";
constexpr const char* kAirSuffix = ".air_m3";
constexpr const char* kExpected =
    "expected <cable>.displacement_m, <cable>.tension_N, <chamber>.pressure_Pa or "
    "<chamber>.volume_m3";

struct Suffix {
  const char* text;
  ActuatorQuantity quantity;
  bool of_chamber;
};

constexpr std::array kSuffixes{Suffix{kDisplacementSuffix, ActuatorQuantity::kDisplacement, false},
                               Suffix{kTensionSuffix, ActuatorQuantity::kTension, false},
                               Suffix{kVolumeSuffix, ActuatorQuantity::kDisplacement, true},
                               Suffix{kPressureSuffix, ActuatorQuantity::kTension, true}};

/// Name of the chamber whose amount of gas a column gives; nullopt: it is another column.
std::optional<std::string> GasOfChamber(const CsvTable& table, std::size_t index) {
  const std::string& name = table.header()[index];
  const std::size_t dot = name.rfind('.');
  if (dot == 0 || dot == std::string::npos) return std::nullopt;
  const std::string suffix = name.substr(dot);
  if (SplitUnit(suffix).stem != SplitUnit(kAirSuffix).stem) return std::nullopt;
  if (suffix != kAirSuffix) RefuseUnit(table, index, name.substr(0, dot) + kAirSuffix);
  return name.substr(0, dot);
}

// Actuator and quantity of a header field; throws where it names no quantity or another unit.
ActuatorColumn ParseHeaderField(const CsvTable& table, std::size_t index) {
  const std::string& name = table.header()[index];
  const std::size_t dot = name.rfind('.');
  ActuatorColumn column;
  column.where = table.HeaderWhere(index);
  if (dot == 0 || dot == std::string::npos) {
    throw InputError(column.where, "unknown column '" + name + "'; expected t_s, or " +
                                       std::string(kExpected).substr(9));
  }
  column.cable = name.substr(0, dot);
  const std::string suffix = name.substr(dot);
  std::vector<std::string> possible;
  for (const Suffix& known : kSuffixes) {
    column.quantity = known.quantity;
    column.of_chamber = known.of_chamber;
    if (suffix == known.text) return column;
    if (SplitUnit(suffix).stem == SplitUnit(known.text).stem) {
      RefuseUnit(table, index, column.cable + known.text);
    }
    possible.push_back(column.cable + known.text);
  }
  throw InputError(column.where,
                   "unknown column '" + name + "'" + DidYouMean(name, possible) + "; " + kExpected);
}

/// nullopt where every field is empty: it was not measured.
std::optional<ActuatorColumn> ReadColumn(const CsvTable& table, std::size_t index) {
  ActuatorColumn column = ParseHeaderField(table, index);
  column.samples.reserve(table.rows());
  bool any = false;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    column.samples.push_back(table.OptionalNumber(row, index));
    if (!column.samples.back()) continue;
    const std::string fault =
        ActuatorFault(*column.samples.back(), column.quantity, column.of_chamber);
    if (!fault.empty()) table.Refuse(row, index, fault);
    any = true;
  }
  if (!any) return std::nullopt;
  return column;
}

/// nullopt where every field is empty: the chamber is not closed.
std::optional<GasColumn> ReadGasColumn(const CsvTable& table, std::size_t index,
                                       const std::string& chamber) {
  GasColumn column{
      .chamber = chamber, .air_m3 = {}, .fields = {}, .where = table.HeaderWhere(index)};
  bool any = false;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    column.air_m3.push_back(table.OptionalNumber(row, index));
    column.fields.push_back(table.Where(row, index));
    if (!column.air_m3.back()) continue;
    const std::string fault =
        ActuatorFault(*column.air_m3.back(), ActuatorQuantity::kDisplacement, true);
    if (!fault.empty()) table.Refuse(row, index, fault);
    any = true;
  }
  if (!any) return std::nullopt;
  return column;
}

}  // namespace

std::string ActuatorFault(double value, ActuatorQuantity quantity, bool of_chamber) {
  if (quantity == ActuatorQuantity::kTension) {
    if (!of_chamber && value < 0.0) return "a tension is never negative (a cable cannot push)";
    if (of_chamber && value < kVacuum_Pa) {
      return "below a vacuum: pressures count from ambient, the lowest is " +
             FormatNumber(kVacuum_Pa) + " Pa";
    }
    return {};
  }
  if (!of_chamber && std::abs(value) > kLargestDisplacement_m) {
    return "more than " + FormatNumber(kLargestDisplacement_m) +
           " m; metres are expected, are these millimetres?";
  }
  if (of_chamber && std::abs(value) > kLargestVolume_m3) {
    return "more than " + FormatNumber(kLargestVolume_m3) +
           " m3; cubic metres are expected, are these millilitres?";
  }
  return {};
}

std::string ActuatorColumn::Header() const {
  const auto suffix = std::find_if(kSuffixes.begin(), kSuffixes.end(), [&](const Suffix& one) {
    return one.quantity == quantity && one.of_chamber == of_chamber;
  });
  return cable + suffix->text;
}

const ActuatorColumn* Actuation::Find(const std::string& cable, ActuatorQuantity quantity) const {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const ActuatorColumn& column) {
        return column.cable == cable && column.quantity == quantity;
      });
  return found == columns.end() ? nullptr : &*found;
}

double Actuation::ValueAt(const ActuatorColumn& column, double t_s_now) const {
  return InterpolateSamples(t_s, column.samples, t_s_now);
}

Actuation ReadActuation(const std::filesystem::path& file) {
  ActuationWithGas inputs = ReadActuationWithGas(file);
  if (inputs.gas.empty()) return std::move(inputs.actuation);
  const GasColumn& gas = inputs.gas.front();
  throw InputError(gas.where,
                   "an amount of gas is for palpate solve alone; give what was measured: " +
                       gas.chamber + kPressureSuffix + " or " + gas.chamber + kVolumeSuffix);
}

ActuationWithGas ReadActuationWithGas(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Read(file);
  const auto& header = table.header();
  const auto time = std::find(header.begin(), header.end(), "t_s");
  if (time == header.end()) ColumnFinder(table).Require("t_s");
  const auto time_index = static_cast<std::size_t>(time - header.begin());
  if (table.rows() == 0) throw InputError(SourceLocation{table.file(), 2, 1}, "no row of samples");
  if (header.size() == 1)
    throw InputError(table.HeaderWhere(0), "no column for a cable or a chamber");

  ActuationWithGas inputs;
  inputs.actuation.t_s.reserve(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    inputs.actuation.t_s.push_back(RisingTime(table, row, time_index, Rise::kStrict));
  }
  for (std::size_t index = 0; index < header.size(); ++index) {
    if (index == time_index) continue;
    if (const auto chamber = GasOfChamber(table, index)) {
      if (auto gas = ReadGasColumn(table, index, *chamber)) inputs.gas.push_back(std::move(*gas));
    } else if (auto column = ReadColumn(table, index)) {
      inputs.actuation.columns.push_back(std::move(*column));
    }
  }
  return inputs;
}

void CheckActuators(const Actuation& actuation, const std::vector<std::string>& cables,
                    const std::vector<std::string>& chambers) {
  for (const ActuatorColumn& column : actuation.columns) {
    const std::vector<std::string>& names = column.of_chamber ? chambers : cables;
    if (IndexOf(column.cable, names)) continue;
    const std::vector<std::string>& others = column.of_chamber ? cables : chambers;
    const std::string kind = column.of_chamber ? "chamber" : "cable";
    if (IndexOf(column.cable, others)) {
      throw InputError(column.where,
                       "'" + column.cable + "' is no " + kind + " of the robot; its columns are " +
                           column.cable +
                           (column.of_chamber ? kDisplacementSuffix : kPressureSuffix) + " and " +
                           column.cable + (column.of_chamber ? kTensionSuffix : kVolumeSuffix));
    }
    throw InputError(column.where, "the robot has no " + kind + " '" + column.cable + "'" +
                                       DidYouMean(column.cable, names) + "; it has " +
                                       (names.empty() ? "none" : Listed(names)));
  }
}

void WriteActuation(const Actuation& actuation, const std::filesystem::path& file) {
  std::string text = "t_s";
  for (const ActuatorColumn& column : actuation.columns) text += "," + column.Header();
  text += '\n';
  for (std::size_t row = 0; row < actuation.t_s.size(); ++row) {
    text += FormatNumber(actuation.t_s[row]);
    for (const ActuatorColumn& column : actuation.columns) {
      text += ',';
      if (column.samples[row]) text += FormatNumber(*column.samples[row]);
    }
    text += '\n';
  }
  WriteFile(file, text);
}

}  // namespace palpate::experiment

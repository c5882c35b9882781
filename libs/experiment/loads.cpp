// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::experiment {

namespace {

constexpr double kLargestPatchRadius_m = 1.0;

struct LoadColumns {
  explicit LoadColumns(const CsvTable& table) {
    ColumnFinder finder(table);
    time = finder.Require("t_s");
    position = {finder.Require("x_m"), finder.Require("y_m"), finder.Require("z_m")};
    force = {finder.Require("fx_N"), finder.Require("fy_N"), finder.Require("fz_N")};
    patch_radius = finder.Optional("patch_radius_m");
    finder.Finish();
  }

  std::size_t time = 0;
  std::array<std::size_t, 3> position{};
  std::array<std::size_t, 3> force{};
  std::optional<std::size_t> patch_radius;
};

double ReadPatchRadius(const CsvTable& table, std::size_t row, std::size_t column) {
  const double radius_m = table.OptionalNumber(row, column).value_or(0.0);
  if (radius_m < 0.0 || radius_m > kLargestPatchRadius_m) {
    table.Refuse(row, column,
                 "must lie between 0 and " + FormatNumber(kLargestPatchRadius_m) + " m");
  }
  return radius_m;
}

KnownLoad ReadLoad(const CsvTable& table, const LoadColumns& columns, std::size_t row) {
  KnownLoad load;
  load.t_s = RisingTime(table, row, columns.time, Rise::kOrEqual);
  load.where = SourceLocation{table.file(), table.Line(row), 1};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    load.position_m[axis] = table.Number(row, columns.position[i]);
    if (std::abs(load.position_m[axis]) > kLargestCoordinate_m) {
      table.Refuse(row, columns.position[i], "metres are expected, are these millimetres?");
    }
    load.force_N[axis] = table.Number(row, columns.force[i]);
  }
  if (columns.patch_radius) {
    load.patch_radius_m = ReadPatchRadius(table, row, *columns.patch_radius);
  }
  return load;
}

void RefuseSecondLoad(const std::vector<KnownLoad>& loads, const KnownLoad& load) {
  for (auto before = loads.rbegin(); before != loads.rend() && before->t_s == load.t_s; ++before) {
    if (before->position_m == load.position_m) {
      throw InputError(load.where, "a second load at this point and time (the first: line " +
                                       std::to_string(before->where.line) + ")");
    }
  }
}

}  // namespace

std::vector<KnownLoad> ReadLoads(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Read(file);
  const LoadColumns columns(table);
  if (table.rows() == 0) throw InputError(SourceLocation{table.file(), 2, 1}, "no row of loads");
  std::vector<KnownLoad> loads;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const KnownLoad load = ReadLoad(table, columns, row);
    RefuseSecondLoad(loads, load);
    loads.push_back(load);
  }
  return loads;
}

void RequireOnBody(const KnownLoad& load, double distance_m) {
  if (distance_m <= kLargestLoadDistance_m) return;
  std::string place;
  for (const double value : load.position_m) {
    place += (place.empty() ? "" : ", ") + FormatNumber(value);
  }
  const double rounded_m = 1e-4 * std::round(1e4 * distance_m);
  throw InputError(load.where, "the load at (" + place + ") m lies " + FormatNumber(rounded_m) +
                                   " m from the body's surface; at most " +
                                   FormatNumber(kLargestLoadDistance_m) +
                                   " m is allowed: give its place on the undeformed body, in the "
                                   "robot frame and in metres");
}

void WriteLoads(const std::vector<KnownLoad>& loads, const std::filesystem::path& file) {
  std::string text = "t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N,patch_radius_m\n";
  for (const KnownLoad& load : loads) {
    text += FormatNumber(load.t_s);
    for (const double value : load.position_m) text += "," + FormatNumber(value);
    for (const double value : load.force_N) text += "," + FormatNumber(value);
    text += "," + FormatNumber(load.patch_radius_m) + "\n";
  }
  WriteFile(file, text);
}

std::vector<KnownLoad> LoadsAt(const std::vector<KnownLoad>& loads, double t_s) {
  if (loads.empty() || loads.front().t_s == loads.back().t_s) return loads;
  const auto end = std::find_if(loads.begin(), loads.end(),
                                [&](const KnownLoad& load) { return load.t_s > t_s; });
  if (end == loads.begin()) return {};
  const double acting_since_s = std::prev(end)->t_s;
  const auto begin = std::find_if(
      loads.begin(), end, [&](const KnownLoad& load) { return load.t_s == acting_since_s; });
  return {begin, end};
}

}  // namespace palpate::experiment

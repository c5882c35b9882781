// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/experiment/estimated_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"

namespace palpate::view {

namespace {

/// Columns of forces.csv that are shown.
struct ForceColumns {
  explicit ForceColumns(const experiment::CsvTable& table) {
    experiment::ColumnFinder finder(table);
    recording = finder.Require("recording");
    t_s = finder.Require("t_s");
    contact = finder.Require("contact");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      position_m[k] = finder.Require(axis + "_m");
      force_N[k] = finder.Require("f" + axis + "_N");
    }
    ci95_N = finder.Require("ci95_N");
    location_ci95_m = finder.Require("location_ci95_m");
    status = finder.Require("status");
  }

  std::size_t recording, t_s, contact, ci95_N, location_ci95_m, status;
  std::array<std::size_t, 3> position_m, force_N;
};

std::optional<Eigen::Vector3d> VectorAt(const experiment::CsvTable& table, std::size_t row,
                                        const std::array<std::size_t, 3>& columns) {
  Eigen::Vector3d vector;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto number = table.OptionalNumber(row, columns[static_cast<std::size_t>(k)]);
    if (!number) return std::nullopt;
    vector[k] = *number;
  }
  return vector;
}

ShownForce ForceOf(const experiment::CsvTable& table, std::size_t row,
                   const ForceColumns& columns) {
  ShownForce force;
  force.name = table.Text(row, columns.contact);
  force.position_m =
      VectorAt(table, row, columns.position_m).value_or(Eigen::Vector3d::Constant(std::nan("")));
  force.force_N = VectorAt(table, row, columns.force_N);
  force.ci95_N = table.OptionalNumber(row, columns.ci95_N).value_or(0.0);
  force.location_ci95_m = table.OptionalNumber(row, columns.location_ci95_m).value_or(0.0);
  force.status = table.Text(row, columns.status);
  return force;
}

}  // namespace

EstimatedForces EstimatedForces::Read(const std::filesystem::path& file) {
  const auto table = experiment::CsvTable::Read(file);
  const ForceColumns columns(table);
  EstimatedForces forces;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    auto& frames = forces.frames_[std::string(table.Text(row, columns.recording))];
    const double t_s = table.Number(row, columns.t_s);
    if (!frames.empty() && t_s < frames.back().t_s) {
      table.Refuse(row, columns.t_s, "time falls within a recording");
    }
    if (frames.empty() || t_s > frames.back().t_s) frames.push_back({.t_s = t_s, .forces = {}});
    if (table.Text(row, columns.contact).empty()) {
      frames.back().status = table.Text(row, columns.status);
    } else {
      frames.back().forces.push_back(ForceOf(table, row, columns));
    }
  }
  return forces;
}

const EstimatedFrame* EstimatedForces::At(const std::string& recording, double t_s) const {
  const auto frames = frames_.find(recording);
  if (frames == frames_.end()) return nullptr;
  const auto next =
      std::upper_bound(frames->second.begin(), frames->second.end(), t_s,
                       [](double t, const EstimatedFrame& frame) { return t < frame.t_s; });
  return next == frames->second.begin() ? nullptr : &*std::prev(next);
}

}  // namespace palpate::view

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/experiment/force_table.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "libs/core/text.hpp"
#include "libs/experiment/csv_columns.hpp"
#include "libs/experiment/csv_table.hpp"

namespace palpate::experiment {

namespace {

struct ForceTableTuning {
  /// Most negative variance, as a share of the largest, that rounding may leave. Larger: matrices
  /// that are no covariance pass.
  double rounding = 1e-6;
};
constexpr ForceTableTuning kForceTableTuning;

/// Columns of a covariance: `head`, the upper triangle by rows, and `unit`.
std::vector<std::string> CovarianceColumns(const std::string& head, const std::string& unit) {
  std::vector<std::string> names;
  for (const char* axes : {"xx", "xy", "xz", "yy", "yz", "zz"}) {
    names.push_back(head + axes + "_" + unit);
  }
  return names;
}

/// Where they are: empty, or all six.
std::vector<std::size_t> FindCovariance(const CsvTable& table,
                                        const std::vector<std::string>& names,
                                        ColumnFinder* finder) {
  std::vector<std::size_t> columns;
  std::string all;
  for (const std::string& name : names) {
    if (const auto found = finder->Optional(name)) columns.push_back(*found);
    all += (all.empty() ? "" : ", ") + name;
  }
  if (columns.empty() || columns.size() == names.size()) return columns;
  throw InputError(
      table.HeaderWhere(columns.front()),
      "a covariance has all of the columns " + all + ", or none; here some are missing");
}

/// Where each column is in the table.
struct ForceColumns {
  explicit ForceColumns(const CsvTable& table) {
    ColumnFinder finder(table);
    t_s = finder.Require("t_s");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      position_m[k] = finder.Require(axis + "_m");
      force_N[k] = finder.Require("f" + axis + "_N");
    }
    recording = finder.Optional("recording");
    contact = finder.Optional("contact");
    ci95_N = finder.Optional("ci95_N");
    location_ci95_m = finder.Optional("location_ci95_m");
    status = finder.Optional("status");
    covariance_N2 = FindCovariance(table, CovarianceColumns("cov_", "N2"), &finder);
    location_covariance_m2 =
        FindCovariance(table, CovarianceColumns("location_cov_", "m2"), &finder);
  }

  bool Has(std::size_t column) const {
    const auto is = [column](const std::optional<std::size_t>& other) { return other == column; };
    const auto in = [column](const auto& list) {
      return std::find(list.begin(), list.end(), column) != list.end();
    };
    return column == t_s || in(position_m) || in(force_N) || in(covariance_N2) ||
           in(location_covariance_m2) || is(recording) || is(contact) || is(ci95_N) ||
           is(location_ci95_m) || is(status);
  }

  std::size_t t_s;
  std::array<std::size_t, 3> position_m, force_N;
  std::optional<std::size_t> recording, contact, ci95_N, location_ci95_m, status;
  std::vector<std::size_t> covariance_N2, location_covariance_m2;  ///< empty, or six
};

/// The numbers of some fields, nullopt where all are empty.
template <typename Columns>
std::optional<std::vector<double>> NumbersAt(const CsvTable& table, std::size_t row,
                                             const Columns& columns) {
  std::vector<double> numbers;
  std::optional<std::size_t> missing;
  for (const std::size_t column : columns) {
    const auto number = table.OptionalSample(row, column);
    if (number) numbers.push_back(*number);
    if (!number) missing = column;
  }
  if (numbers.empty()) return std::nullopt;
  if (missing) table.Refuse(row, *missing, "is missing, and the others of the vector are not");
  return numbers;
}

std::optional<Eigen::Vector3d> VectorAt(const CsvTable& table, std::size_t row,
                                        const std::array<std::size_t, 3>& columns) {
  const auto numbers = NumbersAt(table, row, columns);
  if (!numbers) return std::nullopt;
  return Eigen::Vector3d(numbers->data());
}

std::optional<Eigen::Matrix3d> CovarianceAt(const CsvTable& table, std::size_t row,
                                            const std::vector<std::size_t>& columns,
                                            const std::string& unit) {
  if (columns.empty()) return std::nullopt;
  const auto numbers = NumbersAt(table, row, columns);
  if (!numbers) return std::nullopt;
  Eigen::Matrix3d covariance;
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = i; j < 3; ++j) {
      covariance(i, j) = covariance(j, i) = (*numbers)[k++];
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& variances = eigen.eigenvalues();
  if (variances[0] < -kForceTableTuning.rounding * std::max(0.0, variances[2]) ||
      variances[2] < 0.0) {
    table.Refuse(row, columns.front(),
                 "no covariance: along some direction its variance is " +
                     FormatNumber(variances[0]) + " " + unit + ", and none may be negative");
  }
  return covariance;
}

std::optional<double> HalfWidthAt(const CsvTable& table, std::size_t row,
                                  std::optional<std::size_t> column) {
  if (!column) return std::nullopt;
  const auto width = table.OptionalSample(row, *column);
  if (width && *width < 0.0) table.Refuse(row, *column, "must be 0 or more");
  return width;
}

std::string TextAt(const CsvTable& table, std::size_t row, std::optional<std::size_t> column,
                   const char* otherwise) {
  return column ? std::string(table.Text(row, *column)) : otherwise;
}

TabledForce RowAt(const CsvTable& table, std::size_t row, const ForceColumns& columns) {
  TabledForce read;
  read.recording = TextAt(table, row, columns.recording, "");
  read.t_s = table.Number(row, columns.t_s);
  read.contact = TextAt(table, row, columns.contact, "");
  read.position_m = VectorAt(table, row, columns.position_m);
  read.force_N = VectorAt(table, row, columns.force_N);
  read.ci95_N = HalfWidthAt(table, row, columns.ci95_N);
  read.location_ci95_m = HalfWidthAt(table, row, columns.location_ci95_m);
  read.status = TextAt(table, row, columns.status, "ok");
  read.covariance_N2 = CovarianceAt(table, row, columns.covariance_N2, "N2");
  read.location_covariance_m2 = CovarianceAt(table, row, columns.location_covariance_m2, "m2");
  read.where = table.Where(row, columns.t_s);
  if (read.force_N && !read.position_m) {
    table.Refuse(row, columns.position_m[0], "a force needs its place");
  }
  return read;
}

}  // namespace

ForceTable ReadForceTable(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Read(file);
  const ForceColumns columns(table);
  ForceTable read;
  for (std::size_t column = 0; column < table.header().size(); ++column) {
    if (!columns.Has(column)) read.unused.push_back(table.header()[column]);
  }
  struct Last {
    double t_s = 0.0;
    int count = 0;  ///< rows of that time
  };
  std::map<std::string, Last> last;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    TabledForce force = RowAt(table, row, columns);
    const auto [before, is_new] = last.try_emplace(force.recording, Last{force.t_s, 0});
    if (!is_new && force.t_s < before->second.t_s) {
      table.Refuse(row, columns.t_s, "time falls within a recording");
    }
    if (force.t_s > before->second.t_s) before->second = {force.t_s, 0};
    const int count = ++before->second.count;
    if (force.contact.empty() && force.position_m) force.contact = std::to_string(count);
    read.rows.push_back(std::move(force));
  }
  return read;
}

}  // namespace palpate::experiment

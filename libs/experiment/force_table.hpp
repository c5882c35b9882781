// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate::experiment {

/// A row of a table of forces: a force at one time, or, without a contact, a word about a frame.
struct TabledForce {
  std::string recording;  ///< empty where the table has no such column
  double t_s = 0.0;
  std::string contact;  ///< name; empty: the row is about the frame
  /// Where the force acts, robot frame; nullopt: empty fields.
  std::optional<Eigen::Vector3d> position_m;
  std::optional<Eigen::Vector3d> force_N;  ///< on the robot, robot frame; nullopt: not determined
  std::optional<double> ci95_N;            ///< half-width of the 95 % interval of |F|, >= 0
  std::optional<double> location_ci95_m;   ///< >= 0
  std::string status;                      ///< "ok" where the table has no such column
  /// Of force_N and of position_m; symmetric, no negative variance.
  std::optional<Eigen::Matrix3d> covariance_N2, location_covariance_m2;
  SourceLocation where;
};

struct ForceTable {
  std::vector<TabledForce> rows;    ///< times never fall within a recording
  std::vector<std::string> unused;  ///< other columns
};

/// Reads forces.csv (docs/experiment.md): the columns t_s, x_m, y_m, z_m, fx_N, fy_N, fz_N, and any
/// of recording, contact, ci95_N, location_ci95_m, status and the six of each covariance, in any
/// order. Contacts without a name are 1, 2, ... in the order of the rows of one time. Throws
/// InputError with file:line:column, also for a vector that is empty in part, and a covariance that
/// is none.
ForceTable ReadForceTable(const std::filesystem::path& file);

}  // namespace palpate::experiment

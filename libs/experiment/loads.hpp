// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate::experiment {

/// A known external load: a dead load at the named point of the undeformed body, acting on the
/// robot.
struct KnownLoad {
  double t_s = 0.0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< robot frame
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();     ///< robot frame
  double patch_radius_m = 0.0;  ///< >= 0; spread over the surface within; 0: that point alone
  SourceLocation where;
};

/// Reads loads.csv (t_s,x_m,y_m,z_m,fx_N,fy_N,fz_N[,patch_radius_m]; rows of equal time act
/// together; an empty patch_radius_m is 0, no other field may be empty). At least one row, time
/// never falls. Throws InputError with file:line:column as ReadMarkers does, and for two loads at
/// one point at one time.
std::vector<KnownLoad> ReadLoads(const std::filesystem::path& file);

/// Largest distance of a known load from the body's surface. Larger accepts places that are
/// measured less well; smaller finds a wrong frame or unit sooner.
inline constexpr double kLargestLoadDistance_m = 0.02;

/// Refuses a load that lies `distance_m` from the surface of the undeformed body, if that is
/// farther than kLargestLoadDistance_m: InputError at its line of loads.csv, with place, rule and
/// remedy.
void RequireOnBody(const KnownLoad& load, double distance_m);

/// Writes what ReadLoads reads back exactly. Throws RunError where it cannot.
void WriteLoads(const std::vector<KnownLoad>& loads, const std::filesystem::path& file);

/// The loads that act at `t_s`: those of the last time not after it. Where all rows have one time
/// they act throughout; else none acts before the first row.
std::vector<KnownLoad> LoadsAt(const std::vector<KnownLoad>& loads, double t_s);

}  // namespace palpate::experiment

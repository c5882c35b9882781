// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libs/experiment/loads.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::command {

/// Times of options are on the clock of the file.
struct ImportOptions {
  std::filesystem::path file;   ///< .c3d, or .csv with time_s|t_s, marker, x_m, y_m, z_m columns
  std::filesystem::path out;    ///< experiment folder, or, without `recording`, the recording's own
  std::string recording;        ///< name of the recording in the experiment
  std::filesystem::path robot;  ///< file or name; its markers are the only ones allowed
  std::string kind = "free";    ///< `kind` of recording.yaml
  std::string notes;            ///< `notes` of recording.yaml
  std::vector<std::string> loads;  ///< "x,y,z[,radius]: fx,fy,fz" of loads.csv

  std::vector<std::string> rename;  ///< "Tip-1=tip_top": name in the file, new name
  std::string markers;              ///< "a,b,c": keep only these; empty: all
  std::string axes;                 ///< "z,-y,x": model axes from the file's; empty: as they are
  std::string unit;                 ///< m, cm or mm, for a C3D file without a unit

  double from_s = -std::numeric_limits<double>::infinity();
  double to_s = std::numeric_limits<double>::infinity();
  double rate_Hz = 0.0;             ///< frames a second to keep; 0: all
  double time_offset_s = 0.0;       ///< added to all times (an experiment has one clock)
  std::string rest_window;          ///< "T0:T1", `reference.window_s`; empty: none
  std::string rest_shape = "auto";  ///< auto (equilibrium), undeformed or equilibrium
  std::string steady_window;        ///< "T0:T1", `steady_window_s`; empty: none

  std::string frame;               ///< robot or camera; empty: robot with `axes` alone, else camera
  std::string pose;                ///< T_robot_camera as "x,y,z,qx,qy,qz,qw"; empty: unknown
  bool register_to_robot = false;  ///< estimate T_robot_camera from the rest window's means
  std::string register_markers;    ///< "a,b,c": those to register; empty: all that are kept
  double markers_sigma_m = 0.0;    ///< for a new experiment.yaml; 0: as the capture shows it
};

/// Values of options. Each throws InputError with the option and the form that is expected.
std::vector<std::string> SplitNames(const std::string& text, char separator = ',');
std::optional<experiment::TimeWindow> ParseWindow(const std::string& option,
                                                  const std::string& text);
std::optional<Eigen::Isometry3d> ParsePose(const std::string& text);
/// Loads that act all the time, from `t_s` on.
std::vector<experiment::KnownLoad> ParseLoads(const std::vector<std::string>& loads, double t_s);
/// Name in the file -> new name.
std::map<std::string, std::string> ParseRenames(const std::vector<std::string>& renames);

}  // namespace palpate::command

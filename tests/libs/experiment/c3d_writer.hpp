// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libs/experiment/c3d/c3d_bytes.hpp"

namespace palpate::experiment {

/// What a test wants to stand in a C3D file. Points are in file units.
struct C3dContent {
  struct Point {
    double x = 0.0, y = 0.0, z = 0.0;
    int residual_steps = 0;  ///< 0..255
    int cameras = 0;         ///< 0..127
    bool seen = true;
  };

  C3dProcessor processor = C3dProcessor::kIntel;
  bool real_points = true;
  double scale = 0.01;
  double rate_Hz = 50.0;
  int first_frame = 1;
  std::optional<std::string> unit = "mm";
  std::vector<std::string> labels;
  std::size_t labels_in_one_parameter = 255;
  std::size_t analog_values_per_frame = 0;
  bool trial_fields = false;        ///< TRIAL:ACTUAL_START_FIELD and _END_FIELD
  bool long_frames = false;         ///< POINT:LONG_FRAMES
  bool data_start_is_zero = false;  ///< POINT:DATA_START
  bool last_link_leads_nowhere = false;
  bool point_group_is_named = true;      ///< its record is there
  std::vector<std::string> angles;       ///< POINT:ANGLES, in deg, and POINT:TYPE_GROUPS
  std::vector<std::string> type_groups;  ///< POINT:TYPE_GROUPS where `angles` is empty
  std::string power_unit;                ///< POINT:POWER_UNITS
  /// A parameter PROCESSING:MASS for each, in a group of its own of that name.
  std::vector<double> processing;
  std::vector<std::vector<Point>> frames;  ///< [frame][label]
};

/// The bytes of the file.
std::string WriteC3d(const C3dContent& content);

}  // namespace palpate::experiment

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "libs/experiment/csv_table.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::experiment {

/// Where a table of one row for each time and marker keeps what, and in which units.
struct MarkerColumns {
  std::size_t time = 0;  ///< s
  std::size_t marker = 0;
  std::array<std::size_t, 3> position{};
  std::array<double, 3> metres_per_unit{1.0, 1.0, 1.0};
  std::optional<std::size_t> residual;
  double residual_metres_per_unit = 1.0;
};

/// Residual of each marker of each frame, m: [frame][marker], as MarkerTracks::positions_m.
using Residuals = std::vector<std::vector<std::optional<double>>>;

struct MarkerTable {
  MarkerTracks tracks;
  Residuals residuals_m;  ///< empty where the table has none
};

/// Groups the rows to frames. Throws InputError as ReadMarkers does. A negative residual says that
/// the marker was not seen, as in C3D files; so do coordinates that are NaN.
MarkerTable ReadMarkerTable(const CsvTable& table, const MarkerColumns& columns);

}  // namespace palpate::experiment

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libs/core/error.hpp"

namespace palpate::experiment {

/// From begin_s to end_s, both included; begin_s < end_s.
struct TimeWindow {
  double begin_s = 0.0;
  double end_s = 0.0;

  bool Contains(double t_s) const { return t_s >= begin_s && t_s <= end_s; }
};

/// Positions of the markers at one time.
struct MarkerFrame {
  double t_s = 0.0;
  /// One for each of MarkerTracks::names, in that order; m, measurement frame (experiment.hpp,
  /// RobotFromMarkers). nullopt: not seen.
  std::vector<std::optional<Eigen::Vector3d>> positions_m;
  int line = 0;  ///< of the file where the frame begins; 0 where it is from no text file
};

/// Prefix of the names of points without a name, followed by a number; no marker has such a name.
inline constexpr std::string_view kUnlabelledPrefix = "unlabelled_";

/// Whether the point has no name, so that its marker is unknown.
inline bool IsUnlabelled(std::string_view name) { return name.starts_with(kUnlabelledPrefix); }

/// Named markers over time (markers.csv).
struct MarkerTracks {
  std::vector<std::string> names;           ///< in the order of their first rows, all different
  std::vector<SourceLocation> names_where;  ///< where each was named first
  std::vector<MarkerFrame> frames;          ///< time strictly rising, at least one

  std::optional<std::size_t> IndexOf(const std::string& name) const;
};

/// Coordinates beyond this are taken for a wrong unit and refused.
inline constexpr double kLargestCoordinate_m = 50.0;

/// Reads markers.csv (t_s,marker,x_m,y_m,z_m; rows of equal time are one frame; x, y and z empty:
/// not seen; no name: the points of each time without one are called unlabelled_1, unlabelled_2,
/// ... as they come, and are not followed from time to time). Throws InputError with
/// file:line:column for an unknown, missing, doubled or wrongly scaled column, a wrong number of
/// fields, what is no finite number, falling time, a marker given twice in a frame, a position with
/// one or two coordinates, a file without a row.
MarkerTracks ReadMarkers(const std::filesystem::path& file);

/// Writes what ReadMarkers reads back exactly. Throws RunError where it cannot.
void WriteMarkers(const MarkerTracks& markers, const std::filesystem::path& file);

/// The same positions, mapped: p_target = T_target_source * p_source.
MarkerTracks Transformed(const MarkerTracks& markers, const Eigen::Isometry3d& T_target_source);

/// A marker averaged over a time window.
struct MarkerMean {
  int count = 0;                                     ///< frames that saw it
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();  ///< valid where count > 0
  /// Standard deviation of one sample about a straight line in time (so that creep does not count
  /// as noise), for each axis; valid where count > 2.
  Eigen::Vector3d deviation_m = Eigen::Vector3d::Zero();
};

/// One for each of `markers.names`, over the frames inside the window.
std::vector<MarkerMean> MeanOver(const MarkerTracks& markers, const TimeWindow& window);

}  // namespace palpate::experiment

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "libs/geometry/rigid_transform.hpp"

namespace palpate::calibration {

/// A mistake in data or settings that explains data which do not fit.
struct MisfitReason {
  enum class Kind {
    kLabels,
    kPose,
    kMirrored,
    kUnit,
    kSize,
    kModulus,
    kRecording,
    kIntrinsics,
    kRobot
  };
  Kind kind = Kind::kPose;
  std::string text;       ///< what is wrong, by how much, and the remedy
  double residual = 0.0;  ///< once it is mended, as MisfitReasons::residual
};

struct MisfitReasons {
  /// Of the data as they are: RMS distance of registered markers, m, or the share of the robot's
  /// visible surface that a depth image contradicts.
  double residual = 0.0;
  std::vector<MisfitReason> reasons;  ///< those that explain the misfit, the best first
  std::string where_none;             ///< what remains where no reason explains it
  std::string not_excluded;           ///< what was not tested

  void SortBestFirst();
  /// One line for each, and what was not tested.
  std::string Text() const;
};

/// As std::snprintf.
template <typename... Values>
std::string FormatReason(const char* format, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

/// "millimetres" where a length of one metre is given as `ratio`, nearly; nullopt: no such unit.
std::optional<std::string> UnitOfRatio(double ratio);

/// A turn near one that takes axes to axes, "y up" and the like: how the measured axes are the
/// robot's. nullopt for other turns, and for none.
std::optional<std::string> AxesText(const Eigen::Quaterniond& turn);

/// By how much a pose is off at a place of the measurement.
struct PoseDifference {
  double off_m = 0.0;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< from the given to the found pose

  double turned_rad() const { return Eigen::AngleAxisd(turn).angle(); }
  std::string Text() const;  ///< "43.0 mm and 12.0 degrees off"
};
PoseDifference DifferenceOf(const geometry::RigidTransform& given,
                            const geometry::RigidTransform& found,
                            const Eigen::Vector3d& place_measured_m);

}  // namespace palpate::calibration

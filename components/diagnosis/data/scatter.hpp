// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "libs/experiment/markers.hpp"

namespace palpate::diagnosis {

/// By how much single frames of markers vary about a straight line in time: their noise, whatever
/// goes slowly left out.
class Scatter {
 public:
  /// Frames of one window, in order.
  void Add(const std::vector<const experiment::MarkerFrame*>& frames);

  /// m, of one frame, for each axis. What was measured counts where it is more than `stated`, or
  /// where nothing is stated; where too little was seen, what is stated, else 1 um.
  Eigen::Vector3d Sigma_m(const std::optional<Eigen::Vector3d>& stated) const;
  /// NaN where too little was seen.
  Eigen::Vector3d Measured_m() const;

 private:
  Eigen::Array3d squares_m2_ = Eigen::Array3d::Zero();
  double freedom_ = 0.0;
};

}  // namespace palpate::diagnosis

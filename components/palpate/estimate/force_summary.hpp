// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "components/force_estimation/marker_force_estimator.hpp"
#include "libs/experiment/loads.hpp"
#include "libs/experiment/markers.hpp"

namespace palpate::command {

/// Summary of one recording: the number of frames of each status with its reason, and the median
/// force at each contact over the static phase (the whole recording where none is given).
class ForceSummary {
 public:
  /// `loads`: known loads of the recording, shown beside the contacts at their places.
  ForceSummary(std::string recording, std::optional<experiment::TimeWindow> steady_window_s,
               std::vector<experiment::KnownLoad> loads = {});

  void Add(const force_estimation::ForceEstimate& estimate);

  /// Median over the frames in which the force was estimated; none: count 0.
  struct Contact {
    int count = 0;
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< of each component
    double magnitude_N = 0.0;
    double ci95_N = 0.0;
    std::string status;             ///< the most frequent
    std::optional<double> known_N;  ///< size of the known load at this contact
  };
  Contact MedianOf(const std::string& contact) const;
  std::vector<std::string> Contacts() const;

  /// Lines of text, each with its line end.
  std::string ToText() const;
  nlohmann::ordered_json ToJson() const;

 private:
  struct Samples {
    std::vector<double> x_N, y_N, z_N, magnitude_N, ci95_N, known_N;
    std::map<std::string, int> statuses;
  };

  std::string recording_;
  std::optional<experiment::TimeWindow> window_s_;
  std::vector<experiment::KnownLoad> loads_;
  std::map<std::string, int> statuses_;         // of frames
  std::map<std::string, std::string> reasons_;  // the first of each status
  std::map<std::string, Samples> contacts_;
};

}  // namespace palpate::command

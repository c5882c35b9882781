// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace palpate::view {

/// A force at one time: measured, estimated or declared. Robot frame.
struct ShownForce {
  std::string name;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< on the deformed body
  std::optional<Eigen::Vector3d> force_N;                ///< nullopt: not determined
  /// Of force_N; zero: exact, as it was declared; NaN: unknown.
  Eigen::Matrix3d covariance_N2 = Eigen::Matrix3d::Zero();
  double ci95_N = 0.0;
  double location_ci95_m = 0.0;
  Eigen::Matrix3d location_covariance_m2 = Eigen::Matrix3d::Zero();  ///< as covariance_N2
  std::string status = "ok";
  std::string reason = {};  ///< for a person; "known load" where it was declared
};

/// The estimate of one frame.
struct EstimatedFrame {
  double t_s = 0.0;
  std::string status = "ok";  ///< of the frame
  std::vector<ShownForce> forces;
};

/// forces.csv of `palpate estimate` (docs/experiment.md), by recording, in the order of its rows.
class EstimatedForces {
 public:
  /// Throws InputError with file:line:column.
  static EstimatedForces Read(const std::filesystem::path& file);

  /// The newest frame of that recording not after `t_s`; null where there is none.
  const EstimatedFrame* At(const std::string& recording, double t_s) const;

 private:
  std::map<std::string, std::vector<EstimatedFrame>> frames_;
};

}  // namespace palpate::view

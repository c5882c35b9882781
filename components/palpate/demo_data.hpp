// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

namespace palpate::command {

/// The data of the demonstration: a beam under its own weight in one recording and with a known
/// weight in another.
struct DemoData {
  std::string description;  ///< one line: where it comes from
  std::filesystem::path experiment;
  std::string self_weight;  ///< recording to calibrate on
  std::string hung_weight;  ///< recording to estimate in
  std::string contact;      ///< where the weight hangs, as force_estimation's setting `contacts`
  double marker_bias_m = 0.0;
  Eigen::Vector3d true_force_N = Eigen::Vector3d::Zero();
  double true_force_uncertainty = 0.0;  ///< relative, of the truth itself
};

/// The folder with the measured beam, or nullopt: `given` if not empty, else PALPATE_DATA_DIR, else
/// ../shared/data from here or from the project. Throws InputError where `given` does not hold it.
std::optional<std::filesystem::path> FindMeasuredData(const std::filesystem::path& given);

/// Imports the motion-capture files of the measured beam into `folder`/experiment (created
/// again); the output of `palpate import` goes to `folder`/import.log. Throws InputError, RunError.
DemoData ImportMeasuredBeam(const std::filesystem::path& data, const std::filesystem::path& folder);

/// The small data set that comes with palpate, computed by CalculiX. Throws InputError where it is
/// not there.
DemoData ComputedBeam();

}  // namespace palpate::command

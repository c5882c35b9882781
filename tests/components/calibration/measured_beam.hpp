// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/experiment/capture_edit.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/geometry/rigid_registration.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/support/measured_data.hpp"

namespace palpate::calibration {

inline constexpr double kHandHeld_m = 1e-3;  ///< what the hand-held start is good to

/// Dubied et al., RA-L 2022 (measured data; not part of the project).
inline std::filesystem::path BeamFolder() {
  return test_support::MeasuredDataFolder() / "silicone_beam";
}

/// Means of the tip markers in the robot frame, registered by where all six markers were while the
/// tip was held level by hand.
struct BeamTip {
  std::vector<experiment::MarkerMean> held;
  std::vector<experiment::MarkerMean> settled;  ///< over the last half second
};

inline BeamTip TipOf(const std::string& file, double released_s) {
  experiment::CapturedMarkers captured = experiment::ReadCapturedCsv(BeamFolder() / file);
  experiment::Rotate(experiment::ParseAxes("z,-y,x"), captured);
  experiment::KeepMarkers({"Tip-1", "Tip-2", "Tip-3", "Base-1", "Base-2", "Base-3"}, captured);
  Eigen::Matrix3Xd nominal_m(3, 6);
  nominal_m << 0.0, 0.0, 0.0, -0.094, -0.094, -0.094,  //
      0.015, -0.006, 0.036, -0.01, 0.04, 0.04,         //
      0.036, 0.024, 0.006, -0.001, 0.0275, 0.0;
  BeamTip tip;
  tip.held = experiment::MeanOver(captured.tracks, {0.0, 0.5 * released_s});
  Eigen::Matrix3Xd held_m(3, 6);
  for (size_t m = 0; m < 6; ++m) held_m.col(static_cast<Eigen::Index>(m)) = tip.held[m].mean_m;
  const geometry::Registration registration = geometry::RegisterRigid(held_m, nominal_m);
  EXPECT_TRUE(registration.status.ok());
  EXPECT_LT(registration.rms_m, 3e-3);
  const double end_s = captured.tracks.frames.back().t_s;
  tip.settled = experiment::MeanOver(captured.tracks, {end_s - 0.5, end_s});
  for (auto* means : {&tip.held, &tip.settled}) {
    means->resize(3);
    for (experiment::MarkerMean& mean : *means) {
      const Eigen::Matrix3Xd point_m = mean.mean_m;
      mean.mean_m = registration.T_target_source.Apply(point_m);
    }
  }
  return tip;
}

inline std::unique_ptr<robot::RobotModel> Beam() {
  return std::make_unique<robot::RobotModel>(robot::BuildRobotBody(robot::ReadRobotFile(
      std::filesystem::path(PALPATE_SOURCE_DIR) / "config/robots/beam.yaml", app::LoadYaml)));
}

}  // namespace palpate::calibration

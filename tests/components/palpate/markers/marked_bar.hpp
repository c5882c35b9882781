// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_model.hpp"
#include "tests/components/palpate/test_robot.hpp"

namespace palpate::command {

/// How a run of the program ended.
struct ProgramRun {
  int exit_code = -1;
  std::string output;  ///< of both streams
};

/// What is seen of the bar in one recording.
struct BarSight {
  std::string name = {};
  double commanded_m = 0.0;
  std::vector<int> markers = {};              ///< which are seen; empty: all
  bool names = true;                          ///< else the points have none, in random order
  std::vector<Eigen::Vector3d> false_m = {};  ///< points that are none, camera frame
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> spoil = {};  ///< camera frame
  double load_N = 0.0;                                                ///< a weight at the tip
  bool tell_load = true;                                              ///< in loads.csv
  std::string kind = "hold";
};

/// A bar with one cable, whose drive counts from 0.7 mm in, and twelve markers before a camera;
/// `palpate` itself is run on recordings of it.
class MarkedBar : public testing::Test {
 protected:
  MarkedBar();

  using Points = std::vector<std::pair<std::string, Eigen::Vector3d>>;  ///< name, camera frame

  Points See(const BarSight& sight);
  /// recording.yaml and actuation.csv.
  void WriteInputs(const BarSight& sight) const;
  /// Of the truth, whatever `robot_` says later.
  void Record(const BarSight& sight);
  /// Three settings of the cable, seen alike.
  void RecordThree(BarSight sight);
  /// The robot file with the markers at these places.
  std::filesystem::path WriteRobot(const std::vector<Eigen::Vector3d>& markers_m,
                                   const std::string& name = "bar.yaml") const;

  /// Writes experiment.yaml with this camera pose and `more` keys inside it.
  void TellPose(const Eigen::Isometry3d& T_robot_camera, const std::string& error = "") const;
  /// The robot file, and the truth as well where `truth` is set, with `old` replaced by `by`.
  void ChangeRobot(const std::string& old, const std::string& by, bool truth);
  /// `palpate WORDS...`
  ProgramRun Run(std::vector<std::string> words) const;
  /// `palpate calibrate` on what was recorded.
  ProgramRun Calibrate(std::vector<std::string> more = {}) const;
  robot::CalibrationFile Found() const;
  bool HasFile() const { return std::filesystem::exists(folder_ / "calibration.yaml"); }
  /// Exit code 1 with a reason and no file.
  void ExpectFailure(const ProgramRun& run, const std::string& reason) const;
  /// Where the camera is found to be within its errors.
  void ExpectPose(double most_m = 1e-3) const;

  static const std::vector<Eigen::Vector3d>& Twelve();
  static constexpr double kOffset_m = 7e-4;
  static constexpr double kNoise_m = 1e-4;

  TestFolder folder_;
  std::filesystem::path robot_;
  std::unique_ptr<robot::RobotModel> truth_;
  std::mt19937 random_{20261122};
  Eigen::Isometry3d T_robot_camera_ =
      Eigen::Translation3d(0.3, -0.2, 0.4) *
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.8, 0.5).normalized());
};

}  // namespace palpate::command

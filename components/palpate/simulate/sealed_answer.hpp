// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/scenario/effect.hpp"

namespace palpate::command {

/// The true forces at one moment.
struct TrueForces {
  double t_s = 0.0;
  std::vector<virtual_robot::TrueForce> forces;
};

struct RecordingTruth {
  std::string name;
  /// Where the depth camera really was; meaningless without one.
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  std::vector<TrueForces> frames;
};

/// What whoever diagnoses the experiment is to find, and the judge opens afterwards.
struct Answer {
  std::string salt;  ///< NewSalt: nobody finds the answer by trying effects until the hash fits
  std::uint64_t seed = 0;
  std::string version;       ///< of palpate
  std::string robot;         ///< name in the robot file
  std::string robot_sha256;  ///< of the robot file
  std::string scenario;      ///< name in the scenario file
  std::string scenario_sha256;
  std::string mesh_hash;  ///< of the true body
  bool camera = false;
  std::vector<scenario::ActiveEffect> effects;
  std::vector<RecordingTruth> recordings;
  std::string data_sha256;  ///< HashOfData of the experiment that it belongs to
};

/// 64 hexadecimal digits from the machine's source of randomness.
std::string NewSalt();

/// The answer as the bytes of its file: JSON.
std::string FormatAnswer(const Answer& answer);

/// Of all files below recordings/, names and contents: the measured data.
std::string HashOfData(const std::filesystem::path& experiment);

/// EXP -> EXP.answer.json beside it.
std::filesystem::path AnswerBeside(const std::filesystem::path& experiment);

/// Throws InputError where the experiment holds no seal or the answer cannot be read, RunError
/// where the answer is not the one that was sealed, or the data are not those that it was sealed
/// with.
void CheckSeal(const std::filesystem::path& experiment, const std::filesystem::path& answer);

}  // namespace palpate::command

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

/// The true forces at one time.
struct TrueForces {
  double t_s = 0.0;
  std::vector<virtual_robot::TrueForce> forces;
};

struct RecordingTruth {
  std::string name;
  /// The true pose of the depth camera; meaningless without a camera.
  Eigen::Isometry3d T_robot_camera = Eigen::Isometry3d::Identity();
  std::vector<TrueForces> frames;
};

/// The ground truth of an experiment: hidden effects, true forces and camera poses.
struct Answer {
  std::string salt;  ///< NewSalt: guessed effects cannot be checked against the hash
  std::uint64_t seed = 0;
  std::string version;       ///< of palpate
  std::string robot;         ///< name in the robot file
  std::string robot_sha256;  ///< of the robot file
  std::string scenario;      ///< name in the scenario file
  std::string scenario_sha256;
  std::string mesh_hash;  ///< of the simulated body
  bool camera = false;
  std::vector<scenario::ActiveEffect> effects;
  std::vector<RecordingTruth> recordings;
  std::string data_sha256;  ///< HashOfData of the experiment that it belongs to
};

/// 64 hexadecimal digits from the operating system's random source.
std::string NewSalt();

/// The bytes of the answer's file: JSON.
std::string FormatAnswer(const Answer& answer);

/// The recordings of a file that FormatAnswer wrote, with their true forces. Throws InputError
/// where it cannot be read or is something else.
std::vector<RecordingTruth> ReadRecordingTruths(const std::filesystem::path& answer);

/// Of all files below recordings/, names and contents: the measured data.
std::string HashOfData(const std::filesystem::path& experiment);

/// EXP -> EXP.answer.json beside it.
std::filesystem::path AnswerBeside(const std::filesystem::path& experiment);

/// Throws InputError where experiment.yaml has no answer_sha256 or the answer cannot be read,
/// RunError where its hash differs, or the recordings have changed.
void CheckSeal(const std::filesystem::path& experiment, const std::filesystem::path& answer);

}  // namespace palpate::command

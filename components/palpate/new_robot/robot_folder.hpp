// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/palpate/new_robot/rehearsal.hpp"
#include "components/palpate/new_robot/robot_draft.hpp"

namespace palpate::command {

/// The folder of a new robot and its files.
struct RobotFolder {
  std::filesystem::path folder;
  std::filesystem::path robot;        ///< robot.yaml
  std::filesystem::path mesh;         ///< a copy, or the mesh file itself where it is in the folder
  std::filesystem::path picture;      ///< robot.png
  std::filesystem::path actuation;    ///< actuation.csv, with cables
  std::filesystem::path scenario;     ///< rehearsal.yaml
  std::filesystem::path system;       ///< live.yaml
  std::filesystem::path calibration;  ///< calibration.yaml, which palpate calibrate writes
};

/// The files of a new robot in a folder of any name.
RobotFolder NameFiles(const std::filesystem::path& folder, const std::filesystem::path& mesh);

/// Throws InputError where one of the files is there and `force` is false, and where the folder
/// cannot be written. The mesh itself is never replaced by another one.
void RefuseExisting(const RobotFolder& files, const std::filesystem::path& mesh, bool force);

/// Copies the mesh and writes robot file, scenario, system file and actuation. Throws RunError.
void WriteRobotFolder(const RobotDraft& draft, const Rehearsal& rehearsal,
                      const RobotFolder& files);

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/robot_folder.hpp"

#include <system_error>

#include "components/palpate/check_output.hpp"
#include "components/palpate/new_robot/robot_text.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/experiment/folders.hpp"

namespace palpate::command {

namespace fs = std::filesystem;

RobotFolder NameFiles(const fs::path& folder, const fs::path& mesh) {
  return {.folder = folder,
          .robot = folder / "robot.yaml",
          .mesh = folder / mesh.filename(),
          .picture = folder / "robot.png",
          .actuation = folder / "actuation.csv",
          .scenario = folder / "rehearsal.yaml",
          .system = folder / "live.yaml",
          .calibration = folder / "calibration.yaml"};
}

void RefuseExisting(const RobotFolder& files, const fs::path& mesh, bool force) {
  CheckOutputFolder(files.folder);
  std::error_code error;
  for (const fs::path& file :
       {files.robot, files.picture, files.actuation, files.scenario, files.system}) {
    if (!fs::exists(file, error) || force) continue;
    throw InputError(SourceLocation{file.string()},
                     "exists already; --force replaces it, --out FOLDER writes elsewhere");
  }
  const bool other_mesh = fs::exists(files.mesh, error) &&
                          !fs::equivalent(files.mesh, mesh, error) &&
                          ReadFile(files.mesh) != ReadFile(mesh);
  if (other_mesh && !force) {
    throw InputError(SourceLocation{files.mesh.string()},
                     "is another mesh of this name; --force replaces it, --out FOLDER writes "
                     "elsewhere");
  }
}

void WriteRobotFolder(const RobotDraft& draft, const Rehearsal& rehearsal,
                      const RobotFolder& files) {
  experiment::CreateFolder(files.folder);
  std::error_code error;
  if (!fs::equivalent(files.mesh, draft.description.mesh.file, error)) {
    WriteFile(files.mesh, ReadFile(draft.description.mesh.file));
  }
  WriteFile(files.robot, FormatNewRobot(draft, files.mesh.filename().string()));
  WriteFile(files.scenario, rehearsal.scenario);
  WriteFile(files.system, rehearsal.system);
  if (!rehearsal.actuation.empty()) WriteFile(files.actuation, rehearsal.actuation);
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "components/palpate/compare/live_comparison.hpp"
#include "components/view/picture/scene.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Image of one frame: the body as the model has it, estimated forces and, beside them, the true
/// ones.
view::Scene MakeForceScene(const robot::RobotModel& model, const ForceFrame& frame,
                           const std::string& title);

/// Writes forces.svg, and scene.png where a force was detected; prints their paths. Throws
/// RunError.
void WriteDemoResults(const std::filesystem::path& folder, const std::filesystem::path& robot,
                      const std::string& title, const LiveComparison& comparison);

/// Prints where the recording is, and the command that shows it; nothing where there is none.
void TellRecording(const std::filesystem::path& recording, const std::filesystem::path& robot);

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <vector>

#include "components/calibration/joint/calibration_frame.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

/// Calibrates the first of these frames without loads as the paper does, with unknown cable
/// tensions: by its Algorithm 1 and jointly by Ipopt. Draws the residual of both after each
/// iteration (the paper's Fig. 6) and prints the last one. `model` is not changed. Throws
/// InputError where every frame has loads, and RunError where neither converges or the file cannot
/// be written.
void PlotConvergence(const std::vector<calibration::CalibrationFrame>& frames,
                     robot::RobotModel* model, const std::filesystem::path& file);

}  // namespace palpate::command

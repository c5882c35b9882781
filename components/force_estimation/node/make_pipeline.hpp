// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <vector>

#include "components/force_estimation/node/node_config.hpp"
#include "components/force_estimation/pipeline/pipeline.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::force_estimation {

/// Whether the settings choose the robot's shape as the measurement; else its markers.
bool IsFromShape(const NodeConfig& config);

/// MarkerPipeline or ShapePipeline, by the settings, for a model to which `calibration` was
/// applied. `cameras`: names of those beside the first. What is made throws InputError for settings
/// that do not fit the robot.
PipelineMaker PipelineMakerOf(const NodeConfig& config, const robot::CalibrationFile& calibration,
                              const std::vector<std::string>& cameras = {});

}  // namespace palpate::force_estimation

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/make_pipeline.hpp"

#include <memory>

#include "components/force_estimation/pipeline/marker_pipeline.hpp"
#include "components/force_estimation/pipeline/shape_pipeline.hpp"

namespace palpate::force_estimation {

bool IsFromShape(const NodeConfig& config) {
  return config.source == "shape" || (config.source == "auto" && !config.camera_pose.empty());
}

PipelineMaker PipelineMakerOf(const NodeConfig& config, const robot::CalibrationFile& calibration,
                              const std::vector<std::string>& cameras) {
  if (IsFromShape(config)) {
    ShapeConfig shape = config.shape;
    if (calibration.depth_bias) shape.untouched_frames = 0;
    return [config, shape, calibration, cameras](robot::RobotModel& model) {
      return std::make_unique<ShapePipeline>(model, config, shape, calibration, cameras);
    };
  }
  return [config, calibration](robot::RobotModel& model) {
    return std::make_unique<MarkerPipeline>(model, config, calibration);
  };
}

}  // namespace palpate::force_estimation

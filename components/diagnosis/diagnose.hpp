// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/diagnosis/design/plan_files.hpp"
#include "components/diagnosis/inference/selection.hpp"
#include "components/diagnosis/surface/surface_source.hpp"
#include "components/diagnosis/vocabulary/diagnosis_result.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/rgbd/camera_model.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::diagnosis {

struct DiagnosisSettings {
  std::vector<std::string> excluded;  ///< ids of causes that are not assumed in
  int most_causes = 4;
  int most_samples = 120;  ///< samples that are compared
  int threads = 2;
  double longest_s = 0.0;  ///< after which no further cause is searched; 0: without an end
  NoiseModel noise;
  /// By recording: what its camera.yaml says of the depth camera.
  std::map<std::string, rgbd::CameraModel> depth_cameras = {};
  /// What depth frames show of the robot, which outlives the diagnosis; nullptr: it is of markers
  /// alone.
  SurfaceSource* surface_source = nullptr;
};

/// What a diagnosis found, for people and for the other verbs.
struct Diagnosis {
  DiagnosisResult result;
  /// The robot file with the causes that a robot file can say; as it was without a cause.
  robot::RobotDescription extended;
  /// What belongs to the actuators, for `calibration` of the other verbs; nothing: no cause does.
  std::optional<robot::CalibrationFile> calibration;
  std::vector<std::string> not_in_files;  ///< words of causes that neither file can say
  std::vector<PlannedRecording> next;  ///< experiments, the best first; none: no question is open
};

/// Says what the simulation of a robot gets wrong in an experiment
/// (docs/theory/model_selection.md). Data that cannot tell have the verdict data_unfit with its
/// reason; what is no robot or no experiment at all throws InputError.
Diagnosis Diagnose(const robot::RobotDescription& robot, const experiment::Experiment& experiment,
                   const DiagnosisSettings& settings, const ReportStep& report);

/// The result for data that could not even be read.
DiagnosisResult Unfit(const std::string& reason);

}  // namespace palpate::diagnosis

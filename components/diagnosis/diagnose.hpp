// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <functional>
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
  std::vector<std::string> excluded;  ///< fault ids excluded from the hypothesis set
  int most_causes = 4;
  int most_samples = 120;  ///< samples that are compared
  int threads = 2;
  double longest_s = 0.0;  ///< time limit of the search; 0: none
  /// Ends the search as the time limit does; asked from several threads. Empty: never.
  std::function<bool()> stop_requested = {};
  NoiseModel noise;
  /// By recording: what its camera.yaml says of the depth camera.
  std::map<std::string, rgbd::CameraModel> depth_cameras = {};
  /// Segmented clouds of the depth frames; outlives the diagnosis. nullptr: markers alone.
  SurfaceSource* surface_source = nullptr;
};

/// The result of a diagnosis, and the files that follow from it.
struct Diagnosis {
  DiagnosisResult result;
  /// The robot file with the named causes that a robot file can hold.
  robot::RobotDescription extended;
  /// Actuator parameters of the named causes, for `calibration` of the other verbs.
  std::optional<robot::CalibrationFile> calibration;
  std::vector<std::string> not_in_files;  ///< words of causes that neither file can hold
  std::vector<PlannedRecording> next;     ///< the best first; empty: no hypotheses to separate
};

/// Identifies the model errors of a robot from an experiment (docs/theory/model_selection.md).
/// Unusable data have the verdict data_unfit with a reason. An invalid robot or experiment throws
/// InputError.
Diagnosis Diagnose(const robot::RobotDescription& robot, const experiment::Experiment& experiment,
                   const DiagnosisSettings& settings, const ReportStep& report);

/// The result for data that could not even be read.
DiagnosisResult Unfit(const std::string& reason);

}  // namespace palpate::diagnosis

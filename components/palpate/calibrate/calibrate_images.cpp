// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/kept_model.hpp"
#include "components/palpate/calibrate/calibrate_ways.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/image_moments.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/settings.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/geometry/pose_text.hpp"

namespace palpate::command {

namespace {

using calibration::CloudCalibration;
using calibration::CloudFrame;
using experiment::Recording;

struct Settings {
  perception::Config perception;

  template <typename Visitor>
  void Visit(Visitor&& v) {
    v("perception", perception, "From images to clouds");
  }
};

Settings ReadSettings(const CalibrateOptions& options, const experiment::Experiment& experiment) {
  Settings settings;
  if (experiment.depth_noise && experiment.depth_noise->subpixel_px > 0.0) {
    settings.perception.depth_subpixel_px = experiment.depth_noise->subpixel_px;
  }
  const std::vector<app::Setting> list = app::ListSettings(settings);
  for (const std::string& assignment : options.overrides) app::ApplyOverride(assignment, list);
  return settings;
}

Eigen::Isometry3d StartOf(const CalibrateOptions& options,
                          const experiment::Experiment& experiment) {
  if (!options.camera_pose.empty()) {
    return geometry::ReadPose(app::ParseYaml(options.camera_pose, "--camera-pose"));
  }
  if (experiment.T_robot_camera) return *experiment.T_robot_camera;
  throw InputError("clouds need to know roughly where the camera stands: --camera-pose");
}

geometry::RigidTransform ToTransform(const Eigen::Isometry3d& T) {
  return {Eigen::Quaterniond(T.linear()), T.translation()};
}

Eigen::Isometry3d ToIsometry(const geometry::RigidTransform& T) {
  return Eigen::Translation3d(T.translation_m()) * T.rotation();
}

/// With the camera where it always stood, and without unknown contacts.
bool Serves(const Recording& recording) {
  return recording.camera_file && !recording.depth_images.empty() && !recording.T_robot_camera &&
         recording.kind != experiment::RecordingKind::kFree &&
         recording.kind != experiment::RecordingKind::kCameraMoved &&
         (recording.camera_on_base || !recording.base_tilt_deg);
}

std::vector<const Recording*> RecordingsWithImages(const experiment::Experiment& experiment) {
  std::vector<const Recording*> chosen;
  for (const Recording& recording : experiment.recordings) {
    if (Serves(recording)) chosen.push_back(&recording);
  }
  if (chosen.empty()) {
    throw InputError(experiment.folder.string() +
                     ": no recording serves to find the camera: it needs depth images and a kind "
                     "other than 'free' and 'camera_moved'");
  }
  return chosen;
}

/// The robot's shapes as the model has them before anything is fitted.
std::vector<ExpectedShape> ShapesOf(const std::vector<ImageMoment>& moments,
                                    const Eigen::Isometry3d& T_robot_camera,
                                    robot::RobotModel* model) {
  const calibration::KeptModel kept(*model);
  std::vector<ExpectedShape> shapes;
  for (const ImageMoment& moment : moments) {
    model->SetGravity(moment.frame.gravity_m_s2);
    fem::StaticState state = model->RestState();
    const fem::StaticResult solved = model->Solve(moment.frame.cables, moment.frame.loads, &state);
    kept.RestoreGravity();
    if (!solved.status.ok()) {
      throw RunError(moment.frame.name + ": " + solved.status.message());
    }
    shapes.push_back({state.x_m, T_robot_camera});
  }
  return shapes;
}

/// Clouds of all moments and the calibration from them.
struct Pass {
  std::vector<CloudFrame> frames;
  CloudCalibration fit;
};

Pass Run(const std::vector<ImageMoment>& moments, const Settings& settings,
         const std::vector<ExpectedShape>& expected, const Eigen::Isometry3d& start,
         const calibration::CloudSettings& clouds, robot::RobotModel* model) {
  Pass pass;
  std::vector<std::string> left_out;
  pass.frames = SeeClouds(moments, settings.perception, model->body(), expected, &left_out);
  if (pass.frames.empty()) {
    throw RunError("perception sees the robot in no picture (" + left_out.front() +
                   "): --camera-pose nearer to the truth, or the robot's colour, --set "
                   "perception.robot_color_rgb=[r, g, b]");
  }
  for (const std::string& line : left_out) fmt::print(stderr, "left out: {}\n", line);
  pass.fit = calibration::CalibrateFromClouds(*model, pass.frames, ToTransform(start), clouds);
  RequireFit(pass.fit.status);
  return pass;
}

void PrintPass(const Pass& pass) {
  for (std::size_t f = 0; f < pass.frames.size(); ++f) {
    const calibration::CloudMatch& match = pass.fit.matches[f];
    fmt::print(
        "{}: {} of {} points on the skin, off by {:.3f} mm RMS; {:.0f} % of the skin in view has "
        "points\n",
        pass.frames[f].name, match.matched, match.points, 1e3 * match.rms_m,
        100.0 * match.skin_covered);
  }
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} rounds\n",
             pass.fit.joint.chi_squared, pass.fit.joint.degrees_of_freedom, pass.fit.rounds);
}

}  // namespace

bool HasImagesOfTheCamera(const experiment::Experiment& experiment) {
  return std::any_of(experiment.recordings.begin(), experiment.recordings.end(), Serves);
}

robot::CalibrationFile CalibrateFromImages(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment,
                                           const std::vector<int>& materials,
                                           robot::RobotModel* model) {
  const Settings settings = ReadSettings(options, experiment);
  const Eigen::Isometry3d start = StartOf(options, experiment);
  const auto chosen = options.recordings.empty() ? RecordingsWithImages(experiment)
                                                 : ChooseRecordings(experiment, options.recordings);
  std::vector<experiment::RgbdSequence> sequences;
  sequences.reserve(chosen.size());
  std::vector<ImageMoment> moments;
  for (const Recording* recording : chosen) {
    sequences.push_back(experiment::OpenRecordingImages(*recording, app::LoadYaml));
    for (ImageMoment& moment :
         MomentsOf(*recording, sequences.back(), *model, ParseCableInput(options.cable_input))) {
      moments.push_back(std::move(moment));
    }
  }
  calibration::CloudSettings clouds;
  clouds.request = {.drive_offset_sigma_m = options.drive_offset_sigma_m,
                    .drive_gains = options.drive_gains,
                    .moduli = materials};
  const calibration::KeptModel kept(*model);
  // A rough pose misplaces the predicted surface; the robot's colour, where it is told, does not.
  const bool by_color = !settings.perception.robot_color_rgb.empty();
  const Pass rough = Run(moments, settings,
                         by_color ? std::vector<ExpectedShape>() : ShapesOf(moments, start, model),
                         start, clouds, model);
  kept.Restore();
  const Eigen::Isometry3d found = ToIsometry(rough.fit.joint.T_robot_camera);
  const Pass pass = Run(moments, settings, ShapesOf(moments, found, model), found, clouds, model);
  robot::CalibrationFile file = MakeCalibration(*model, chosen, options.data);
  calibration::TakeFit(pass.fit.joint, *model, &file);
  if (!options.json) PrintPass(pass);
  return file;
}

}  // namespace palpate::command

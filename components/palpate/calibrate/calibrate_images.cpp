// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <optional>
#include <utility>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/image_samples.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

using calibration::CloudCalibration;
using calibration::CloudFrame;
using experiment::Recording;

Eigen::Isometry3d StartOf(const CalibrateOptions& options, const experiment::Experiment& experiment,
                          const robot::RobotModel& model) {
  const std::optional<Eigen::Isometry3d> earlier = EarlierPose(options, model);
  const std::optional<Eigen::Isometry3d> rough = RoughPose(options, experiment);
  if (rough) return *rough;
  if (earlier) return *earlier;
  throw InputError(
      "images without fiducials need an approximate camera pose: give --camera-pose or "
      "--earlier, or the fiducials' colour, --set perception.markers.color_rgb=[r, g, b]");
}

Eigen::Isometry3d ToIsometry(const geometry::RigidTransform& T) {
  return Eigen::Translation3d(T.translation_m()) * T.rotation();
}

/// The model's shapes before anything is fitted.
std::vector<ExpectedNodes> ShapesOf(const std::vector<ImageSample>& samples,
                                    const Eigen::Isometry3d& T_robot_camera,
                                    robot::RobotModel* model) {
  const calibration::ModelSnapshot kept(*model);
  std::vector<ExpectedNodes> shapes;
  for (const ImageSample& sample : samples) {
    model->SetGravity(sample.frame.gravity_m_s2);
    fem::StaticState state = model->RestState();
    const fem::StaticResult solved = model->Solve(sample.frame.cables, sample.frame.loads, &state);
    kept.RestoreGravity();
    if (!solved.status.ok()) {
      throw RunError(sample.frame.name + ": " + solved.status.message());
    }
    shapes.push_back({state.x_m.reshaped(3, state.x_m.size() / 3).cast<float>(), T_robot_camera});
  }
  return shapes;
}

/// Clouds of all frames and the calibration from them.
struct Pass {
  std::vector<CloudFrame> frames;
  CloudCalibration fit;
};

Pass Run(const std::vector<ImageSample>& samples, const perception::Config& perception,
         const std::vector<ExpectedNodes>& expected, const Eigen::Isometry3d& start,
         const calibration::CloudSettings& clouds, robot::RobotModel* model) {
  Pass pass;
  std::vector<std::string> left_out;
  pass.frames = SeeClouds(samples, perception, model->body(), expected, &left_out);
  if (pass.frames.empty()) {
    throw RunError("perception sees the robot in no image (" + left_out.front() +
                   "): give a more accurate --camera-pose, or the robot's colour, --set "
                   "perception.robot_color_rgb=[r, g, b]");
  }
  for (const std::string& line : left_out) fmt::print(stderr, "excluded: {}\n", line);
  pass.fit = calibration::CalibrateFromClouds(*model, pass.frames, ToTransform(start), clouds);
  RequireFit(pass.fit.status);
  return pass;
}

void PrintPass(const Pass& pass) {
  for (std::size_t f = 0; f < pass.frames.size(); ++f) {
    const calibration::CloudMatch& match = pass.fit.matches[f];
    fmt::print(
        "{}: {} of {} points on the surface, residual {:.3f} mm RMS; {:.0f} % of the visible "
        "surface has points\n",
        pass.frames[f].name, match.matched, match.points, 1e3 * match.rms_m,
        100.0 * match.surface_covered);
  }
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} rounds\n",
             pass.fit.joint.chi_squared, pass.fit.joint.degrees_of_freedom, pass.fit.rounds);
}

/// A depth bias belongs to one camera.
bool AreOfOneCamera(const std::vector<experiment::RgbdSequence>& sequences) {
  return std::all_of(sequences.begin(), sequences.end(), [&](const auto& sequence) {
    return sequence.camera.depth == sequences.front().camera.depth;
  });
}

}  // namespace

robot::CalibrationFile CalibrateFromImages(const CalibrateOptions& options,
                                           const experiment::Experiment& experiment,
                                           const std::vector<int>& materials,
                                           robot::RobotModel* model) {
  const perception::Config perception = PerceptionOf(options.overrides, experiment);
  const Eigen::Isometry3d start = StartOf(options, experiment, *model);
  const auto chosen = RecordingsWithImages(options, experiment);
  std::vector<experiment::RgbdSequence> sequences;
  sequences.reserve(chosen.size());
  std::vector<ImageSample> samples;
  for (const Recording* recording : chosen) {
    sequences.push_back(experiment::OpenRecordingImages(*recording, app::LoadYaml));
    for (ImageSample& sample :
         SamplesOf(*recording, sequences.back(), *model, ParseCableInput(options.cable_input))) {
      samples.push_back(std::move(sample));
    }
  }
  calibration::CloudSettings clouds;
  clouds.fit_depth_bias = !options.no_depth_bias && AreOfOneCamera(sequences);
  clouds.request = {.pose_prior = PriorOf(options, experiment),
                    .actuator_offset_sigma_m = options.actuator_offset_sigma_m,
                    .actuator_gains = options.actuator_gains,
                    .moduli = materials};
  const calibration::ModelSnapshot kept(*model);
  // An approximate pose misplaces the predicted surface; a known robot colour does not depend on
  // it.
  const bool by_color = !perception.robot_color_rgb.empty();
  const Pass rough = Run(samples, perception,
                         by_color ? std::vector<ExpectedNodes>() : ShapesOf(samples, start, model),
                         start, clouds, model);
  kept.Restore();
  const Eigen::Isometry3d found = ToIsometry(rough.fit.joint.T_robot_camera);
  const Pass pass = Run(samples, perception, ShapesOf(samples, found, model), found, clouds, model);
  robot::CalibrationFile file = MakeCalibration(*model, chosen, options.data);
  calibration::TakeFit(pass.fit.joint, *model, &file);
  calibration::TakeDepthBias(pass.fit.joint, rgbd::PictureOf(sequences.front().camera.depth),
                             &file);
  if (!options.json) PrintPass(pass);
  return file;
}

}  // namespace palpate::command

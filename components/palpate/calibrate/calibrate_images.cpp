// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "components/calibration/cloud/cloud_calibration.hpp"
#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/offline/images/image_misfit.hpp"
#include "components/offline/images/image_samples.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/images/open_images.hpp"
#include "components/palpate/images/see_clouds.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

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

std::vector<ExpectedNodes> ExpectedAt(const std::vector<Eigen::VectorXd>& shapes_m,
                                      const Eigen::Isometry3d& T_robot_camera) {
  std::vector<ExpectedNodes> expected;
  for (const Eigen::VectorXd& x_m : shapes_m) {
    expected.push_back({x_m.reshaped(3, x_m.size() / 3).cast<float>(), T_robot_camera});
  }
  return expected;
}

/// What the images are compared with where they do not fit.
struct Comparison {
  const std::vector<offline::ImageSample>& samples;
  rgbd::DepthNoise noise;
  std::string pose_name;
  Eigen::Isometry3d start;
};

/// Throws RunError with the reasons why the images do not fit; `otherwise` where they do fit the
/// model as it is.
[[noreturn]] void Refuse(const Comparison& compared, const std::string& otherwise,
                         robot::RobotModel* model) {
  // The search finds poses within three of these (CalibrateFromClouds).
  constexpr double kRough_m = 0.017, kRough_rad = 0.116;
  const calibration::DepthMisfit misfit =
      offline::FindImageMisfit(compared.samples, compared.noise,
                               {.pose_name = compared.pose_name,
                                .T_robot_camera = ToTransform(compared.start),
                                .translation_sigma_m = kRough_m,
                                .rotation_sigma_rad = kRough_rad},
                               model);
  throw RunError(misfit.fits ? otherwise
                             : offline::MisfitText(misfit.reasons, "nothing was written"));
}

/// Sets the clouds of all frames and the calibration from them.
void Run(const Comparison& compared, const perception::Config& perception,
         const std::vector<ExpectedNodes>& expected, const Eigen::Isometry3d& start,
         const calibration::CloudSettings& clouds, robot::RobotModel* model,
         ImageCalibration* found) {
  std::vector<std::string> left_out;
  found->frames = SeeClouds(compared.samples, perception, model->body(), expected, &left_out);
  if (found->frames.empty()) {
    Refuse(compared,
           "perception sees the robot in no image (" + left_out.front() +
               "). Where the images are sound, give a more accurate --camera-pose, or the "
               "robot's colour, --set perception.robot_color_rgb=[r, g, b]",
           model);
  }
  for (const std::string& line : left_out) fmt::print(stderr, "excluded: {}\n", line);
  found->fit = calibration::CalibrateFromClouds(*model, found->frames, ToTransform(start), clouds);
  if (!found->fit.status.ok()) Refuse(compared, FailureText(found->fit.status), model);
}

/// Of a robot of this size and shape that is nearly where it should be.
std::string ImpossibleText(const ImageCalibration& found) {
  const calibration::JointCalibration& joint = found.fit.joint;
  std::size_t worst = 0;
  for (std::size_t f = 1; f < found.frames.size(); ++f) {
    if (found.fit.matches[f].rms_m > found.fit.matches[worst].rms_m) worst = f;
  }
  return fmt::format(
      "the images do not fit the model: chi-squared {:.3g} for {} degrees of freedom, worst in {} "
      "({:.2f} mm RMS). Where most of the robot is agrees with size, unit and camera pose. "
      "Likely reasons: something touches the robot in a recording whose kind says that nothing "
      "does; the cable inputs are not those of the images; another modulus. Name the recordings "
      "that are sound with --recording",
      joint.chi_squared, joint.degrees_of_freedom, found.frames[worst].name,
      1e3 * found.fit.matches[worst].rms_m);
}

void PrintMatches(const std::vector<calibration::CloudFrame>& frames,
                  const std::vector<calibration::CloudMatch>& matches, const std::string& prefix) {
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const calibration::CloudMatch& match = matches[f];
    if (match.points == 0) continue;
    fmt::print(
        "{}{}: {} of {} points on the surface, residual {:.3f} mm RMS; {:.0f} % of the visible "
        "surface has points\n",
        prefix, frames[f].name, match.matched, match.points, 1e3 * match.rms_m,
        100.0 * match.surface_covered);
  }
}

void Print(const ImageCalibration& found) {
  const calibration::JointCalibration& joint = found.fit.joint;
  PrintMatches(found.frames, found.fit.matches, "");
  for (std::size_t k = 0; k < found.clouds.further_cameras.size(); ++k) {
    PrintMatches(found.frames, found.fit.further_matches[k],
                 "camera '" + found.clouds.further_cameras[k].name + "', ");
  }
  fmt::print("chi-squared {:.3g} for {} degrees of freedom, {} rounds\n", joint.chi_squared,
             joint.degrees_of_freedom, found.fit.rounds);
}

/// A depth bias belongs to one camera.
bool AreOfOneCamera(const std::vector<experiment::RgbdSequence>& sequences) {
  return std::all_of(sequences.begin(), sequences.end(), [&](const auto& sequence) {
    return sequence.camera.depth == sequences.front().camera.depth;
  });
}

}  // namespace

CameraImages OpenCameraImages(const CalibrateOptions& options,
                              const experiment::Experiment& experiment,
                              const robot::RobotModel& model) {
  CameraImages images;
  images.recordings = RecordingsWithImages(options, experiment);
  images.sequences.reserve(images.recordings.size());  // samples point at them
  for (const Recording* recording : images.recordings) {
    images.sequences.push_back(OpenImages(*recording));
    for (offline::ImageSample& sample : offline::SamplesOf(
             *recording, images.sequences.back(), model, ParseCableInput(options.cable_input))) {
      images.samples.push_back(std::move(sample));
    }
  }
  return images;
}

ImageCalibration FitImages(const CalibrateOptions& options,
                           const experiment::Experiment& experiment, const Eigen::Isometry3d& start,
                           calibration::CloudSettings clouds, robot::RobotModel* model) {
  const perception::Config perception = PerceptionOf(options.overrides, experiment);
  const CameraImages images = OpenCameraImages(options, experiment, *model);
  const std::vector<offline::ImageSample>& samples = images.samples;
  ImageCalibration found;
  found.recordings = images.recordings;
  found.picture = rgbd::PictureOf(images.sequences.front().camera.depth);
  clouds.fit_depth_bias = !options.no_depth_bias && AreOfOneCamera(images.sequences);
  found.clouds = clouds;
  const calibration::ModelSnapshot kept(*model);
  const Comparison compared{
      .samples = samples,
      .noise = perception::NoiseOf(perception),
      .pose_name = options.camera_pose.empty() ? "the approximate camera pose" : "--camera-pose",
      .start = start};
  const std::vector<Eigen::VectorXd> shapes_m = offline::ShapesOf(samples, model);
  // An approximate pose misplaces the predicted surface; a known robot colour does not depend on
  // it.
  const bool by_color = !perception.robot_color_rgb.empty();
  Run(compared, perception, by_color ? std::vector<ExpectedNodes>() : ExpectedAt(shapes_m, start),
      start, clouds, model, &found);
  kept.Restore();
  const Eigen::Isometry3d nearer = ToIsometry(found.fit.joint.T_robot_camera);
  Run(compared, perception, ExpectedAt(shapes_m, nearer), nearer, clouds, model, &found);
  if (calibration::IsPossible(found.fit.joint)) return found;
  kept.Restore();
  Refuse(compared, ImpossibleText(found), model);
}

robot::CalibrationFile Describe(const ImageCalibration& found, const CalibrateOptions& options,
                                const robot::RobotModel& model) {
  robot::CalibrationFile file = calibration::MakeCalibration(model, found.recordings, options.data);
  calibration::TakeFit(found.fit.joint, model, &file);
  calibration::TakeDepthBias(found.fit.joint, found.picture, &file);
  LeaveOutMarkerOffsets(options, &file);
  if (!options.json) Print(found);
  return file;
}

FoundCalibration CalibrateFromImages(const CalibrateOptions& options,
                                     const experiment::Experiment& experiment,
                                     const std::vector<int>& materials, robot::RobotModel* model) {
  calibration::CloudSettings clouds;
  clouds.request = {.pose_prior = PriorOf(options, experiment),
                    .actuator_offset_sigma_m = options.actuator_offset_sigma_m,
                    .actuator_gains = options.actuator_gains,
                    .pressure_zero_sigma_Pa = options.pressure_zero_sigma_Pa,
                    .pressure_gain_sigma = options.pressure_gain_sigma,
                    .moduli = materials};
  const Eigen::Isometry3d start = StartOf(options, experiment, *model);
  ImageCalibration images = FitImages(options, experiment, start, clouds, model);
  robot::CalibrationFile file = Describe(images, options, *model);
  return {std::move(file), std::move(images)};
}

}  // namespace palpate::command

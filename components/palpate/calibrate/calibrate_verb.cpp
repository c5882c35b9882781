// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/calibrate_verb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/palpate/calibrate/calibrate_ways.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

// Indices into RobotBody::materials.
std::vector<int> MaterialsOf(const std::vector<std::string>& parts, const robot::RobotBody& body) {
  const std::vector<std::string> known = calibration::PartNames(body);
  std::vector<int> materials;
  for (const std::string& part : parts.empty() ? std::vector<std::string>{"body"} : parts) {
    const auto found = std::find(known.begin(), known.end(), part);
    if (found == known.end()) {
      throw InputError("--part " + part + ": the robot has no such region" +
                       DidYouMean(part, known));
    }
    const int material = static_cast<int>(found - known.begin());
    if (std::find(materials.begin(), materials.end(), material) != materials.end()) {
      throw InputError("--part " + part + " is given twice");
    }
    materials.push_back(material);
  }
  return materials;
}

bool HasMarkers(const experiment::Experiment& experiment) {
  return std::any_of(
      experiment.recordings.begin(), experiment.recordings.end(),
      [](const experiment::Recording& recording) { return recording.markers.has_value(); });
}

robot::CalibrationFile Find(const CalibrateOptions& options, robot::RobotModel* model) {
  const auto experiment = experiment::ReadExperiment(options.data, app::LoadYaml);
  const std::vector<int> materials = MaterialsOf(options.parts, model->body());
  const bool unlabelled = AreUnlabelled(options, experiment);
  if (options.fit_depth_bias && options.no_depth_bias) {
    throw InputError("--fit-depth-bias and --no-depth-bias: only one of them");
  }
  if (options.from == "markers" && !options.camera_pose.empty() && !unlabelled) {
    throw InputError("--camera-pose is for images; --from markers needs none");
  }
  const bool joint = options.what == "joint";
  const bool fiducials = !PerceptionOf(options.overrides, experiment).markers.color_rgb.empty();
  const bool images_are_meant =
      options.from == "images" ||
      (options.from.empty() && (fiducials || (!options.camera_pose.empty() && !unlabelled)));
  const bool camera =
      options.what == "camera" ||
      (options.what != "material" && (images_are_meant || NeedsCameraPose(experiment)));
  if (!joint && !camera) return CalibrateMaterial(options, experiment, materials, model);
  const std::vector<int> wanted = joint || !options.parts.empty() ? materials : std::vector<int>();
  const bool has_markers = camera ? HasMarkersOfTheCamera(experiment) : HasMarkers(experiment);
  const bool from_images = images_are_meant || (options.from.empty() && !has_markers &&
                                                HasImagesOfTheCamera(experiment));
  if (from_images && options.unlabelled) {
    throw InputError("--unlabelled is for markers.csv; markers in images have no names anyway");
  }
  if (from_images && fiducials) return CalibrateFromFiducials(options, experiment, wanted, model);
  if (from_images) return CalibrateFromImages(options, experiment, wanted, model);
  if (unlabelled) return CalibrateFromUnlabelled(options, experiment, wanted, model);
  return CalibrateJointly(options, experiment, wanted, camera, model);
}

/// A number that is looked for jointly where how far it may be off is not 0.
struct Belief {
  const char* option;
  double CalibrateOptions::*sigma;
  const char* how_far;
};
constexpr std::array kBeliefs = {
    Belief{"--marker-offset-sigma-m", &CalibrateOptions::marker_offset_sigma_m,
           "a marker may sit from its place in the robot file"},
    Belief{"--gravity-tilt-sigma-deg", &CalibrateOptions::gravity_tilt_sigma_deg,
           "gravity may lean"},
    Belief{"--mass-relative-sigma", &CalibrateOptions::mass_relative_sigma,
           "the body's weight may be off (0.1: 10 %)"},
    Belief{"--poissons-ratio-sigma", &CalibrateOptions::poissons_ratio_sigma,
           "Poisson's ratio may be off, of the parts whose modulus is looked for"},
    Belief{"--geometry-scale-sigma", &CalibrateOptions::geometry_scale_sigma,
           "the robot's size may be off (0.01: 1 %)"},
    Belief{
        "--cable-route-sigma-m", &CalibrateOptions::cable_route_sigma_m,
        "the points that cables are pulled from may sit off the robot file's, across the cables"},
    Belief{"--cable-eyelet-sigma-m", &CalibrateOptions::cable_eyelet_sigma_m,
           "the cables' eyelets on the body may sit off the robot file's, across the cables"},
    Belief{"--depth-scale-sigma", &CalibrateOptions::depth_scale_sigma,
           "the distances of markers from the camera may be off (0.003: 0.3 %)"}};

/// How far what is not looked for, or looked for, may be off.
void DeclareBeliefs(app::Arguments& arguments, CalibrateOptions* options) {
  arguments.Option("--marker-bias-m", &options->marker_bias_m,
                   "constant error of each marker, one sigma, that averaging does not remove");
  arguments.Option("--drive-offset-sigma-m", &options->drive_offset_sigma_m,
                   "how far a drive's zero may be off, one sigma");
  arguments.Flag("--drive-gains", &options->drive_gains,
                 "find the gains of the drives' displacements, too");
  for (const Belief& belief : kBeliefs) {
    arguments.Option(
        belief.option, &(options->*belief.sigma),
        "how far " + std::string(belief.how_far) + ", one sigma; joint: looked for where not 0");
  }
  arguments.Flag("--fit-depth-bias", &options->fit_depth_bias,
                 "depth without markers: find the smooth error of the depth image with the pose, "
                 "which is done anyway");
  arguments.Flag("--no-depth-bias", &options->no_depth_bias,
                 "do not look for it: it counts in the standard errors alone");
}

}  // namespace

int Calibrate(const CalibrateOptions& options) {
  constexpr double kSigmasOfRoom = 4.0;
  const std::unique_ptr<robot::RobotModel> model =
      LoadRobot(options.robot, options.solver, {}, kSigmasOfRoom * options.cable_eyelet_sigma_m);
  const robot::CalibrationFile file = Find(options, model.get());
  robot::WriteCalibrationFile(file, options.out);
  if (options.json) {
    PrintCalibrationJson(file);
  } else {
    PrintCalibration(file);
    fmt::print("holds for mesh {} with {} and {} only\n", file.mesh_hash, file.element, file.model);
    fmt::print("written to {}\n", options.out.string());
  }
  return app::kExitDone;
}

app::Verb CalibrateVerb() {
  return {
      "calibrate", "Find camera pose, drives and material from measured markers",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<CalibrateOptions>();
        arguments.Positional("ROBOT", &options->robot,
                             "robot file, or the name of a robot that comes with palpate");
        arguments.Option("--data", &options->data, "experiment or recording folder",
                         app::Need::kRequired);
        arguments.Option("--out", &options->out, "calibration file to write", app::Need::kRequired);
        arguments.Choice("--what", &options->what, {"auto", "material", "camera", "joint"},
                         "what is found; camera: pose and drives' offsets; joint: with the moduli, "
                         "without the pose where it is known; auto: camera where markers are in "
                         "its frame and its pose is not known, "
                         "else material");
        arguments.Choice("--from", &options->from, {"markers", "images"},
                         "what the camera is found from; else from markers in its frame where a "
                         "recording has them, and without them from depth and colour: by coloured "
                         "markers where --set perception.markers.color_rgb=[r, g, b] says which, "
                         "else by the robot's shape");
        arguments.Flag("--unlabelled", &options->unlabelled,
                       "tell by where they are which markers the points in markers.csv are, "
                       "whatever they are called; without this only where none has a name");
        arguments.Option("--assignment", &options->assignment,
                         "draw which point was taken for which marker (SVG); camera's pose only");
        arguments.Option(
            "--camera-pose", &options->camera_pose,
            "roughly where the camera stands, \"{translation_m: [x, y, z], "
            "rotation_xyzw: [x, y, z, w]}\" (50 mm, 20 degrees): images without coloured markers "
            "start from it; of markers without names on a robot that looks the same after a turn "
            "it tells which is which; else the experiment's");
        arguments.Option("--earlier", &options->earlier,
                         "an earlier calibration: images without coloured markers start from its "
                         "pose; where markers without names could be told apart in several ways, "
                         "it tells, if the camera stands there still");
        arguments.Repeated("--set", &options->overrides,
                           "a setting perception.* for images, KEY=VALUE");
        arguments.Repeated("--recording", &options->recordings,
                           "use this recording (repeatable); else all but those of kind 'free'");
        arguments.Repeated("--part", &options->parts,
                           "fit the modulus of 'body' or of a region (repeatable); else the body");
        DeclareSolverOptions(arguments, &options->solver);
        arguments.Choice("--cable-input", &options->cable_input, {"displacement", "tension"},
                         "what is imposed on a cable where both were measured");
        DeclareBeliefs(arguments, options.get());
        arguments.Option(
            "--convergence", &options->convergence,
            "draw how the residual of the first frame falls, by the paper's Algorithm 1 "
            "and jointly (SVG); camera's pose only");
        arguments.Flag("--json", &options->json, "print JSON");
        return [options] { return Calibrate(*options); };
      }};
}

}  // namespace palpate::command

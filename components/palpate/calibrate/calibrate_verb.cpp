// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/force_estimation/check_labels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "components/calibration/joint/found_calibration.hpp"
#include "components/calibration/joint/model_snapshot.hpp"
#include "components/palpate/calibrate/calibrate_methods.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
#include "components/palpate/calibrate/image_settings.hpp"
#include "components/palpate/check_output.hpp"
#include "components/palpate/end_on_signal.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/recordings/data_folder.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

std::vector<std::string> PartsOf(const CalibrateOptions& options, const robot::RobotBody& body) {
  const auto& asked = options.parts;
  if (asked.empty()) return calibration::PartsToFit(body);
  const std::vector<std::string> parts = calibration::PartsWithElements(body);
  const bool has_body = parts.front() == "body";
  if (!has_body && std::find(asked.begin(), asked.end(), "body") != asked.end()) {
    throw InputError("--part body: all elements belong to regions; give " + Listed(parts));
  }
  return asked;
}

// Indices into RobotBody::materials.
std::vector<int> MaterialsOf(const std::vector<std::string>& parts, const robot::RobotBody& body) {
  const std::vector<std::string> known = calibration::PartNames(body);
  std::vector<int> materials;
  for (const std::string& part : parts) {
    const auto found = std::find(known.begin(), known.end(), part);
    if (found == known.end()) {
      throw InputError("--part " + part +
                       ": the robot has no such region; give body or a region of the robot file" +
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

FoundCalibration Find(const experiment::Experiment& experiment, const CalibrateOptions& options,
                      robot::RobotModel* model) {
  const std::vector<int> materials = MaterialsOf(PartsOf(options, model->body()), model->body());
  const bool unlabelled = AreUnlabelled(options, experiment);
  if (!unlabelled) {
    force_estimation::CheckMarkerLabels(
        experiment, robot::ReadRobotFile(FindRobotFile(options.robot), app::LoadYaml));
  }
  if (options.fit_depth_bias && options.no_depth_bias) {
    throw InputError("--fit-depth-bias and --no-depth-bias exclude each other: give one");
  }
  if (options.from == "markers" && !options.camera_pose.empty() && !unlabelled) {
    throw InputError(
        "--camera-pose is for images and unlabelled markers; leave it out, or give "
        "--from images or --unlabelled");
  }
  const bool fiducials = !PerceptionOf(options.overrides, experiment).markers.color_rgb.empty();
  const bool images_are_meant =
      options.from == "images" ||
      (options.from.empty() && (fiducials || (!options.camera_pose.empty() && !unlabelled)));
  const bool markers =
      options.what == "camera" ? HasMarkersOfTheCamera(experiment) : HasMarkers(experiment);
  const bool from_images =
      options.what != "material" &&
      (images_are_meant || (options.from.empty() && !markers && HasImagesOfTheCamera(experiment)));
  if (from_images && options.unlabelled) {
    throw InputError(
        "--unlabelled is for markers.csv; fiducials in images have no names: leave it out");
  }
  // Named markers tell whether a modulus is determined; the others are asked for it.
  const bool named = options.what == "joint" || !options.parts.empty();
  const std::vector<int> asked = named ? materials : std::vector<int>();
  if (from_images && fiducials) return {CalibrateFromFiducials(options, experiment, asked, model)};
  if (from_images) return CalibrateFromImages(options, experiment, asked, model);
  if (options.what == "material" && !HasMarkersOfTheCamera(experiment)) {
    return {CalibrateMaterial(options, experiment, materials, model)};
  }
  const bool together = options.what == "auto" && options.from.empty() && !unlabelled && markers &&
                        HasImagesOfTheCamera(experiment);
  if (together) return CalibrateTogether(options, experiment, materials, model);
  if (unlabelled) return {CalibrateFromUnlabelled(options, experiment, asked, model)};
  return {
      CalibrateJointly(options, experiment, options.what == "camera" ? asked : materials, model)};
}

/// A parameter that a joint calibration estimates where its prior standard deviation is not 0.
struct PriorOption {
  const char* option;
  double CalibrateOptions::*sigma;
  const char* of_what;
};
constexpr std::array kPriorOptions = {
    PriorOption{"--marker-offset-sigma-m M", &CalibrateOptions::marker_offset_sigma_m,
                "marker offsets, m"},
    PriorOption{"--pressure-zero-sigma-Pa PA", &CalibrateOptions::pressure_zero_sigma_Pa,
                "the zero of the pressure sensor of each chamber, Pa"},
    PriorOption{"--pressure-gain-sigma RATIO", &CalibrateOptions::pressure_gain_sigma,
                "the gain of the pressure sensor of each chamber"},
    PriorOption{"--gravity-tilt-sigma-deg DEG", &CalibrateOptions::gravity_tilt_sigma_deg,
                "the gravity direction, degrees"},
    PriorOption{"--mass-relative-sigma RATIO", &CalibrateOptions::mass_relative_sigma,
                "the body's mass, relative (0.1: 10 %)"},
    PriorOption{"--poissons-ratio-sigma NUMBER", &CalibrateOptions::poissons_ratio_sigma,
                "Poisson's ratio, for the parts whose modulus is estimated"},
    PriorOption{"--geometry-scale-sigma RATIO", &CalibrateOptions::geometry_scale_sigma,
                "the robot's size, relative (0.01: 1 %)"},
    PriorOption{"--cable-route-sigma-m M", &CalibrateOptions::cable_route_sigma_m,
                "the fixed points that pull the cables, across the cables, m"},
    PriorOption{"--cable-eyelet-sigma-m M", &CalibrateOptions::cable_eyelet_sigma_m,
                "the cables' eyelets on the body, across the cables, m"},
    PriorOption{"--depth-scale-sigma RATIO", &CalibrateOptions::depth_scale_sigma,
                "the scale of marker distances from the camera, relative (0.003: 0.3 %)"}};

/// Priors of what is estimated, and errors of what is not.
void DeclarePriors(app::Arguments& arguments, CalibrateOptions* options) {
  arguments.Option("--marker-bias-m M", &options->marker_bias_m,
                   "Standard deviation of each marker's constant error, which averaging does not "
                   "remove, m");
  arguments.Option("--actuator-offset-sigma-m M", &options->actuator_offset_sigma_m,
                   "Prior standard deviation of the zero offset of each cable actuator, m");
  arguments.Flag("--actuator-gains", &options->actuator_gains,
                 "Also estimate the gain of each actuator's displacement");
  for (const PriorOption& prior : kPriorOptions) {
    arguments.Option(
        prior.option, &(options->*prior.sigma),
        "Prior standard deviation of " + std::string(prior.of_what) + "; 0: not estimated");
  }
  arguments.Flag("--fit-depth-bias", &options->fit_depth_bias,
                 "With images: estimate the smooth depth bias with the pose, as is the default");
  arguments.Flag("--no-depth-bias", &options->no_depth_bias,
                 "With images: do not estimate the depth bias; it counts in the standard errors");
}

/// What is calibrated, from which data and from which start.
void DeclareWhat(app::Arguments& arguments, CalibrateOptions* options) {
  arguments.Choice("--what", &options->what, {"auto", "material", "camera", "joint"},
                   "What to estimate: material (Young's moduli), camera (camera pose and actuator "
                   "offsets), joint (all of them), or auto (pose and offsets, the depth bias where "
                   "there are images, and of named markers a modulus that they determine)");
  arguments.Choice("--from", &options->from, {"markers", "images"},
                   "Measurement for the camera pose; without it markers in the camera frame where "
                   "a recording has them, with --what auto together with images, else images: by "
                   "fiducials where --set perception.markers.color_rgb names their colour, else by "
                   "the robot's shape");
  arguments.Repeated("--recording NAME", &options->recordings,
                     "Use this recording; without it all but those of kind free");
  arguments.Repeated(
      "--part NAME", &options->parts,
      "Estimate the modulus of this region, or of body; without it of the body, or of "
      "all regions if they have all its elements");
  arguments.Flag("--unlabelled", &options->unlabelled,
                 "Assign the points of markers.csv to markers by their positions and ignore their "
                 "names; without it only where no point has a name");
  arguments.Option("--camera-pose POSE", &options->camera_pose,
                   "Approximate camera pose (to 50 mm and 20 degrees), \"{translation_m: [x, y, "
                   "z], rotation_xyzw: [x, y, z, w]}\": start for images without fiducials; "
                   "decides between symmetric assignments of unlabelled markers; without it the "
                   "experiment's");
  arguments.Option("--earlier", &options->earlier,
                   "Earlier calibration file: its pose is the start for images without fiducials, "
                   "and decides between symmetric assignments if the camera has not moved");
  arguments.Repeated("--set KEY=VALUE", &options->overrides,
                     "Change one setting perception.* of the image processing");
}

}  // namespace

int Calibrate(const CalibrateOptions& options) {
  CheckOutputFile(options.out);
  for (const std::filesystem::path& drawing : {options.assignment, options.convergence}) {
    if (!drawing.empty()) CheckOutputFile(drawing);
  }
  constexpr double kSigmasOfRoom = 4.0;
  const std::unique_ptr<robot::RobotModel> model =
      LoadRobot(options.robot, options.solver, {}, kSigmasOfRoom * options.cable_eyelet_sigma_m);
  std::optional<EndOnSignal> end_on_signal;
  end_on_signal.emplace("palpate calibrate", "no calibration was written");
  const DataFolder data(options.data, options.remap, FindRobotFile(options.robot));
  robot::CalibrationFile file;
  data.Run([&](const std::filesystem::path& folder) {
    const auto experiment = experiment::ReadExperiment(folder, app::LoadYaml);
    const calibration::ModelSnapshot nominal(*model);
    FoundCalibration found = Find(experiment, options, model.get());
    nominal.Restore();
    if (options.what != "material") {
      CalibrateFurtherCameras(options, experiment, model.get(), &found);
    }
    file = std::move(found.file);
    return app::kExitDone;
  });
  end_on_signal.reset();
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
      "calibrate",
      "Calibrate camera pose, cable actuators, pressure sensors and material from measured data",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<CalibrateOptions>();
        DeclareRobot(arguments, &options->robot);
        arguments.Option("--data FOLDER", &options->data,
                         "Experiment or recording folder, or MCAP or .db3 file or folder of them",
                         app::Need::kRequired);
        DeclareRemap(arguments, &options->remap);
        arguments.Option("--out", &options->out, "Calibration file to write", app::Need::kRequired);
        DeclareWhat(arguments, options.get());
        DeclareSolverOptions(arguments, &options->solver);
        DeclareCableInput(arguments, &options->cable_input);
        DeclarePriors(arguments, options.get());
        arguments.Option("--assignment", &options->assignment,
                         "SVG file to draw: which point was assigned to which marker; camera pose "
                         "only");
        arguments.Option("--convergence", &options->convergence,
                         "SVG file to draw: residual of the first frame against iterations, by "
                         "the paper's Algorithm 1 and by the joint fit; camera pose only");
        arguments.Flag("--json", &options->json, "Print JSON instead of text");
        return [options] { return Calibrate(*options); };
      }};
}

}  // namespace palpate::command

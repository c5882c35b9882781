// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/calibrate/calibrate_verb.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "components/palpate/calibrate/calibrate_ways.hpp"
#include "components/palpate/calibrate/calibration_output.hpp"
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
  std::vector<std::string> known = {"body"};
  known.insert(known.end(), body.region_names.begin(), body.region_names.end());
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

robot::CalibrationFile Find(const CalibrateOptions& options, robot::RobotModel* model) {
  const auto experiment = experiment::ReadExperiment(options.data, app::LoadYaml);
  const std::vector<int> materials = MaterialsOf(options.parts, model->body());
  const bool camera = options.what == "camera" || options.what == "joint" ||
                      (options.what == "auto" && NeedsCameraPose(experiment));
  if (!camera) return CalibrateMaterial(options, experiment, materials, model);
  const bool joint = options.what == "joint" || !options.parts.empty();
  return CalibrateCamera(options, experiment, joint ? materials : std::vector<int>(), model);
}

}  // namespace

int Calibrate(const CalibrateOptions& options) {
  const std::unique_ptr<robot::RobotModel> model = LoadRobot(options.robot, options.solver);
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
                         "what is found; camera: pose and drives' offsets; joint: with the moduli; "
                         "auto: camera where markers are in its frame and its pose is not known, "
                         "else material");
        arguments.Repeated("--recording", &options->recordings,
                           "use this recording (repeatable); else all but those of kind 'free'");
        arguments.Repeated("--part", &options->parts,
                           "fit the modulus of 'body' or of a region (repeatable); else the body");
        DeclareSolverOptions(arguments, &options->solver);
        arguments.Choice("--cable-input", &options->cable_input, {"displacement", "tension"},
                         "what is imposed on a cable where both were measured");
        arguments.Option(
            "--marker-bias-m", &options->marker_bias_m,
            "constant error of each marker, one sigma, that averaging does not remove");
        arguments.Option("--drive-offset-sigma-m", &options->drive_offset_sigma_m,
                         "how far a drive's zero may be off, one sigma");
        arguments.Flag("--drive-gains", &options->drive_gains,
                       "find the gains of the drives' displacements, too");
        arguments.Flag("--json", &options->json, "print JSON");
        return [options] { return Calibrate(*options); };
      }};
}

}  // namespace palpate::command

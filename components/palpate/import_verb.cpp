// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import_verb.hpp"

#include <iostream>
#include <memory>
#include <optional>

#include "components/palpate/check_output.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/import/import_capture.hpp"
#include "components/palpate/import/import_registration.hpp"
#include "components/palpate/import/import_report.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;

// Where the recording goes, and the experiment above it where there is one.
struct Target {
  fs::path recording;
  fs::path experiment_file;  // empty: a recording on its own
};

Target FindTarget(const ImportOptions& options) {
  if (fs::exists(options.out / "recording.yaml")) {
    throw InputError(SourceLocation{options.out.string()},
                     "is a recording already and is not overwritten; give another --out");
  }
  if (options.recording.empty()) {
    if (fs::exists(options.out / "experiment.yaml")) {
      throw InputError(SourceLocation{options.out.string()},
                       "is an experiment; name the new recording with --recording");
    }
    return {options.out, {}};
  }
  if (options.recording.find('/') != std::string::npos || options.recording.starts_with('.')) {
    throw InputError("--recording '" + options.recording + "' must be a plain name");
  }
  Target target{options.out / "recordings" / options.recording, options.out / "experiment.yaml"};
  if (fs::exists(target.recording)) {
    throw InputError(SourceLocation{target.recording.string()},
                     "exists already and is not overwritten; give another --recording");
  }
  return target;
}

experiment::Experiment MakeExperiment(const ImportOptions& options,
                                      const std::optional<robot::RobotDescription>& robot,
                                      experiment::MeasurementFrame frame,
                                      const std::optional<Eigen::Vector3d>& noise_m) {
  experiment::Experiment experiment;
  if (robot) experiment.robot = robot->file;
  experiment.frame = frame;
  experiment.markers_sigma_m = noise_m;
  if (options.markers_sigma_m > 0.0) {
    experiment.markers_sigma_m = Eigen::Vector3d::Constant(options.markers_sigma_m);
  }
  return experiment;
}

std::optional<robot::RobotDescription> ReadRobot(const ImportOptions& options) {
  if (options.robot.empty()) return std::nullopt;
  return robot::ReadRobotFile(FindRobotFile(options.robot), app::LoadYaml);
}

std::vector<std::string> MarkerNames(const robot::RobotDescription& robot) {
  std::vector<std::string> names;
  for (const robot::MarkerSettings& marker : robot.markers) names.push_back(marker.name);
  return names;
}

// An experiment that is there is extended, never changed.
void CheckFits(const ImportOptions& options, const std::optional<robot::RobotDescription>& robot,
               const fs::path& experiment_file) {
  const auto settings = experiment::ReadExperimentSettings(experiment_file, app::LoadYaml);
  const SourceLocation where{experiment_file.string()};
  if (options.markers_sigma_m > 0.0) {
    throw InputError(where,
                     "exists already; write markers_sigma_m there instead of giving "
                     "--markers-sigma");
  }
  if (robot && settings.robot &&
      fs::weakly_canonical(*settings.robot) != fs::weakly_canonical(robot->file)) {
    throw InputError(where, "belongs to another robot, " + settings.robot->string() +
                                ": give that one with --robot, or another --out");
  }
}

void DeclareTarget(app::Arguments& arguments, ImportOptions& options) {
  arguments.Positional("FILE", &options.file,
                       "Motion-capture file: C3D, CSV of Motive or Nexus, TSV of Qualisys, TRC, or "
                       "a table with the columns time_s, marker, x_m, y_m, z_m and optionally "
                       "residual_m (or _mm, _cm)");
  arguments.Option("--out FOLDER", &options.out,
                   "Experiment folder; without --recording the folder of the recording itself",
                   app::Need::kRequired);
  arguments.Option("--recording NAME", &options.recording,
                   "Name of the new recording in the experiment");
  DeclareRobotOption(arguments, &options.robot,
                     "refuse markers that it lacks; without it all markers are kept");
  arguments.Choice("--kind KIND", &options.kind,
                   {"rest", "ramp", "hold", "known_load", "co_contraction", "base_tilted",
                    "camera_moved", "second_speed", "repeat", "free"},
                   "What was done: rest, ramp, hold, known_load, co_contraction, base_tilted, "
                   "camera_moved, second_speed, repeat or free (docs/experiment.md)");
  arguments.Repeated("--load LOAD", &options.loads,
                     "Known load \"x, y, z[, patch radius]: fx, fy, fz\", m and N, robot frame, on "
                     "the undeformed body, all the time (loads.csv); kind known_load needs one");
  arguments.Option("--notes", &options.notes, "Text to store with the recording");
  arguments.Option("--markers-sigma M", &options.markers_sigma_m,
                   "Standard deviation of the noise of a coordinate, m, for a new experiment; 0: "
                   "as the static noise of the capture is");
}

void DeclareEdits(app::Arguments& arguments, ImportOptions& options) {
  arguments.Repeated("--rename NAME=NEW_NAME", &options.rename, "Rename a marker of the file");
  arguments.Option("--markers A,B,...", &options.markers,
                   "Keep only these markers; without it all");
  arguments.Choice("--unit", &options.unit, {"m", "cm", "mm"},
                   "Length unit of a C3D file that does not name one");
  arguments.Option("--from S", &options.from_s,
                   "First time to keep, s, on the file's clock; without it from the first frame");
  arguments.Option("--to S", &options.to_s,
                   "Last time to keep, s, on the file's clock; without it to the last frame");
  arguments.Option("--rate HZ", &options.rate_Hz, "Frame rate to keep, Hz; 0: all frames");
  arguments.Option("--time-offset S", &options.time_offset_s,
                   "Time to add to all times, s: all recordings of an experiment share one clock");
  arguments.Option("--rest-window T0:T1", &options.rest_window,
                   "Window at rest, s, on the file's clock: displacements count from the mean "
                   "over it");
  arguments.Choice("--rest-shape SHAPE", &options.rest_shape, {"auto", "undeformed", "equilibrium"},
                   "Shape of the body in the rest window: equilibrium (under gravity and cables, "
                   "without contact), undeformed (held straight by hand: the mesh before gravity), "
                   "or auto, which is equilibrium");
  arguments.Option("--steady-window T0:T1", &options.steady_window,
                   "Window of the static phase, s, on the file's clock; without it none");
}

void DeclareFrame(app::Arguments& arguments, ImportOptions& options) {
  arguments.Option("--axes AXES", &options.axes,
                   "Robot axes in terms of the file's: z,-y,x means that the robot's x is the "
                   "file's z, its y the file's -y, its z the file's x (write --axes=-z,... for a "
                   "leading minus)");
  arguments.Choice("--frame", &options.frame, {"robot", "camera"},
                   "Measurement frame of the positions; without it robot with --axes, else camera");
  arguments.Option("--pose POSE", &options.pose,
                   "Camera pose T_robot_camera as x,y,z,qx,qy,qz,qw, m");
  arguments.Flag("--register", &options.register_to_robot,
                 "Estimate T_robot_camera: register the mean marker positions of the rest window "
                 "to the robot's rest shape (--rest-shape)");
  arguments.Option("--register-markers A,B,...", &options.register_markers,
                   "Register these markers only; without it all");
}

}  // namespace

int RunImport(const ImportOptions& options, std::ostream& report) {
  if (options.markers_sigma_m < 0.0)
    throw InputError("--markers-sigma: must be 0 or more, not " +
                     FormatNumber(options.markers_sigma_m));
  const Target target = FindTarget(options);
  CheckOutputFolder(target.recording);
  const bool is_new_experiment =
      !target.experiment_file.empty() && !fs::exists(target.experiment_file);
  const experiment::CapturedMarkers captured = ReadAndEdit(options);
  for (const std::string& note : captured.notes) report << "note: " << note << '\n';
  experiment::Recording recording = MakeRecording(options, captured);
  const std::optional<robot::RobotDescription> robot = ReadRobot(options);
  if (!target.experiment_file.empty() && !is_new_experiment) {
    CheckFits(options, robot, target.experiment_file);
  }
  if (robot) experiment::CheckMarkers(recording, MarkerNames(*robot));
  const std::optional<Eigen::Vector3d> noise_m = PrintQuality(captured, recording, report);
  if (options.register_to_robot && !robot) throw InputError("--register needs --robot");
  if (robot) PlaceMarkers(options, report, &recording);
  PrintFrame(options, recording, report);

  experiment::WriteRecording(recording, target.recording);
  if (is_new_experiment) {
    const auto settings = MakeExperiment(options, robot, *recording.frame, noise_m);
    experiment::WriteExperimentSettings(settings, target.experiment_file);
    PrintNoise(settings, report);
  }
  report << "wrote " << target.recording.string() << '\n';
  if (recording.kind == experiment::RecordingKind::kKnownLoad && recording.loads.empty()) {
    report << "warning: a recording of kind known_load needs its load: write "
           << (target.recording / "loads.csv").string() << ", or import it again with --load\n";
  }
  return 0;
}

app::Verb ImportVerb() {
  return {"import",
          "Convert a motion-capture file (C3D, CSV, TSV, TRC) to a recording of an experiment",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<ImportOptions>();
            DeclareTarget(arguments, *options);
            DeclareEdits(arguments, *options);
            DeclareFrame(arguments, *options);
            return [options] { return RunImport(*options, std::cout); };
          }};
}

}  // namespace palpate::command

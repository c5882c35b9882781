// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import_verb.hpp"

#include <iostream>
#include <memory>
#include <optional>

#include "components/palpate/find_robot.hpp"
#include "components/palpate/import/import_capture.hpp"
#include "components/palpate/import/import_registration.hpp"
#include "components/palpate/import/import_report.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
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
                     "is a recording already; a recording is never overwritten");
  }
  if (options.recording.empty()) {
    if (fs::exists(options.out / "experiment.yaml")) {
      throw InputError(SourceLocation{options.out.string()},
                       "is an experiment: name the new recording with --recording");
    }
    return {options.out, {}};
  }
  if (options.recording.find('/') != std::string::npos || options.recording.starts_with('.')) {
    throw InputError("--recording '" + options.recording + "' must be a plain name");
  }
  Target target{options.out / "recordings" / options.recording, options.out / "experiment.yaml"};
  if (fs::exists(target.recording)) {
    throw InputError(SourceLocation{target.recording.string()},
                     "exists already; a recording is never overwritten");
  }
  return target;
}

experiment::Experiment MakeExperiment(const ImportOptions& options,
                                      const std::optional<robot::RobotDescription>& robot,
                                      experiment::MeasurementFrame frame) {
  experiment::Experiment experiment;
  if (robot) experiment.robot = robot->file;
  experiment.frame = frame;
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
                     "is there already: write markers_sigma_m there instead of giving "
                     "--markers-sigma");
  }
  if (robot && settings.robot &&
      fs::weakly_canonical(*settings.robot) != fs::weakly_canonical(robot->file)) {
    throw InputError(where, "is about another robot, " + settings.robot->string());
  }
}

void DeclareTarget(app::Arguments& arguments, ImportOptions& options) {
  arguments.Positional("FILE", &options.file,
                       ".c3d, or .csv with time_s, marker, x_m, y_m, z_m[, residual_m] (or _mm, "
                       "_cm)");
  arguments.Option("--out", &options.out, "experiment folder; without --recording the recording's",
                   app::Need::kRequired);
  arguments.Option("--recording", &options.recording, "name of the recording in the experiment");
  arguments.Option("--robot", &options.robot,
                   "robot file or name: no other markers than its own may be in the data");
  arguments.Choice("--kind", &options.kind,
                   {"rest", "ramp", "hold", "known_load", "co_contraction", "base_tilted",
                    "camera_moved", "second_speed", "repeat", "free"},
                   "what was done");
  arguments.Option("--notes", &options.notes, "text to keep with the recording");
  arguments.Option("--markers-sigma", &options.markers_sigma_m,
                   "noise of a coordinate, m, for a new experiment");
}

void DeclareEdits(app::Arguments& arguments, ImportOptions& options) {
  arguments.Repeated("--rename", &options.rename, "NAME=NEW_NAME of a marker");
  arguments.Option("--markers", &options.markers, "a,b,c: keep only these");
  arguments.Option("--unit", &options.unit, "m, cm or mm, for a C3D file that does not say");
  arguments.Option("--from", &options.from_s, "first time to keep, s");
  arguments.Option("--to", &options.to_s, "last time to keep, s");
  arguments.Option("--rate", &options.rate_Hz, "frames a second to keep");
  arguments.Option("--time-offset", &options.time_offset_s,
                   "s, added to all times: an experiment has one clock");
  arguments.Option("--rest-window", &options.rest_window,
                   "T0:T1, s: displacements count from the mean over it");
  arguments.Choice("--rest-shape", &options.rest_shape, {"undeformed", "equilibrium"},
                   "the body's shape in the rest window");
  arguments.Option("--steady-window", &options.steady_window, "T0:T1, s: the static phase");
}

void DeclareFrame(app::Arguments& arguments, ImportOptions& options) {
  arguments.Option("--axes", &options.axes,
                   "model axes from the file's: z,-y,x means x is its z, y its -y, z its x "
                   "(write --axes=-z,... for a leading minus)");
  arguments.Choice("--frame", &options.frame, {"robot", "camera"},
                   "frame of the positions; default: robot with --axes, else camera");
  arguments.Option("--pose", &options.pose, "T_robot_camera as x,y,z,qx,qy,qz,qw");
  arguments.Flag("--register", &options.register_to_robot,
                 "find T_robot_camera from the marker positions in the rest window");
  arguments.Option("--register-markers", &options.register_markers,
                   "a,b,c: register by these alone");
}

}  // namespace

int RunImport(const ImportOptions& options, std::ostream& report) {
  if (options.markers_sigma_m < 0.0) throw InputError("--markers-sigma must be > 0");
  const Target target = FindTarget(options);
  const bool is_new_experiment =
      !target.experiment_file.empty() && !fs::exists(target.experiment_file);
  const experiment::CapturedMarkers captured = ReadAndEdit(options);
  experiment::Recording recording = MakeRecording(options, captured);
  const std::optional<robot::RobotDescription> robot = ReadRobot(options);
  if (!target.experiment_file.empty() && !is_new_experiment) {
    CheckFits(options, robot, target.experiment_file);
  }
  if (robot) experiment::CheckMarkers(recording, MarkerNames(*robot));
  PrintQuality(captured, recording, report);
  if (options.register_to_robot) {
    if (!robot) throw InputError("--register needs --robot");
    recording.T_robot_camera = Register(options, recording, *robot, report);
  }
  PrintFrame(options, recording, report);

  experiment::WriteRecording(recording, target.recording);
  if (is_new_experiment) {
    experiment::WriteExperimentSettings(MakeExperiment(options, robot, *recording.frame),
                                        target.experiment_file);
  }
  report << "wrote " << target.recording.string() << '\n';
  return 0;
}

app::Verb ImportVerb() {
  return {"import", "Turn a motion-capture file (C3D or CSV) into a recording of an experiment",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<ImportOptions>();
            DeclareTarget(arguments, *options);
            DeclareEdits(arguments, *options);
            DeclareFrame(arguments, *options);
            return [options] { return RunImport(*options, std::cout); };
          }};
}

}  // namespace palpate::command

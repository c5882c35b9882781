// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/diagnose_verb.hpp"
#include "components/force_estimation/check_labels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>
#include <memory>
#include <optional>

#include "components/diagnosis/diagnose.hpp"
#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/report/report_html.hpp"
#include "components/diagnosis/report/verdict_json.hpp"
#include "components/diagnosis/vocabulary/verdict_words.hpp"
#include "components/offline/forces/pressure_correction.hpp"
#include "components/palpate/check_output.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/diagnose/force_gain.hpp"
#include "components/palpate/diagnose/surface_images.hpp"
#include "components/palpate/end_on_signal.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/images/perception_settings.hpp"
#include "components/palpate/import/import_options.hpp"
#include "components/palpate/recordings/data_folder.hpp"
#include "libs/app/process_tuning.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/version.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/names.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/utc_text.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/experiment/recording_hash.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

namespace fs = std::filesystem;

constexpr const char* kRobotFile = "robot.extended.yaml";
constexpr const char* kCalibrationFile = "calibration.extended.yaml";

/// The ids of --exclude, each of which may be a list with commas.
std::vector<std::string> ExcludedCauses(const DiagnoseOptions& options) {
  std::vector<std::string> ids;
  for (const std::string& list : options.exclude) {
    for (const std::string& id : SplitNames(list)) {
      if (!id.empty()) ids.push_back(id);
    }
  }
  return ids;
}

/// How the verdict's reader gets it again.
std::string CommandOf(const DiagnoseOptions& options) {
  std::string command =
      fmt::format("palpate diagnose {} --data {} --out {}", options.robot.string(),
                  options.data.string(), options.out.string());
  for (const std::string& rule : options.remap) command += " --remap " + rule;
  for (const std::string& id : options.exclude) command += " --exclude " + id;
  if (options.from != "all") command += " --from " + options.from;
  if (!options.calibration.empty()) command += " --calibration " + options.calibration.string();
  return command;
}

/// Messages have no experiment folder that the view could show.
std::vector<std::string> ViewCommandsOf(const DiagnoseOptions& options,
                                        const diagnosis::DiagnosisResult& result) {
  if (!fs::exists(options.data / "experiment.yaml")) return {};
  const std::string view = "palpate view " + options.data.string();
  std::vector<std::string> commands = {view + " --robot " + options.robot.string()};
  if (!result.causes.empty()) commands.push_back(view + " --results " + options.out.string());
  return commands;
}

void CheckCause(const std::string& option, const std::string& id,
                const std::vector<std::string>& known) {
  if (IndexOf(id, known)) return;
  throw InputError(option + ": " + Unknown("cause", id, known) + "; it is one of " + Listed(known));
}

std::string HashOf(const experiment::Experiment& experiment) {
  std::vector<const experiment::Recording*> recordings;
  for (const experiment::Recording& recording : experiment.recordings) {
    recordings.push_back(&recording);
  }
  return experiment::HashRecordings(recordings);
}

std::map<std::string, rgbd::CameraModel> DepthCamerasOf(const experiment::Experiment& experiment) {
  std::map<std::string, rgbd::CameraModel> cameras;
  for (const experiment::Recording& recording : experiment.recordings) {
    if (!recording.camera_file) continue;
    cameras[recording.name] = rgbd::ReadCameraFile(*recording.camera_file, app::LoadYaml).depth;
  }
  return cameras;
}

/// The pressure sensors of --calibration alone: what else it holds, the diagnosis finds itself.
robot::CalibrationFile ReadSensors(const fs::path& file, const robot::RobotDescription& robot) {
  robot::CalibrationFile sensors;
  if (file.empty()) return sensors;
  sensors.pressure_sensors = robot::ReadCalibrationFile(file, app::LoadYaml).pressure_sensors;
  std::vector<std::string> chambers;
  for (const robot::ChamberSettings& chamber : robot.chambers) chambers.push_back(chamber.name);
  for (const robot::CalibratedPressureSensor& sensor : sensors.pressure_sensors) {
    if (IndexOf(sensor.chamber, chambers)) continue;
    throw InputError("--calibration: " + Unknown("chamber", sensor.chamber, chambers) +
                     ", whose pressure sensor the file holds");
  }
  return sensors;
}

/// What is written holds for readings, as those of --calibration do.
void AddSensors(const robot::CalibrationFile& before, diagnosis::Diagnosis* diagnosis) {
  if (!diagnosis->calibration) return;
  for (robot::CalibratedPressureSensor& found : diagnosis->calibration->pressure_sensors) {
    for (const robot::CalibratedPressureSensor& sensor : before.pressure_sensors) {
      if (sensor.chamber == found.chamber) found = robot::Compose(sensor, found);
    }
  }
}

/// The experiment with the data that --from chooses, and pressures by these sensors.
experiment::Experiment ReadData(const fs::path& folder, const DiagnoseOptions& options,
                                const robot::CalibrationFile& sensors) {
  experiment::Experiment experiment = experiment::ReadExperiment(folder, app::LoadYaml);
  offline::CorrectPressures(sensors, &experiment);
  for (const experiment::Recording& recording : experiment.recordings) RequireLoads(recording);
  if (options.from != "depth") return experiment;
  for (experiment::Recording& recording : experiment.recordings) recording.markers.reset();
  return experiment;
}

/// More points would not determine some fifty surface points any better.
perception::Config ImageSettings(const DiagnoseOptions& options,
                                 const experiment::Experiment& experiment) {
  constexpr int kEnoughPoints = 4000;
  std::vector<std::string> overrides = {"perception.max_cloud_points=" +
                                        std::to_string(kEnoughPoints)};
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  return PerceptionOf(overrides, experiment);
}

/// Data that cannot be used are a verdict; a wrong robot file or option is an error.
diagnosis::Diagnosis DiagnoseData(const fs::path& folder, const DiagnoseOptions& options,
                                  const robot::RobotDescription& robot,
                                  const app::StopSignal& stop) {
  const robot::CalibrationFile sensors = ReadSensors(options.calibration, robot);
  const auto begin = std::chrono::steady_clock::now();
  int steps = 1;
  const auto report = [&](int done, int of, const std::string& what) {
    steps = of;
    fmt::print(stderr, "{}\n",
               StepLine(done, of, what, SecondsSince(begin), 60.0 * options.most_minutes));
  };
  try {
    const experiment::Experiment experiment = ReadData(folder, options, sensors);
    const robot::RobotBody body = robot::BuildRobotBody(robot);
    PrintWarnings(body);
    force_estimation::CheckMarkerLabels(experiment, robot);
    const fem::PointLocator places(body.mesh);
    for (const experiment::Recording& recording : experiment.recordings) {
      RequireLoadsOnBody(recording, places);
    }
    std::optional<SurfaceImages> images;
    if (options.from != "markers" && HasSurfaceImages(experiment)) {
      images.emplace(experiment, body, ImageSettings(options, experiment));
    }
    diagnosis::Diagnosis diagnosis =
        diagnosis::Diagnose(robot, experiment,
                            {.excluded = ExcludedCauses(options),
                             .most_samples = options.most_samples,
                             .threads = options.threads,
                             .longest_s = 60.0 * options.most_minutes,
                             .stop_requested = [&] { return stop.Requested(); },
                             .noise = {},
                             .depth_cameras = DepthCamerasOf(experiment),
                             .surface_source = images ? &*images : nullptr},
                            report);
    if (!diagnosis.result.interrupted && !diagnosis.result.causes.empty()) {
      report(steps - 1, steps, "estimating the forces at known loads");
      diagnosis.result.force_error =
          MeasureForceError(robot, diagnosis, experiment, options.threads, [&] {
            const double longest_s = 60.0 * options.most_minutes;
            return stop.Requested() || (longest_s > 0.0 && SecondsSince(begin) > longest_s);
          });
    }
    AddSensors(sensors, &diagnosis);
    diagnosis.result.data_hash = HashOf(experiment);
    return diagnosis;
  } catch (const InputError& error) {
    diagnosis::Diagnosis unfit;
    unfit.result = diagnosis::Unfit(error.what());
    unfit.extended = robot;
    return unfit;
  }
}

/// Who made the extended robot file, and what it changes, as comments of YAML.
std::string CommentOf(const diagnosis::Diagnosis& diagnosis) {
  const diagnosis::DiagnosisResult& result = diagnosis.result;
  std::vector<std::string> lines = {
      "Written by palpate diagnose " + result.version + " from the robot file of " + result.robot,
      "and " + result.data + " (" + result.data_hash + ").",
      "It holds the named causes. The fitted tolerances, with which the report's errors are "
      "computed, are left out."};
  const std::vector<std::string> changes = diagnosis::ChangeTexts(result);
  for (const std::string& change : changes) lines.push_back(change + ".");
  if (changes.empty()) lines.emplace_back("No value is changed.");
  for (const std::string& words : diagnosis.not_in_files)
    lines.push_back("Not held by this file: " + words + ".");
  std::string text;
  for (std::string& line : lines) {
    // Names come from the user: a line that ends early would be no comment.
    std::replace(line.begin(), line.end(), '\n', ' ');
    text += "# " + line + "\n";
  }
  return text;
}

/// What another verb takes must not be there beside a partial report: that of an interrupted run
/// is not written, and that of an earlier one is removed.
void Write(const fs::path& folder, const std::vector<std::string>& view_commands,
           diagnosis::Diagnosis* diagnosis) {
  experiment::CreateFolder(folder);
  if (diagnosis->result.interrupted) {
    for (const char* file : {kRobotFile, kCalibrationFile}) fs::remove(folder / file);
  }
  WriteFile(folder / "verdict.json", FormatVerdict(diagnosis->result));
  WriteFile(folder / "report.html", FormatReport(diagnosis->result, view_commands));
  const diagnosis::DiagnosisResult& result = diagnosis->result;
  if (result.verdict == diagnosis::Verdict::kDataUnfit || result.interrupted) return;
  WriteFile(folder / kRobotFile,
            CommentOf(*diagnosis) + FormatRobotFile(diagnosis->extended, folder));
  if (!diagnosis->calibration) return;
  robot::CalibrationFile& calibration = *diagnosis->calibration;
  calibration.date_utc = UtcText(std::time(nullptr));
  calibration.data = diagnosis->result.data;
  calibration.data_hash = diagnosis->result.data_hash;
  calibration.residual_rms_m = diagnosis->result.model_error.after_m;
  WriteCalibrationFile(calibration, folder / kCalibrationFile);
}

void WriteNext(const fs::path& out, const diagnosis::Diagnosis& diagnosis) {
  diagnosis::WritePlans(diagnosis.next, out);
  if (diagnosis.next.empty()) {
    fmt::print("no experiment is planned: the data leave no two causes undecided\n");
    return;
  }
  fmt::print("the next experiment is in {}: {}\n", (out / "plan").string(),
             diagnosis.next.front().ranked.proposal.title);
}

void PrintExplanation(const std::string& id, const diagnosis::DiagnosisResult& result) {
  bool found = false;
  for (const diagnosis::NamedCause& cause : result.causes) {
    if (cause.name.id != id) continue;
    fmt::print("{}: named\n", cause.words);
    found = true;
  }
  for (const diagnosis::Rival& rival : result.rivals) {
    if (rival.name.id != id) continue;
    fmt::print("{}: {} (ln BF {:.1f}, correlation with the named cause {:.2f})\n", rival.words,
               rival.why_not, rival.ln_bayes_factor, rival.canonical_correlation);
    found = true;
  }
  if (!found) {
    fmt::print("{}: not observable on this robot with these data, or excluded\n", id);
  }
}

}  // namespace

std::string StepLine(int done, int of, const std::string& what, double elapsed_s,
                     double longest_s) {
  std::string line =
      fmt::format("step {} of at most {}: {} ({:.0f} s so far", done + 1, of, what, elapsed_s);
  if (longest_s > 0.0 && elapsed_s < longest_s) {
    line += fmt::format("; the search ends after {:.0f} s", longest_s);
  } else if (longest_s > 0.0) {
    line += fmt::format("; the {:.0f} s are over, only what a verdict needs is done", longest_s);
  }
  return line + ")";
}

int Diagnose(const DiagnoseOptions& options) {
  for (const std::string& id : ExcludedCauses(options))
    CheckCause("--exclude", id, diagnosis::CatalogueIds());
  if (!options.explain.empty())
    CheckCause("--explain", options.explain, diagnosis::SearchedFaults());
  CheckOutputFolder(options.out);
  app::KeepLargeBlocks();               // memory of one fit for the next
  PerceptionOf(options.overrides, {});  // refused before anything is computed
  const auto begin = std::chrono::steady_clock::now();
  const robot::RobotDescription robot =
      robot::ReadRobotFile(FindRobotFile(options.robot), app::LoadYaml);
  std::optional<EndOnSignal> end_on_signal;
  end_on_signal.emplace("palpate diagnose", "nothing was written");
  const DataFolder data(options.data, options.remap, FindRobotFile(options.robot));
  end_on_signal.reset();
  const app::StopSignal stop([] {
    fmt::print(stderr,
               "palpate diagnose: interrupted: the search ends, and what it found is written; a "
               "second Ctrl-C ends at once, with nothing written\n");
  });
  diagnosis::Diagnosis diagnosis = DiagnoseData(data.path(), options, robot, stop);
  diagnosis::DiagnosisResult& result = diagnosis.result;
  result.robot = robot.name;
  result.data = options.data.string();
  result.reason = data.Named(result.reason);
  result.version = app::Version();
  result.command = CommandOf(options);
  result.duration_s = SecondsSince(begin);
  Write(options.out, ViewCommandsOf(options, result), &diagnosis);
  fmt::print("{}\n", VerdictParagraph(result));
  if (result.interrupted) {
    throw app::Interrupted(
        fmt::format("during the search: the partial report is in {}; no robot file was written",
                    options.out.string()));
  }
  for (const std::string& words : diagnosis.not_in_files) {
    fmt::print("{}: not written to the extended files, whose formats have no key for it\n", words);
  }
  if (options.plan) WriteNext(options.out, diagnosis);
  if (!options.explain.empty()) PrintExplanation(options.explain, result);
  return result.verdict == diagnosis::Verdict::kDataUnfit ? app::kExitFailed : app::kExitDone;
}

app::Verb DiagnoseVerb() {
  return {"diagnose", "Identify model errors from measured data and write a corrected robot file",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<DiagnoseOptions>();
            DeclareRobot(arguments, &options->robot);
            arguments.Option("--data FOLDER", &options->data,
                             "Experiment folder, or MCAP or .db3 file or folder of them",
                             app::Need::kRequired);
            DeclareRemap(arguments, &options->remap);
            arguments.Option("--calibration", &options->calibration,
                             "Calibration file, whose pressure sensors correct the pressures that "
                             "were read; nothing else of it is used");
            arguments.Option("--out FOLDER", &options->out,
                             "Folder of verdict.json, report.html and robot.extended.yaml",
                             app::Need::kRequired);
            arguments.Repeated("--exclude ID", &options->exclude,
                               "Exclude this cause, or these (ID,ID), from the search");
            arguments.Suggest("--exclude", diagnosis::CatalogueIds());
            arguments.Option("--explain ID", &options->explain,
                             "Print why this cause was named, or why not");
            arguments.Suggest("--explain", diagnosis::SearchedFaults());
            arguments.Choice("--from", &options->from, {"all", "markers", "depth"},
                             "Data to use: markers only, depth images and point clouds only "
                             "(depth), or all");
            arguments.Repeated("--set KEY=VALUE", &options->overrides,
                               "Change one setting perception.* of the image processing");
            arguments.Flag("--plan", &options->plan,
                           "Also plan the next experiment: the best one in OUT/plan, the others "
                           "in OUT/plan_others");
            arguments.Option("--samples", &options->most_samples, 10, 2000,
                             "Maximum number of time samples used in the fit");
            arguments.Option(
                "--minutes", &options->most_minutes, 0, 100000,
                "Time limit of the search, minutes; 0: unlimited. Where the null model would "
                "take more than a third of it, fewer samples are used");
            arguments.Option("--threads", &options->threads, 1, 64,
                             "Number of recordings processed in parallel");
            return [options] { return Diagnose(*options); };
          }};
}

}  // namespace palpate::command

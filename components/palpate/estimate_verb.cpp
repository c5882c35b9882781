// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate_verb.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "components/force_estimation/config.hpp"
#include "components/force_estimation/marker_force_estimator.hpp"
#include "components/force_estimation/recording_frames.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/force_summary.hpp"
#include "components/palpate/forces_table.hpp"
#include "components/palpate/progress_line.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/settings.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/robot/calibration_file.hpp"

namespace palpate::command {

namespace {

using experiment::Experiment;
using experiment::Recording;

force_estimation::Config ReadConfig(const EstimateOptions& options) {
  force_estimation::Config config;
  const std::vector<app::Setting> settings = app::ListSettings(config);
  if (!options.config.empty()) {
    app::LoadSettings(app::LoadYaml(options.config), settings);
  }
  for (const std::string& assignment : options.overrides) {
    app::ApplyOverride(assignment, settings);
  }
  config.contacts.insert(config.contacts.end(), options.contacts.begin(), options.contacts.end());
  return config;
}

// Gives the model the calibrated moduli; returns their relative standard error.
double ApplyCalibration(const std::filesystem::path& file, robot::RobotModel* model) {
  if (file.empty()) {
    fmt::print(stderr,
               "palpate estimate: no --calibration: the moduli of the robot file are "
               "taken as they are\n");
    return 0.0;
  }
  const auto calibration = robot::ReadCalibrationFile(file, app::LoadYaml);
  robot::ApplyCalibration(calibration, model);
  return robot::RelativeModulusError(calibration);
}

std::vector<const Recording*> RecordingsToEstimate(const Experiment& experiment,
                                                   const std::vector<std::string>& names) {
  if (!names.empty()) {
    return ChooseRecordings(experiment, names);
  }
  std::vector<const Recording*> with_markers;
  for (const Recording& recording : experiment.recordings) {
    if (recording.markers) {
      with_markers.push_back(&recording);
    }
  }
  if (with_markers.empty()) {
    throw InputError(experiment.folder.string() + ": no recording has markers");
  }
  return with_markers;
}

// One estimator for each recording: what it learns from one does not hold for the next.
class RecordingEstimator {
 public:
  RecordingEstimator(force_estimation::Config config, const std::string& cable_input,
                     const Experiment& experiment, robot::RobotModel* model, double modulus_error)
      : config_(std::move(config)),
        cable_input_(ParseCableInput(cable_input)),
        experiment_(experiment),
        model_(*model),
        gravity_m_s2_(model->gravity_m_s2()),
        modulus_error_(modulus_error) {}

  // Returns how many frames had a result (a force, or the finding that there is none).
  int Estimate(const Recording& recording, ForcesTable* table, ForceSummary* summary) {
    model_.SetGravity(experiment::BaseRotation(recording).transpose() * gravity_m_s2_);
    force_estimation::MarkerForceEstimator estimator(model_, config_, modulus_error_);
    const auto frames =
        force_estimation::FramesOfRecording(experiment_, recording, model_, cable_input_);
    ProgressLine progress("frames", static_cast<int>(frames.size()));
    int done = 0;
    int with_result = 0;
    for (const force_estimation::MarkerFrame& frame : frames) {
      const force_estimation::ForceEstimate& estimate = estimator.Update(frame);
      table->Add(recording.name, estimate);
      summary->Add(estimate);
      with_result +=
          estimate.status.ok() || estimate.status.code() == StatusCode::kNoContact ? 1 : 0;
      progress.Update(++done);
    }
    return with_result;
  }

 private:
  force_estimation::Config config_;
  robot::CableInput cable_input_;
  const Experiment& experiment_;
  robot::RobotModel& model_;
  Eigen::Vector3d gravity_m_s2_;
  double modulus_error_;
};

}  // namespace

int Estimate(const EstimateOptions& options) {
  const force_estimation::Config config = ReadConfig(options);
  const auto model = LoadRobot(options.robot, {config.solver, config.threads});
  const double modulus_error = ApplyCalibration(options.calibration, model.get());
  const Experiment experiment = experiment::ReadExperiment(options.data, app::LoadYaml);
  const auto recordings = RecordingsToEstimate(experiment, options.recordings);
  RecordingEstimator estimator(config, options.cable_input, experiment, model.get(), modulus_error);
  ForcesTable table;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  int with_result = 0;
  for (const Recording* recording : recordings) {
    ForceSummary summary(recording->name, recording->steady_window_s);
    with_result += estimator.Estimate(*recording, &table, &summary);
    json.push_back(summary.ToJson());
    if (!options.json) {
      fmt::print("{}", summary.ToText());
      std::fflush(stdout);
    }
  }
  table.Write(options.out);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("written to {}\n", options.out.string());
  }
  return with_result > 0 ? app::kExitDone : app::kExitFailed;
}

app::Verb EstimateVerb() {
  return {
      "estimate", "Estimate the forces on a robot from its measured markers",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<EstimateOptions>();
        arguments.Positional("ROBOT", &options->robot,
                             "robot file, or the name of a robot that comes with palpate");
        arguments.Option("--data", &options->data, "experiment or recording folder",
                         app::Need::kRequired);
        arguments.Option("--out", &options->out, "forces.csv to write", app::Need::kRequired);
        arguments.Option("--calibration", &options->calibration, "what `palpate calibrate` found");
        arguments.Repeated("--recording", &options->recordings,
                           "this recording (repeatable); else all with markers");
        arguments.Repeated("--contact", &options->contacts,
                           "where a force may act, \"name: x, y, z[, patch radius]\" in m on the "
                           "undeformed body (repeatable); else the contact is searched");
        arguments.Option("--config", &options->config, "settings of force_estimation, YAML");
        arguments.Repeated("--set", &options->overrides, "one of these settings, KEY=VALUE");
        arguments.Choice("--cable-input", &options->cable_input, {"displacement", "tension"},
                         "what is imposed on a cable where both were measured");
        arguments.Flag("--json", &options->json, "print a summary as JSON");
        return [options] { return Estimate(*options); };
      }};
}

}  // namespace palpate::command

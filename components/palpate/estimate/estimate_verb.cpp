// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/estimate_verb.hpp"

#include <memory>
#include <optional>

#include "components/palpate/check_output.hpp"
#include "components/palpate/choose_recordings.hpp"
#include "components/palpate/end_on_signal.hpp"
#include "components/palpate/estimate/estimate_run.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/recordings/data_folder.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

void DeclareOutputs(app::Arguments& arguments, EstimateOptions* options) {
  arguments.Option("--out", &options->out, "CSV file of the forces to write", app::Need::kRequired);
  arguments.Option(
      "--plot FILE.svg", &options->plot,
      "SVG file to draw: forces over time with 95 % bands, one panel for each contact; "
      "several recordings have one file each, FILE_RECORDING.svg");
  arguments.Option("--answer FILE.json", &options->answer,
                   "Ground truth of palpate simulate (EXP.answer.json): print errors, coverage of "
                   "the intervals, missed forces and false alarms, and draw the truth in --plot");
  arguments.Flag("--json", &options->json, "Print the summary as JSON");
}

void CheckOptions(const EstimateOptions& options) {
  CheckOutputFile(options.out);
  if (!options.plot.empty()) CheckOutputFile(options.plot);
  if (options.rate_Hz < 0.0) {
    throw InputError("--rate: must be 0 or more, not " + FormatNumber(options.rate_Hz));
  }
}

int EstimateInFolder(const std::filesystem::path& folder, const EstimateOptions& options) {
  experiment::Experiment experiment = experiment::ReadExperiment(folder, app::LoadYaml);
  const EstimateSettings settings =
      ReadEstimateSettings(experiment, options.config, options.overrides, options.contacts,
                           options.bias_frames == "first");
  const auto plan = offline::PlanEstimates(
      experiment, ChooseRecordings(experiment, options.recordings), options.from);
  const auto model = LoadRobot(options.robot, {settings.forces.solver, settings.forces.threads},
                               options.calibration);
  const app::StopSignal stop;
  EstimateRun run(options, settings, &experiment, model.get(), [&] { return stop.Requested(); });
  run.Prepare(plan);
  for (const offline::PlannedRecording& planned : plan) {
    if (!stop.Requested()) run.Estimate(planned, /*is_only=*/plan.size() == 1);
  }
  return run.Finish();
}

}  // namespace

int Estimate(const EstimateOptions& options) {
  CheckOptions(options);
  std::optional<EndOnSignal> end_on_signal;
  end_on_signal.emplace("palpate estimate", "no force was estimated");
  const DataFolder data(options.data, options.remap, FindRobotFile(options.robot));
  end_on_signal.reset();  // from here on what is estimated so far is kept
  return data.Run(
      [&](const std::filesystem::path& folder) { return EstimateInFolder(folder, options); });
}

app::Verb EstimateVerb() {
  return {
      "estimate", "Estimate contact forces from recorded images or markers",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<EstimateOptions>();
        DeclareRobot(arguments, &options->robot);
        arguments.Option("--data FOLDER", &options->data,
                         "Experiment or recording folder, or MCAP or .db3 file or folder of them",
                         app::Need::kRequired);
        DeclareRemap(arguments, &options->remap);
        DeclareOutputs(arguments, options.get());
        arguments.Option("--calibration", &options->calibration,
                         "Calibration file of palpate calibrate; without it the robot file's "
                         "moduli hold and the camera pose is the experiment's");
        arguments.Repeated("--recording NAME", &options->recordings,
                           "Use this recording; without it all that have images or markers");
        arguments.Choice("--from", &options->from, {"shape", "markers"},
                         "Measurement: shape (depth and colour images) or markers; without it "
                         "images where a recording has them, else markers");
        arguments.Choice("--bias-frames", &options->bias_frames, {"recordings", "first", "none"},
                         "Contact-free frames used to estimate the depth bias: those of "
                         "contact-free recordings, which are checked, else, without a calibrated "
                         "bias, first frames that pass the check; the first "
                         "shape.untouched_frames frames, all as in palpate-force-estimation; or "
                         "none");
        arguments.Repeated("--contact SITE", &options->contacts,
                           "Possible contact location \"name: x, y, z[, patch radius]\", m, on the "
                           "undeformed body; without it known loads (loads.csv) are contacts of "
                           "known place and unknown force, and others are searched");
        arguments.Option("--config", &options->config,
                         "Settings file (YAML): settings of palpate-force-estimation, shape.* and "
                         "perception.*");
        arguments.Repeated("--set KEY=VALUE", &options->overrides,
                           "Change one of these settings; overrides the settings file");
        arguments.Option("--rate HZ", &options->rate_Hz,
                         "Largest frame rate to estimate, Hz: frames in between are left out; 0: "
                         "all frames");
        DeclareCableInput(arguments, &options->cable_input);
        return [options] { return Estimate(*options); };
      }};
}

}  // namespace palpate::command

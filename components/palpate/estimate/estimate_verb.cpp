// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/estimate_verb.hpp"

#include <memory>

#include "components/palpate/estimate/estimate_run.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/app/yaml.hpp"

namespace palpate::command {

int Estimate(const EstimateOptions& options) {
  experiment::Experiment experiment = experiment::ReadExperiment(options.data, app::LoadYaml);
  const EstimateSettings settings =
      ReadEstimateSettings(experiment, options.config, options.overrides, options.contacts);
  const auto plan = PlanEstimates(experiment, options.recordings, options.from);
  const auto model = LoadRobot(options.robot, {settings.forces.solver, settings.forces.threads},
                               options.calibration);
  EstimateRun run(options, settings, &experiment, model.get());
  run.EstimateDepthBias(plan);
  run.CalibrateMarkerOffsets(plan);
  for (const PlannedRecording& planned : plan) run.Estimate(planned);
  return run.Finish();
}

app::Verb EstimateVerb() {
  return {
      "estimate", "Estimate contact forces from recorded images or markers",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<EstimateOptions>();
        DeclareRobot(arguments, &options->robot);
        arguments.Option("--data FOLDER", &options->data, "Experiment or recording folder",
                         app::Need::kRequired);
        arguments.Option("--out", &options->out, "CSV file of the forces to write",
                         app::Need::kRequired);
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
                         "contact-free recordings; the first shape.untouched_frames frames, as in "
                         "palpate-force-estimation; or none");
        arguments.Repeated("--contact SITE", &options->contacts,
                           "Possible contact location \"name: x, y, z[, patch radius]\", m, on the "
                           "undeformed body; without it contacts are searched, and images use "
                           "the locations of known loads (loads.csv)");
        arguments.Option("--config", &options->config,
                         "Settings file (YAML): settings of palpate-force-estimation, shape.* and "
                         "perception.*");
        arguments.Repeated("--set KEY=VALUE", &options->overrides,
                           "Change one of these settings; overrides the settings file");
        DeclareCableInput(arguments, &options->cable_input);
        arguments.Flag("--json", &options->json, "Print the summary as JSON");
        return [options] { return Estimate(*options); };
      }};
}

}  // namespace palpate::command

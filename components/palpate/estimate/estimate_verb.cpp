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
  run.Teach(plan);
  for (const PlannedRecording& planned : plan) run.Estimate(planned);
  return run.Finish();
}

app::Verb EstimateVerb() {
  return {
      "estimate", "Estimate the forces on a robot from its shape, or its markers, as recorded",
      [](app::Arguments& arguments) -> app::Verb::Action {
        const auto options = std::make_shared<EstimateOptions>();
        arguments.Positional("ROBOT", &options->robot,
                             "robot file, or the name of a robot that comes with palpate");
        arguments.Option("--data", &options->data, "experiment or recording folder",
                         app::Need::kRequired);
        arguments.Option("--out", &options->out, "forces.csv to write", app::Need::kRequired);
        arguments.Option("--calibration", &options->calibration, "what `palpate calibrate` found");
        arguments.Repeated("--recording", &options->recordings,
                           "this recording (repeatable); else all with images or markers");
        arguments.Choice("--from", &options->from, {"shape", "markers"},
                         "from depth and colour, or from markers; else from images where a "
                         "recording has them");
        arguments.Choice("--teachers", &options->teachers, {"recordings", "first", "none"},
                         "which frames teach the depth bias: those of recordings in which nobody "
                         "touches the robot; the first shape.untouched_frames, as "
                         "palpate-force-estimation does; none");
        arguments.Repeated("--contact", &options->contacts,
                           "where a force may act, \"name: x, y, z[, patch radius]\" in m on the "
                           "undeformed body (repeatable); else the contact is searched, and known "
                           "loads act where they are");
        arguments.Option("--config", &options->config,
                         "settings: those of palpate-force-estimation, shape.*, perception.*");
        arguments.Repeated("--set", &options->overrides, "one of these settings, KEY=VALUE");
        arguments.Choice("--cable-input", &options->cable_input, {"displacement", "tension"},
                         "what is imposed on a cable where both were measured");
        arguments.Flag("--json", &options->json, "print a summary as JSON");
        return [options] { return Estimate(*options); };
      }};
}

}  // namespace palpate::command

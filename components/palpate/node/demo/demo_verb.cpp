// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/demo_verb.hpp"

#include <memory>

#include "libs/core/error.hpp"

namespace palpate::command {

int Demo(const DemoOptions& options) {
  const SystemDemoOptions& system = options.system;
  if (options.recording == "beam" || options.computed) {
    if (!system.scenario.empty() || !system.robot.empty()) {
      throw InputError("--robot and --scenario do not go with the recording of the beam");
    }
    return BeamDemo({.out = system.out, .data = system.data, .computed = options.computed});
  }
  if (!system.data.empty() && !system.scenario.empty()) {
    throw InputError("either --data (recordings) or --scenario (virtual bench)");
  }
  if (!system.data.empty() && system.robot.empty()) {
    throw InputError("--data needs --robot: whose recordings are these?");
  }
  return SystemDemo(system);
}

app::Verb DemoVerb() {
  return {"demo", "See it work: forces on a soft robot, felt through a depth camera, live",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<DemoOptions>();
            SystemDemoOptions& system = options->system;
            arguments.Option("--out", &system.out,
                             "folder for the results; else demo/ in the build folder");
            arguments.Option("--seconds", &system.seconds, 1, 86400,
                             "how long the system is watched; else 30 s, or all of --data");
            arguments.Option("--robot", &system.robot, "robot file or name; else four_leg");
            arguments.Option("--scenario", &system.scenario,
                             "what the virtual bench does; else sensing.yaml");
            arguments.Option("--data", &system.data,
                             "an experiment with depth images to play instead of the virtual "
                             "bench; of the beam: the folder with silicone_beam");
            arguments.Option("--calibration", &system.calibration,
                             "what `palpate calibrate` found for the robot");
            arguments.Choice("--recording", &options->recording, {"beam"},
                             "play the measured beam with a weight instead, from its markers");
            arguments.Flag("--computed", &options->computed,
                           "play the computed beam, though the measured one is there");
            return [options] { return Demo(*options); };
          }};
}

}  // namespace palpate::command

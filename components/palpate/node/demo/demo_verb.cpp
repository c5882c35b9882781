// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/demo_verb.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/palpate/end_on_signal.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/recordings/data_folder.hpp"
#include "libs/app/node_options.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

int Demo(const DemoOptions& options) {
  const SystemDemoOptions& system = options.system;
  if (options.recording == "beam" || options.computed) {
    if (!system.scenario.empty() || !system.robot.empty()) {
      throw InputError("--recording beam and --computed take neither --robot nor --scenario");
    }
    return BeamDemo({.out = system.out,
                     .data = system.data,
                     .computed = options.computed,
                     .no_view = system.no_view});
  }
  if (!system.data.empty() && !system.scenario.empty()) {
    throw InputError(
        "--data (recordings) and --scenario (virtual robot) exclude each other: give one");
  }
  if (!system.data.empty() && system.robot.empty()) {
    throw InputError("--data needs --robot: the robot of these recordings");
  }
  std::optional<EndOnSignal> end_on_signal;
  end_on_signal.emplace("palpate demo", "nothing was written");
  SystemDemoOptions of_folder = system;
  std::vector<std::string> of_messages;
  if (!system.data.empty()) {
    // The player publishes an experiment under the usual names: only a namespace is left to choose.
    const auto of_processes =
        std::stable_partition(of_folder.remap.begin(), of_folder.remap.end(),
                              [](const std::string& rule) { return rule.starts_with("__"); });
    of_messages.assign(of_processes, of_folder.remap.end());
    of_folder.remap.erase(of_processes, of_folder.remap.end());
  }
  const DataFolder data(
      system.data, of_messages,
      system.data.empty() ? std::filesystem::path() : FindRobotFile(system.robot));
  end_on_signal.reset();
  of_folder.data = data.path();
  return data.Run([&](const std::filesystem::path&) { return SystemDemo(of_folder); });
}

app::Verb DemoVerb() {
  return {"demo", "Run the whole system on a virtual robot and compare its forces with the truth",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<DemoOptions>();
            SystemDemoOptions& system = options->system;
            arguments.Option("--out FOLDER", &system.out,
                             "Folder of the results; without it demo in the build folder, or "
                             "palpate_demo here where palpate is installed");
            arguments.Option(
                "--seconds", &system.seconds, 1, 86400,
                "Duration, s; without it 30 s of the virtual robot's time, or all of --data");
            arguments.Flag("--no-view", &system.no_view, "Run without the live page");
            DeclareRobotOption(arguments, &system.robot,
                               "the robot to simulate, or the one of --data; without it four_leg");
            arguments.Option("--scenario", &system.scenario,
                             "Scenario of the virtual robot; without it touches by the robot's "
                             "size and stiffness, of four_leg config/scenarios/sensing.yaml");
            arguments.Option(
                "--data FOLDER", &system.data,
                "Experiment folder, or MCAP or .db3 file or folder of them, with depth "
                "images to play instead of the virtual robot; with --recording beam the folder "
                "that holds silicone_beam");
            arguments.Repeated("--remap FROM:=TO", &system.remap,
                               "Another name for a topic of the processes, or __ns:=/left for all; "
                               "with --data FROM is a topic of the recorded messages");
            arguments.Option("--calibration", &system.calibration,
                             "Calibration file of palpate calibrate; without it the robot file's "
                             "moduli hold");
            arguments.Choice("--recording", &options->recording, {"beam"},
                             "Play a recorded beam with a weight instead, from its markers");
            arguments.Flag("--computed", &options->computed,
                           "Play the computed beam even where the measured one is available");
            app::DeclareSecurity(arguments, &options->keystore);
            return [options] {
              app::SettleSecurity(options->keystore);
              return Demo(*options);
            };
          }};
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/node/command_line.hpp"

#include <limits>

#include "libs/app/log.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/sha256.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/scenario/robot_names.hpp"

namespace palpate::virtual_robot {

namespace {

BenchSetup OpenBench(const Command& command) {
  const auto robot = robot::ReadRobotFile(command.robot, app::LoadYaml);
  const auto scenario = scenario::ReadScenario(command.scenario, app::LoadYaml);
  const auto seed = static_cast<std::uint64_t>(command.seed);
  const scenario::RobotNames names = scenario::NamesOf(robot);
  scenario::CheckAgainst(scenario, names);
  const auto effects = scenario::DrawEffects(scenario, names, seed);
  return {std::make_unique<VirtualRobot>(robot, scenario, effects, seed, command.config.threads),
          robot.name,
          names.Actuators(),
          scenario::Schedule(scenario, names.Actuators()),
          Sha256Hex(ReadFile(command.scenario)),
          seed};
}

}  // namespace

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments("palpate-virtual-robot",
                           "Simulate a soft robot under the commands and loads of a scenario");
  app::DeclareRobotToRun(arguments, &command.robot);
  arguments.Option("--scenario", &command.scenario,
                   "Scenario file: commands, loads and hidden effects; required to run");
  arguments.Option("--seed", &command.seed, 0, std::numeric_limits<int>::max(),
                   "Random seed (noise, manufacturing tolerances, unspecified effects)");
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  command.robot = app::RobotFileToRun(command.robot);
  if (command.scenario.empty()) throw InputError("--scenario is required: give a scenario file");
  return command;
}

std::unique_ptr<VirtualRobotNode> MakeNode(const Command& command) {
  return std::make_unique<VirtualRobotNode>(
      command.config, OpenBench(command), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::virtual_robot

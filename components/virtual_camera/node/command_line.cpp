// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_camera/node/command_line.hpp"

#include <limits>
#include <string>
#include <vector>

#include "libs/app/log.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/sha256.hpp"
#include "libs/core/text.hpp"
#include "libs/scenario/robot_names.hpp"

namespace palpate::virtual_camera {

namespace {

/// The number of the camera of that name; empty: the first.
std::size_t NumberOf(const std::string& name, const scenario::Scenario& scenario) {
  if (name.empty()) return 0;
  std::vector<std::string> names;
  for (const scenario::FurtherCamera& camera : scenario.further_cameras) {
    names.push_back(camera.name);
    if (camera.name == name) return names.size();
  }
  throw InputError("camera_name: scenario '" + scenario.name + "' has no further camera '" + name +
                   "'" + DidYouMean(name, names));
}

Scene OpenScene(const Command& command) {
  const auto robot = robot::ReadRobotFile(command.robot, app::LoadYaml);
  const auto scenario = scenario::ReadScenario(command.scenario, app::LoadYaml);
  const auto seed = static_cast<std::uint64_t>(command.seed);
  const scenario::RobotNames names = scenario::NamesOf(robot);
  scenario::CheckAgainst(scenario, names);
  Scene scene{scenario::Schedule(scenario, names.Actuators()),
              Sha256Hex(ReadFile(command.scenario)),
              seed,
              scenario::DrawEffects(scenario, names, seed),
              {},
              NumberOf(command.config.camera_name, scenario)};
  scene.markers_m.resize(3, ToIndex(robot.markers.size()));
  for (size_t m = 0; m < robot.markers.size(); ++m) {
    scene.markers_m.col(ToIndex(m)) = robot.markers[m].position_m;
  }
  return scene;
}

}  // namespace

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments("palpate-virtual-camera",
                           "Stream RGB-D frames of palpate-virtual-robot as a GigE Vision camera");
  app::DeclareRobotToRun(arguments, &command.robot);
  arguments.Option("--scenario", &command.scenario,
                   "Scenario file that the virtual robot runs; required to run");
  arguments.Option("--seed", &command.seed, 0, std::numeric_limits<int>::max(),
                   "Random seed of the virtual robot");
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  command.robot = app::RobotFileToRun(command.robot);
  if (command.scenario.empty())
    throw InputError("--scenario is required: give the scenario file of the virtual robot");
  return command;
}

std::unique_ptr<VirtualCameraNode> MakeNode(const Command& command) {
  return std::make_unique<VirtualCameraNode>(
      command.config, OpenScene(command), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::virtual_camera

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/command_line.hpp"

#include <limits>
#include <utility>

#include "libs/app/log.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::player {

namespace {

/// At most one of --rate, --step, --as-fast-as-possible.
void SettlePlayback(const app::Arguments& arguments, bool as_fast_as_possible, Playback* playback) {
  const bool rate_given = arguments.WasGiven("--rate");
  if (int{rate_given} + int{playback->step} + int{as_fast_as_possible} > 1) {
    throw InputError("only one of --rate, --step and --as-fast-as-possible can be given");
  }
  if (playback->rate <= 0.0) {
    throw InputError("--rate: must be above 0, not " + FormatNumber(playback->rate));
  }
  if (as_fast_as_possible) playback->rate = std::numeric_limits<double>::infinity();
}

ExperimentPlayer OpenExperiment(const Command& command) {
  experiment::Experiment experiment = experiment::ReadExperiment(command.data, app::LoadYaml);
  if (command.images) {
    return ExperimentPlayer::OfImages(std::move(experiment), command.recording, app::LoadYaml);
  }
  return {std::move(experiment), command.recording, command.config.frame == "robot"};
}

}  // namespace

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  bool as_fast_as_possible = false;
  app::Arguments arguments("palpate-player", "Publish recorded data as if the robot ran now");
  arguments.Option("--data FOLDER", &command.data,
                   "Experiment or recording folder; required to run");
  arguments.Option("--recording NAME", &command.recording,
                   "Play this recording only; without it all");
  arguments.Flag("--images", &command.images, "Publish depth and colour images instead of markers");
  arguments.Option("--rate FACTOR", &command.playback.rate, "Speed relative to real time, above 0");
  arguments.Flag("--step", &command.playback.step,
                 "Publish each frame when /forces has answered the last one; loses no frame");
  arguments.Flag("--as-fast-as-possible", &as_fast_as_possible, "Publish frames without waiting");
  arguments.Flag("--loop", &command.playback.loop, "Begin again at the end");
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  if (command.data.empty()) {
    throw InputError("--data is required: give an experiment or recording folder");
  }
  SettlePlayback(arguments, as_fast_as_possible, &command.playback);
  return command;
}

std::unique_ptr<PlayerNode> MakeNode(const Command& command) {
  return std::make_unique<PlayerNode>(
      command.config, command.playback, OpenExperiment(command), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::player

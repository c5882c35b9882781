// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/player/node/command_line.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "libs/app/log.hpp"
#include "libs/app/notify.hpp"
#include "libs/app/operator_keys.hpp"
#include "libs/app/parameters.hpp"
#include "libs/app/process_tuning.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/recording/recorded_messages.hpp"

namespace palpate::player {

namespace {

/// Where the standard output is no terminal, a line comes this seldom.
constexpr int kStatesPerLine = 10;

double RateOf(const Command& command) {
  return command.as_fast_as_possible ? std::numeric_limits<double>::infinity() : command.rate;
}

/// Refuses options that only one kind of recording has.
void CheckKind(const Command& command) {
  const auto refuse = [&](bool given, const std::string& option, const std::string& kind) {
    if (given)
      throw InputError(option + " is for " + kind + ", which " + command.data.string() + " is not");
  };
  if (!command.message_files.empty()) {
    refuse(command.images, "--images", "experiment folders");
    refuse(!command.recording.empty(), "--recording", "experiment folders");
    return;
  }
  const std::string kMessages = "MCAP and .db3 files";
  refuse(!command.topics.empty(), "--topic", kMessages);
  refuse(!command.excluded.empty(), "--exclude", kMessages);
  refuse(command.paused, "--pause", kMessages);
  refuse(command.start_s != 0.0, "--start", kMessages);
  refuse(command.end_s != 0.0, "--end", kMessages);
  refuse(command.duration_s != 0.0, "--duration", kMessages);
  refuse(!command.step_topic.empty(), "--step-topic", kMessages);
  refuse(command.step_count != 1, "--step-count", kMessages);
  refuse(command.beside_writers, "--beside-writers", kMessages);
  refuse(command.json, "--json", kMessages);
}

void CheckTimes(const Command& command) {
  for (const auto& [option, value_s] :
       {std::pair("--start", command.start_s), std::pair("--end", command.end_s),
        std::pair("--duration", command.duration_s)}) {
    if (value_s < 0.0) throw InputError(std::string(option) + ": must be 0 or above");
  }
  if (command.end_s > 0.0 && command.duration_s > 0.0) {
    throw InputError("only one of --end and --duration can be given");
  }
  if (command.end_s > 0.0 && command.end_s <= command.start_s) {
    throw InputError("--end: must be behind --start");
  }
}

ExperimentPlayer OpenExperiment(const Command& command) {
  experiment::Experiment experiment = experiment::ReadExperiment(command.data, app::LoadYaml);
  if (command.images) {
    return ExperimentPlayer::OfImages(std::move(experiment), command.recording, app::LoadYaml);
  }
  return {std::move(experiment), command.recording, command.config.frame == "robot"};
}

dds::TopicTable TableOf(const Command& command) {
  return dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml);
}

int PlayExperiment(const Command& command) {
  const Playback playback{.rate = RateOf(command), .step = command.step, .loop = command.loop};
  PlayerNode node(command.config, playback, OpenExperiment(command), command.options.domain_id,
                  TableOf(command), app::Log);
  const app::StopSignal stop([&] { node.Stop(); });
  app::NotifyReady();
  node.Run();
  app::LogInfo("{}", stop.Requested() ? "stopped by a signal" : "ended");
  return app::kExitDone;
}

RecordingPlan PlanOf(const Command& command) {
  RecordingPlan plan;
  plan.rate = RateOf(command);
  plan.step = command.step;
  plan.loop = command.loop;
  plan.paused = command.paused;
  plan.start_s = command.start_s;
  if (command.end_s > 0.0) plan.end_s = command.end_s;
  if (command.duration_s > 0.0) plan.end_s = command.start_s + command.duration_s;
  plan.step_topic = command.step_topic;
  plan.step_count = command.step_count;
  plan.beside_writers = command.beside_writers;
  return plan;
}

std::string StateJson(const PlaybackState& state) {
  nlohmann::ordered_json json = {{"position_s", state.position_s},
                                 {"duration_s", state.duration_s},
                                 {"rate", state.rate},  // null: as fast as possible
                                 {"paused", state.paused},
                                 {"ended", state.ended},
                                 {"messages", state.messages},
                                 {"dropped", state.dropped},
                                 {"lateness_p50_s", state.lateness_p50_s},
                                 {"lateness_p99_s", state.lateness_p99_s}};
  return json.dump();
}

/// Shows the state in place on a terminal, and in lines elsewhere.
class StatePrinter {
 public:
  explicit StatePrinter(bool json) : json_(json), is_terminal_(isatty(STDOUT_FILENO) != 0) {}

  void Show(const PlaybackState& state) {
    if (json_) {
      fmt::print("{}\n", StateJson(state));
    } else if (is_terminal_ && !state.ended) {
      fmt::print("\r{}  (space, arrows, s, q)\033[K", PlaybackLine(state));
    } else if (state.ended || shown_++ % kStatesPerLine == 0) {
      fmt::print("{}{}{}\n", is_terminal_ ? "\r" : "", PlaybackLine(state),
                 is_terminal_ ? "\033[K" : "");
    }
    std::fflush(stdout);
  }

 private:
  bool json_;
  bool is_terminal_;
  int shown_ = 0;
};

void AnswerKey(app::OperatorKey key, RecordingNode& node) {
  if (key == app::OperatorKeyOf(' ')) node.Ask(Request::kPauseOrResume);
  if (key == app::OperatorKeyOf('s')) node.Ask(Request::kStep);
  if (key == app::OperatorKey::kRight) node.Ask(Request::kForward);
  if (key == app::OperatorKey::kLeft) node.Ask(Request::kBack);
  if (key == app::OperatorKey::kUp || key == app::OperatorKeyOf('+')) node.Ask(Request::kFaster);
  if (key == app::OperatorKey::kDown || key == app::OperatorKeyOf('-')) node.Ask(Request::kSlower);
  if (key == app::OperatorKeyOf('q')) node.Stop();
}

int PlayRecording(const Command& command) {
  RecordingPlan plan = PlanOf(command);
  StatePrinter printer(command.json);
  plan.show = [&](const PlaybackState& state) { printer.Show(state); };
  RecordingSource source(command.message_files, {command.topics, command.excluded});
  RecordingNode node(command.config, std::move(plan), std::move(source), command.options.domain_id,
                     TableOf(command), app::Log);
  const app::StopSignal stop([&] { node.Stop(); });
  const app::OperatorKeys keys([&](app::OperatorKey key) { AnswerKey(key, node); });
  app::NotifyReady();
  node.Run();
  return app::kExitDone;
}

}  // namespace

void DeclarePlay(app::Arguments& arguments, Command* command) {
  arguments.Positional("RECORDING", &command->target,
                       "MCAP or .db3 file or folder of them, experiment or recording folder",
                       app::Need::kOptional);
  arguments.Option("--data PATH", &command->data, "The same as RECORDING");
  arguments.Option("--rate FACTOR", &command->rate, "Speed relative to real time, above 0");
  arguments.Flag("--step", &command->step,
                 "Publish each frame when /forces has answered the last one; loses no frame");
  arguments.Flag("--as-fast-as-possible", &command->as_fast_as_possible, "Publish without waiting");
  arguments.Flag("--loop", &command->loop, "Begin again at the end");
  arguments.Option("--recording NAME", &command->recording,
                   "Of an experiment: play this recording only; without it all");
  arguments.Flag("--images", &command->images,
                 "Of an experiment: publish depth and colour images instead of markers");
  arguments.Repeated("--topic NAME", &command->topics,
                     "Of messages: play this topic, or those that fit a pattern like '/camera/*'; "
                     "without it all");
  arguments.Repeated("--exclude NAME", &command->excluded,
                     "Of messages: do not play this topic, or those that fit a pattern");
  arguments.Flag("--pause", &command->paused, "Of messages: start paused");
  arguments.Option("--start S", &command->start_s, "Of messages: start at this time, s");
  arguments.Option("--end S", &command->end_s, "Of messages: end at this time, s; 0: at its end");
  arguments.Option("--duration S", &command->duration_s,
                   "Of messages: play so long a part, s; 0: to its end");
  arguments.Option(
      "--step-topic NAME", &command->step_topic,
      "Of messages: topic whose messages are steps; without it markers, contacts or depth "
      "images with --step, and any topic for the key s");
  arguments.Option("--step-count N", &command->step_count, 1, 1000000,
                   "Of messages: messages of it that the key s plays");
  arguments.Flag("--beside-writers", &command->beside_writers,
                 "Of messages: also play topics that live writers publish");
  arguments.Flag("--clock", &command->clock, "Publish /clock, as publish_clock does");
  arguments.Flag("--json", &command->json,
                 "Of messages: print the state as one line of JSON each second");
}

void SettlePlay(Command* command) {
  if (!command->target.empty() && !command->data.empty()) {
    throw InputError("RECORDING and --data are the same: give one");
  }
  if (command->data.empty()) command->data = command->target;
  if (command->data.empty()) {
    throw InputError("RECORDING is required: give an MCAP or .db3 file, or an experiment folder");
  }
  if (command->rate <= 0.0) {
    throw InputError("--rate: must be above 0, not " + FormatNumber(command->rate));
  }
  const bool rate_given = command->rate != 1.0;
  if (int{rate_given} + int{command->step} + int{command->as_fast_as_possible} > 1) {
    throw InputError("only one of --rate, --step and --as-fast-as-possible can be given");
  }
  command->message_files = recording::MessageFilesOf(command->data);
  CheckKind(*command);
  CheckTimes(*command);
  if (command->clock) command->config.publish_clock = true;
  // The recorded time would contradict it.
  if (command->config.publish_clock) command->excluded.emplace_back("/clock");
  app::AddParameters("palpate-player", command);
}

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments("palpate-player", "Publish recorded data as if the robot ran now");
  DeclarePlay(arguments, &command);
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  SettlePlay(&command);
  return command;
}

int Play(const Command& command) {
  app::KeepLargeBlocks();
  app::StartLog("palpate-player", command.options);
  return command.message_files.empty() ? PlayExperiment(command) : PlayRecording(command);
}

}  // namespace palpate::player

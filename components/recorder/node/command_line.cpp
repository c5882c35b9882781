// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/recorder/node/command_line.hpp"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <utility>

#include "components/recorder/node/attachments.hpp"
#include "components/recorder/node/status_json.hpp"
#include "libs/app/log.hpp"
#include "libs/app/notify.hpp"
#include "libs/app/operator_keys.hpp"
#include "libs/app/parameters.hpp"
#include "libs/app/process_tuning.hpp"
#include "libs/app/project_files.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/version.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/utc_text.hpp"

namespace palpate::recorder {

namespace {

/// Where the standard output is no terminal, a line comes this seldom.
constexpr double kLinePeriod_s = 10.0;

std::atomic<RecorderNode*> g_node{nullptr};
static_assert(std::atomic<RecorderNode*>::is_always_lock_free);

void HandleSnapshotSignal(int) {
  if (RecorderNode* node = g_node.load()) node->RequestSnapshot();
}

/// Lets SIGUSR1 ask a node for a snapshot as long as this lives.
class SnapshotSignal {
 public:
  explicit SnapshotSignal(RecorderNode* node) {
    g_node = node;
    struct sigaction action {};
    action.sa_handler = &HandleSnapshotSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGUSR1, &action, &before_);
  }
  ~SnapshotSignal() {
    sigaction(SIGUSR1, &before_, nullptr);
    g_node = nullptr;
  }
  SnapshotSignal(const SnapshotSignal&) = delete;
  SnapshotSignal& operator=(const SnapshotSignal&) = delete;

 private:
  struct sigaction before_ {};
};

/// "recording_2026-01-31T12-00-00Z.mcap"
std::filesystem::path DefaultFile() {
  std::string name = "recording_" + UtcText(WallNow_ns() / 1'000'000'000) + ".mcap";
  for (char& c : name) c = c == ':' ? '-' : c;
  return name;
}

FileExtras ExtrasOf(const Command& command) {
  NodeConfig config = command.config;
  FileExtras extras;
  extras.options = WriterOptionsOf(config, std::string("palpate-recorder ") + app::Version());
  if (!command.robot.empty()) {
    extras.attachments = AttachRobot(app::FindRobotFile(command.robot));
  }
  if (!command.calibration.empty()) {
    extras.attachments.push_back(AttachmentOf(command.calibration));
  }
  for (const std::string& file : command.attached) {
    extras.attachments.push_back(AttachmentOf(std::filesystem::path(file)));
  }
  extras.attachments.push_back(
      AttachmentOf("recorder_settings.yaml", app::PrintYaml(app::ListSettings(config))));
  extras.attachments.push_back(
      config.dds.topics_file.empty()
          ? AttachmentOf("topics.yaml", std::string(dds::BuiltInTopicsYaml()))
          : AttachmentOf(config.dds.topics_file));
  extras.metadata.push_back({"palpate",
                             {{"version", app::Version()},
                              {"domain", std::to_string(command.options.domain_id)},
                              {"robot", command.robot.string()},
                              {"calibration", command.calibration.string()}}});
  return extras;
}

std::size_t RowsOfTerminal() {
  winsize told{};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &told) == 0 && told.ws_row > 0;
  return known ? told.ws_row : 50;
}

/// Shows the state in place on a terminal, and in lines elsewhere.
class StatusPrinter {
 public:
  explicit StatusPrinter(bool json) : json_(json), is_terminal_(isatty(STDOUT_FILENO) != 0) {}

  void Show(const RecorderStatus& status, bool last) {
    if (json_) {
      fmt::print("{}\n", StatusJson(status));
    } else if (last) {
      Clear();
      fmt::print("{}", StatusTable(status));
    } else if (is_terminal_) {
      ShowInPlace(StatusTable(status));
    } else if (status.duration_s >= next_line_s_) {
      next_line_s_ += kLinePeriod_s;
      fmt::print("{}\n", StatusLine(status));
    }
    std::fflush(stdout);
  }

 private:
  void Clear() {
    if (is_terminal_ && shown_rows_ > 0) fmt::print("\033[{}A\033[J", shown_rows_);
    shown_rows_ = 0;
  }

  void ShowInPlace(std::string text) {
    text += "s: snapshot, q: end\n";
    Clear();
    std::size_t rows = 0;
    std::size_t end = 0;
    for (; rows + 1 < RowsOfTerminal() && end < text.size(); ++rows) {
      end = text.find('\n', end) + 1;
    }
    fmt::print("{}", text.substr(0, end));
    shown_rows_ = rows;
  }

  bool json_;
  bool is_terminal_;
  std::size_t shown_rows_ = 0;
  double next_line_s_ = kLinePeriod_s;
};

}  // namespace

void DeclareRecord(app::Arguments& arguments, Command* command) {
  arguments.Option("--out FILE", &command->out,
                   "MCAP file, which must not exist; without it recording_TIME.mcap");
  arguments.Repeated("--topic NAME", &command->topics,
                     "Record this topic, or those that fit a pattern like '/camera/*'; without it "
                     "all");
  arguments.Repeated("--exclude NAME", &command->excluded,
                     "Do not record this topic, or those that fit a pattern");
  arguments.Flag("--only-recent", &command->only_recent,
                 "Write no file but snapshots: the last seconds, on a key, a signal or an error");
  arguments.Option("--duration S", &command->duration_s, "End after this time, s; 0: at Ctrl-C");
  app::DeclareRobotOption(arguments, &command->robot, "attached to the file, with its mesh");
  arguments.Option("--calibration FILE", &command->calibration, "Attach this calibration file");
  arguments.Repeated("--attach FILE", &command->attached, "Attach this file");
  arguments.Flag("--json", &command->json, "Print the state as one line of JSON each second");
}

void SettleRecord(Command* command) {
  if (command->out.empty()) command->out = DefaultFile();
  if (command->out.extension() != ".mcap") {
    throw InputError("--out: must end in .mcap, not '" + command->out.string() + "'");
  }
  if (command->duration_s < 0.0) throw InputError("--duration: must be 0 or above");
  if (command->only_recent && command->config.recent_s <= 0.0) {
    throw InputError("--only-recent needs recent_s above 0: it says how many seconds are kept");
  }
  app::AddParameters("palpate-recorder", command);
}

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  app::Arguments arguments("palpate-recorder", "Record the topics of a domain as an MCAP file");
  DeclareRecord(arguments, &command);
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  SettleRecord(&command);
  return command;
}

std::unique_ptr<RecorderNode> MakeNode(const Command& command) {
  RecordPlan plan;
  plan.file = command.out;
  plan.only_recent = command.only_recent;
  plan.choice = {command.topics, command.excluded};
  plan.extras = ExtrasOf(command);
  plan.duration_s = command.duration_s;
  const auto printer = std::make_shared<StatusPrinter>(command.json);
  plan.show = [printer](const RecorderStatus& status) { printer->Show(status, status.ended); };
  return std::make_unique<RecorderNode>(
      command.config, std::move(plan), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

int Record(const Command& command) {
  app::KeepLargeBlocks();
  app::StartLog("palpate-recorder", command.options);
  const auto node = MakeNode(command);
  const app::StopSignal stop([&] { node->Stop(); });
  const SnapshotSignal snapshot(node.get());
  const app::OperatorKeys keys([&](app::OperatorKey key) {
    if (key == app::OperatorKeyOf('s')) node->RequestSnapshot();
    if (key == app::OperatorKeyOf('q')) node->Stop();
  });
  app::NotifyReady();
  node->Run();
  return app::kExitDone;
}

}  // namespace palpate::recorder

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/export_verb.hpp"

#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "components/offline/messages/make_experiment.hpp"
#include "components/palpate/check_output.hpp"
#include "components/palpate/end_on_signal.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/recordings/data_folder.hpp"
#include "components/palpate/recordings/export_messages.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

struct ExportCommand {
  std::filesystem::path file;
  ExportOptions options;
  std::string clouds = "ply";
  std::filesystem::path experiment;  ///< folder to make instead; empty: none
  std::vector<std::string> remap;
  std::filesystem::path robot;  ///< empty: the one attached to the recording
  bool json = false;
};

void Print(const std::vector<ExportedTopic>& topics, bool json) {
  auto list = nlohmann::ordered_json::array();
  for (const ExportedTopic& topic : topics) {
    list.push_back({{"topic", topic.topic},
                    {"target", topic.target.string()},
                    {"messages", topic.messages},
                    {"left_out", topic.left_out},
                    {"reason", topic.reason}});
    if (json) continue;
    if (topic.messages > 0) {
      fmt::print("{}: {} messages in {}\n", topic.topic, topic.messages, topic.target.string());
    }
    if (topic.left_out > 0) {
      fmt::print("{}: {} messages left out: {}\n", topic.topic, topic.left_out, topic.reason);
    }
  }
  if (json) fmt::print("{}\n", list.dump(2));
}

void CheckNewFolder(const std::filesystem::path& out) {
  if (std::filesystem::exists(out) && !std::filesystem::is_empty(out)) {
    throw InputError({out.string()}, "is not empty; choose another folder");
  }
  CheckOutputFolder(out);
}

std::vector<std::filesystem::path> FilesOf(const std::filesystem::path& target) {
  std::vector<std::filesystem::path> files = recording::MessageFilesOf(target);
  if (!files.empty()) return files;
  throw InputError({target.string()},
                   "is neither an MCAP file, a .db3 file of rosbag2, nor a folder of them");
}

/// An experiment, or no folder at all.
std::vector<std::string> MakeWhole(const ExportCommand& command) {
  const std::filesystem::path out = std::filesystem::absolute(command.experiment);
  const EndOnSignal end_on_signal("palpate export", out.string() + " is removed");
  RemoveOnSignal(out);
  try {
    std::vector<std::string> notes = offline::MakeExperiment(
        command.file, command.remap,
        command.robot.empty() ? command.robot : FindRobotFile(command.robot), out, app::LoadYaml);
    RemoveOnSignal({});
    return notes;
  } catch (...) {
    RemoveOnSignal({});
    std::error_code ignored;
    std::filesystem::remove_all(out, ignored);
    throw;
  }
}

int ExportExperiment(const ExportCommand& command) {
  CheckNewFolder(command.experiment);
  FilesOf(command.file);
  const std::vector<std::string> notes = MakeWhole(command);
  if (command.json) {
    const nlohmann::ordered_json told = {{"experiment", command.experiment.string()},
                                         {"notes", notes}};
    fmt::print("{}\n", told.dump(2));
    return app::kExitDone;
  }
  for (const std::string& note : notes) fmt::print("{}\n", note);
  fmt::print("written to {}\n", command.experiment.string());
  return app::kExitDone;
}

int Export(ExportCommand command) {
  const std::filesystem::path& out = command.options.out;
  if (out.empty() == command.experiment.empty()) {
    throw InputError("give --out FOLDER for files of each topic, or --experiment FOLDER");
  }
  if (out.empty()) return ExportExperiment(command);
  if (!command.remap.empty()) throw InputError("--remap is for --experiment; leave it out");
  if (!command.robot.empty()) throw InputError("--robot is for --experiment; leave it out");
  CheckNewFolder(out);
  command.options.clouds = command.clouds == "pcd" ? CloudFormat::kPcd : CloudFormat::kPly;
  const recording::RecordedMessages reader(FilesOf(command.file));
  std::filesystem::create_directories(out);
  const EndOnSignal end_on_signal("palpate export",
                                  "the files in " + out.string() + " are incomplete");
  Print(ExportMessages(reader, command.options), command.json);
  return app::kExitDone;
}

}  // namespace

app::Verb ExportVerb() {
  return {"export",
          "Write recorded messages as CSV, images, clouds and meshes, or as an experiment",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto command = std::make_shared<ExportCommand>();
            arguments.Positional("FILE", &command->file, "MCAP or .db3 file, or folder of them");
            arguments.Option("--out FOLDER", &command->options.out,
                             "New or empty folder for the files of each topic");
            arguments.Option("--experiment FOLDER", &command->experiment,
                             "New or empty folder: make an experiment of the topics instead");
            DeclareRemap(arguments, &command->remap);
            DeclareRobotOption(arguments, &command->robot,
                               "the robot whose file says which joints are chambers; without it "
                               "the one attached to the recording");
            arguments.Repeated("--topic NAME", &command->options.topics,
                               "Export this topic; without it all");
            arguments.Choice("--clouds FORMAT", &command->clouds, {"ply", "pcd"},
                             "Format of point clouds");
            arguments.Flag("--json", &command->json, "Print JSON instead of text");
            return [command] { return Export(*command); };
          }};
}

}  // namespace palpate::command

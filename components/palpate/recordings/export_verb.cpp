// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/export_verb.hpp"

#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/palpate/check_output.hpp"
#include "components/palpate/recordings/export_messages.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

struct ExportCommand {
  std::filesystem::path file;
  ExportOptions options;
  std::string clouds = "ply";
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

int Export(ExportCommand command) {
  const std::filesystem::path& out = command.options.out;
  if (std::filesystem::exists(out) && !std::filesystem::is_empty(out)) {
    throw InputError({out.string()}, "is not empty; choose another folder with --out");
  }
  CheckOutputFolder(out);
  command.options.clouds = command.clouds == "pcd" ? CloudFormat::kPcd : CloudFormat::kPly;
  const recording::Reader reader(command.file);
  std::filesystem::create_directories(out);
  Print(ExportMessages(reader, command.options), command.json);
  return app::kExitDone;
}

}  // namespace

app::Verb ExportVerb() {
  return {"export", "Write the messages of an MCAP file as CSV, images, clouds and meshes",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto command = std::make_shared<ExportCommand>();
            arguments.Positional("FILE", &command->file, "MCAP file");
            arguments.Option("--out FOLDER", &command->options.out, "New or empty folder",
                             app::Need::kRequired);
            arguments.Repeated("--topic NAME", &command->options.topics,
                               "Export this topic; without it all");
            arguments.Choice("--clouds FORMAT", &command->clouds, {"ply", "pcd"},
                             "Format of point clouds");
            arguments.Flag("--json", &command->json, "Print JSON instead of text");
            return [command] { return Export(*command); };
          }};
}

}  // namespace palpate::command

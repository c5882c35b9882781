// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/command_line.hpp"

#include <filesystem>

#include "components/capture/network/packet_size.hpp"
#include "libs/core/error.hpp"

namespace palpate::capture {

namespace {

void CheckAddresses(const Command& command) {
  if (!command.list && !command.addresses.empty()) {
    throw InputError("ADDRESS goes with --list; the camera to capture is set genicam.camera_id");
  }
  for (const std::string& address : command.addresses) {
    if (!IsIpv4Address(address)) throw InputError("'" + address + "' is not an IPv4 address");
  }
}

}  // namespace

std::optional<Command> ReadCommand(int argc, const char* const* argv) {
  Command command;
  std::string camera;
  std::filesystem::path replay;
  app::Arguments arguments("palpate-capture",
                           "Publish the frames of an RGB-D camera, or of a recording of one.");
  arguments.Option("--camera", &camera, "Same as --set genicam.camera_id=...");
  arguments.Option("--replay", &replay, "A recording instead of a camera");
  arguments.Flag("--list", &command.list, "Show the cameras that answer");
  arguments.Positionals("ADDRESS", &command.addresses, "With --list: cameras on networks of others",
                        app::Need::kOptional);
  app::DeclareNodeOptions(arguments, &command.options);
  if (!arguments.Parse(app::CommandLineWords(argc, argv)) ||
      !app::SettleNodeOptions(app::ListSettings(command.config), &command.options)) {
    return std::nullopt;
  }
  CheckAddresses(command);
  if (!camera.empty() && !replay.empty()) throw InputError("either --camera or --replay");
  if (!camera.empty()) {
    command.config.source = "genicam";
    command.config.genicam.camera_id = camera;
  }
  if (!replay.empty()) {
    command.config.source = "replay";
    command.config.replay.folder = replay;
  }
  return command;
}

}  // namespace palpate::capture

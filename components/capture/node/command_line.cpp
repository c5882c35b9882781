// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/capture/node/command_line.hpp"

#include <filesystem>

#include "components/capture/make_source.hpp"
#include "components/capture/network/packet_size.hpp"
#include "libs/app/log.hpp"
#include "libs/app/yaml.hpp"
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
                           "Publish the frames of an RGB-D camera or of a recording");
  arguments.Option("--camera ID", &camera,
                   "GenICam camera by IPv4 address, vendor-serial, serial number or MAC; same as "
                   "--set genicam.camera_id=ID");
  arguments.Option("--replay FOLDER", &replay,
                   "Recording to publish instead of a camera; same as --set replay.folder=FOLDER");
  arguments.Flag("--list", &command.list, "List the GenICam cameras that answer and exit");
  arguments.Positionals("ADDRESS", &command.addresses,
                        "With --list: IPv4 address of a camera outside the local network",
                        app::Need::kOptional);
  if (!app::ReadNodeCommand(arguments, argc, argv, &command)) return std::nullopt;
  CheckAddresses(command);
  if (!camera.empty() && !replay.empty())
    throw InputError("--camera and --replay exclude each other: give one");
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

std::unique_ptr<CaptureNode> MakeNode(const Command& command) {
  return std::make_unique<CaptureNode>(
      command.config, MakeSource(command.config, app::LoadYaml), command.options.domain_id,
      dds::LoadTopicTable(command.config.dds, app::LoadYaml, app::ParseYaml), app::Log);
}

}  // namespace palpate::capture

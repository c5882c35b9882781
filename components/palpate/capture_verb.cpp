// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/capture_verb.hpp"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "components/capture/camera_list.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

struct CaptureOptions {
  bool list = false;
  bool json = false;
  std::vector<std::string> addresses;
};

void PrintJson(const std::vector<capture::CameraDescription>& cameras) {
  auto list = nlohmann::ordered_json::array();
  for (const capture::CameraDescription& camera : cameras) {
    list.push_back({{"model", camera.model},
                    {"vendor", camera.vendor},
                    {"serial", camera.serial},
                    {"address", camera.address},
                    {"protocol", camera.protocol},
                    {"components", camera.components},
                    {"formats", camera.formats},
                    {"trouble", camera.trouble}});
  }
  std::cout << list.dump(2) << '\n';
}

int Capture(const CaptureOptions& options) {
  if (!options.list) {
    throw InputError(
        "--list is required: this verb only lists cameras; the process palpate-capture captures "
        "frames");
  }
  const auto cameras = capture::ListCameras(options.addresses);
  if (options.json) {
    PrintJson(cameras);
  } else {
    capture::PrintCameras(cameras, std::cout);
  }
  return app::kExitDone;
}

}  // namespace

app::Verb CaptureVerb() {
  return {"capture", "List the GenICam cameras on the network", [](app::Arguments& arguments) {
            auto options = std::make_shared<CaptureOptions>();
            arguments.Flag("--list", &options->list,
                           "List the cameras that answer: model, serial number, address, "
                           "components and formats; required");
            arguments.Flag("--json", &options->json, "Print JSON instead of text");
            arguments.Positionals("ADDRESS", &options->addresses,
                                  "IPv4 address of a camera outside the local network",
                                  app::Need::kOptional);
            return [options] { return Capture(*options); };
          }};
}

}  // namespace palpate::command

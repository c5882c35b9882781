// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/demo_place.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <utility>

#include "components/palpate/check_output.hpp"
#include "components/palpate/find_robot.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"

namespace palpate::command {

namespace {

constexpr int kFirstDomain = 120;  // far from the usual 0
constexpr int kDomains = 100;

// DDS on 127.0.0.1 only. A frame of 2 MB is sent at once. What does not fit into the receive buffer
// is requested again after NackDelay, which delays the frame.
constexpr char kLoopbackXml[] = R"(<?xml version="1.0" encoding="UTF-8"?>
<CycloneDDS xmlns="https://cdds.io/config">
  <Domain Id="any">
    <General>
      <Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
      <AllowMulticast>false</AllowMulticast>
      <MaxMessageSize>65500B</MaxMessageSize>
    </General>
    <Internal>
      <SocketReceiveBufferSize max="10MB"/>
      <NackDelay>10ms</NackDelay>
    </Internal>
    <Discovery>
      <ParticipantIndex>auto</ParticipantIndex>
      <MaxAutoParticipantIndex>60</MaxAutoParticipantIndex>
      <Peers><Peer address="127.0.0.1"/></Peers>
    </Discovery>
  </Domain>
</CycloneDDS>
)";

/// Beside the programs in a build folder. Installed programs have no folder of results.
std::filesystem::path UsualFolder(const std::filesystem::path& programs) {
  const std::filesystem::path build = programs.parent_path();
  std::error_code none;
  return std::filesystem::exists(build / "CMakeCache.txt", none) ? build / "demo" : "palpate_demo";
}

std::string LastLine(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string last;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace

std::string DemoPlace::CameraAddress() const { return fmt::format("127.41.{}.1", domain_id); }

std::unique_ptr<ChildProcess> DemoPlace::Start(const std::string& program,
                                               std::vector<std::string> arguments,
                                               const std::string& log) const {
  arguments.insert(arguments.end(), {"--domain", std::to_string(domain_id)});
  return std::make_unique<ChildProcess>(programs / program, arguments,
                                        std::map<std::string, std::string>{}, folder / log);
}

DemoPlace MakeDemoPlace(const std::filesystem::path& out) {
  DemoPlace place;
  place.programs = ProgramFolder();
  place.folder = out.empty() ? UsualFolder(place.programs) : out;
  place.folder = std::filesystem::absolute(place.folder).lexically_normal();
  CheckOutputFolder(place.folder);
  std::error_code error;
  std::filesystem::create_directories(place.folder, error);
  if (error) {
    throw RunError("cannot create " + place.folder.string() + ": " + error.message());
  }
  place.domain_id = kFirstDomain + static_cast<int>(getpid() % kDomains);
  WriteFile(place.folder / "cyclonedds.xml", kLoopbackXml);
  const std::string uri = "file://" + (place.folder / "cyclonedds.xml").string();
  setenv("CYCLONEDDS_URI", uri.c_str(), 1);
  return place;
}

void RefuseEnded(const ChildProcess& process, int exit_code) {
  throw RunError(fmt::format("{} ended with exit code {}: {} (log: {})", process.name(), exit_code,
                             LastLine(process.log()), process.log().string()));
}

}  // namespace palpate::command

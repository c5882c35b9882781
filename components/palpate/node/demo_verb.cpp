// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo_verb.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

#include "components/palpate/calibrate_verb.hpp"
#include "components/palpate/child_process.hpp"
#include "components/palpate/demo_data.hpp"
#include "components/palpate/demo_picture.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/force_summary.hpp"
#include "components/palpate/node/force_listener.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/clock.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

constexpr auto kStartLimit = std::chrono::seconds(60);
constexpr auto kPlayLimit = std::chrono::seconds(300);

// DDS on 127.0.0.1 only.
constexpr char kLoopbackXml[] = R"(<?xml version="1.0" encoding="UTF-8"?>
<CycloneDDS xmlns="https://cdds.io/config">
  <Domain Id="any">
    <General>
      <Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
      <AllowMulticast>false</AllowMulticast>
      <MaxMessageSize>65500B</MaxMessageSize>
    </General>
    <Discovery>
      <ParticipantIndex>auto</ParticipantIndex>
      <MaxAutoParticipantIndex>60</MaxAutoParticipantIndex>
      <Peers><Peer address="127.0.0.1"/></Peers>
    </Discovery>
  </Domain>
</CycloneDDS>
)";

// Says what happens, and afterwards how long it took.
class Step {
 public:
  explicit Step(const std::string& what) : start_ns_(MonotonicNow_ns()) {
    fmt::print("\n{}\n", what);
    std::fflush(stdout);
  }
  ~Step() {
    fmt::print("  ({:.1f} s)\n", static_cast<double>(MonotonicNow_ns() - start_ns_) * 1e-9);
    std::fflush(stdout);
  }
  Step(const Step&) = delete;
  Step& operator=(const Step&) = delete;

 private:
  std::int64_t start_ns_;
};

// The files of one demonstration, and the programs that it starts.
struct Workplace {
  std::filesystem::path folder;
  std::filesystem::path programs;
  int domain_id;

  std::filesystem::path calibration() const { return folder / "calibration.yaml"; }
  std::filesystem::path picture() const { return folder / "scene.png"; }
};

Workplace MakeWorkplace(const DemoOptions& options) {
  Workplace place;
  place.programs = ProgramFolder();
  place.folder = options.out.empty() ? place.programs.parent_path() / "demo" : options.out;
  place.folder = std::filesystem::absolute(place.folder).lexically_normal();
  std::error_code error;
  std::filesystem::create_directories(place.folder, error);
  if (error) {
    throw RunError("cannot create " + place.folder.string() + ": " + error.message());
  }
  place.domain_id = 120 + static_cast<int>(getpid() % 100);  // far from the usual 0
  WriteFile(place.folder / "cyclonedds.xml", kLoopbackXml);
  const std::string uri = "file://" + (place.folder / "cyclonedds.xml").string();
  setenv("CYCLONEDDS_URI", uri.c_str(), 1);
  return place;
}

DemoData PrepareData(const DemoOptions& options, const Workplace& place) {
  const Step step("[1/4] Data");
  const auto measured = options.computed ? std::nullopt : FindMeasuredData(options.data);
  const DemoData data = measured ? ImportMeasuredBeam(*measured, place.folder) : ComputedBeam();
  fmt::print("  {}\n  {}\n", data.description, data.experiment.string());
  return data;
}

void CalibrateOnSelfWeight(const DemoData& data, const Workplace& place) {
  const Step step(fmt::format("[2/4] Stiffness from the beam's own weight ({}): palpate calibrate",
                              data.self_weight));
  CalibrateOptions options;
  options.robot = "beam";
  options.data = data.experiment;
  options.recordings = {data.self_weight};
  options.marker_bias_m = data.marker_bias_m;
  options.out = place.calibration();
  Calibrate(options);
}

[[noreturn]] void RefuseEnded(const ChildProcess& process, int exit_code) {
  throw RunError(fmt::format("{} ended with {}; its log is {}", process.name(), exit_code,
                             process.log().string()));
}

std::unique_ptr<ChildProcess> StartEstimation(const DemoData& data, const Workplace& place) {
  return std::make_unique<ChildProcess>(
      place.programs / "palpate-force-estimation",
      std::vector<std::string>{
          FindRobotFile("beam").string(), "--calibration", place.calibration().string(), "--domain",
          std::to_string(place.domain_id), "--set", "contacts=[\"" + data.contact + "\"]", "--set",
          "marker_bias_m=" + FormatNumber(data.marker_bias_m)},
      std::map<std::string, std::string>{}, place.folder / "force_estimation.log");
}

std::unique_ptr<ChildProcess> StartPlayer(const DemoData& data, const Workplace& place) {
  return std::make_unique<ChildProcess>(
      place.programs / "palpate-player",
      std::vector<std::string>{"--data", data.experiment.string(), "--recording", data.hung_weight,
                               "--step", "--domain", std::to_string(place.domain_id)},
      std::map<std::string, std::string>{}, place.folder / "player.log");
}

void ListenWhileItPlays(const DemoData& data, const Workplace& place, ForceListener* listener) {
  const Step step(
      fmt::format("[3/4] Markers of {} through DDS: palpate-player -> "
                  "palpate-force-estimation (domain {}, loopback only)",
                  data.hung_weight, place.domain_id));
  const auto estimation = StartEstimation(data, place);
  listener->Listen([&] { return listener->estimator_is_there() || estimation->ExitCode(); },
                   kStartLimit);
  if (const auto ended = estimation->ExitCode()) {
    RefuseEnded(*estimation, *ended);
  }
  const auto player = StartPlayer(data, place);
  const bool finished = listener->Listen(
      [&] { return player->ExitCode().has_value() || estimation->ExitCode().has_value(); },
      kPlayLimit);
  if (const auto ended = estimation->ExitCode()) {
    RefuseEnded(*estimation, *ended);
  }
  if (!finished || player->ExitCode().value_or(1) != 0) {
    RefuseEnded(*player, finished ? *player->ExitCode() : player->Stop());
  }
  fmt::print("  {} marker frames answered on /forces; logs: {}, {}\n", listener->estimates().size(),
             player->log().string(), estimation->log().string());
}

}  // namespace

int Demo(const DemoOptions& options) {
  const Workplace place = MakeWorkplace(options);
  fmt::print(
      "palpate demo: the weight on a soft beam, estimated from how the beam bends.\n"
      "All that it makes comes to lie in {}.\n",
      place.folder.string());
  const DemoData data = PrepareData(options, place);
  CalibrateOnSelfWeight(data, place);
  ForceListener listener(place.domain_id);
  ListenWhileItPlays(data, place, &listener);

  const Step step("[4/4] Force against truth");
  const DemoResult result =
      EvaluateDemo(data, place.calibration(), listener.estimates(), listener.mesh_state_m());
  fmt::print("{}", result.text);
  if (!result.found) {
    return app::kExitFailed;
  }
  view::SaveScene(place.picture(), result.scene);
  fmt::print("  picture: {}\n", place.picture().string());
  return app::kExitDone;
}

app::Verb DemoVerb() {
  return {"demo", "See it work: a weight on a soft beam, estimated through the processes",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<DemoOptions>();
            arguments.Option("--out", &options->out,
                             "folder for the results; else demo/ in the build folder");
            arguments.Option("--data", &options->data,
                             "folder with the measured silicone_beam; else PALPATE_DATA_DIR, "
                             "else ../shared/data");
            arguments.Flag("--computed", &options->computed,
                           "use the computed data set even where the measured one is there");
            return [options] { return Demo(*options); };
          }};
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/beam_demo.hpp"

#include <fmt/core.h>

#include <memory>
#include <optional>

#include "components/palpate/calibrate/calibrate_verb.hpp"
#include "components/palpate/compare/force_tracks.hpp"
#include "components/palpate/demo_data.hpp"
#include "components/palpate/demo_scene.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/node/demo/demo_place.hpp"
#include "components/palpate/node/demo/demo_results.hpp"
#include "components/palpate/node/demo/demo_step.hpp"
#include "components/palpate/node/demo/force_listener.hpp"
#include "components/palpate/node/demo/system_processes.hpp"
#include "components/view/plot/force_plot.hpp"
#include "libs/app/child_process.hpp"
#include "libs/app/run_main.hpp"
#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

constexpr auto kStartLimit = std::chrono::seconds(60);
constexpr auto kPlayLimit = std::chrono::seconds(300);

std::filesystem::path CalibrationFile(const DemoPlace& place) {
  return place.folder / "calibration.yaml";
}

DemoData PrepareData(const BeamDemoOptions& options, const DemoPlace& place) {
  const DemoStep step("[1/4] Data");
  const auto measured = options.computed ? std::nullopt : FindMeasuredData(options.data);
  const DemoData data = measured ? ImportMeasuredBeam(*measured, place.folder) : ComputedBeam();
  fmt::print("  {}\n  {}\n", data.description, data.experiment.string());
  return data;
}

void CalibrateOnSelfWeight(const DemoData& data, const DemoPlace& place) {
  const DemoStep step(
      fmt::format("[2/4] Young's modulus from the beam's own weight ({}): palpate calibrate",
                  data.self_weight));
  CalibrateOptions options;
  options.robot = "beam";
  options.data = data.experiment;
  options.recordings = {data.self_weight};
  options.marker_bias_m = data.marker_bias_m;
  options.out = CalibrationFile(place);
  Calibrate(options);
}

std::unique_ptr<app::ChildProcess> StartEstimation(const DemoData& data, const DemoPlace& place) {
  return place.Start(
      "palpate-force-estimation",
      {FindRobotFile("beam").string(), "--calibration", CalibrationFile(place).string(), "--set",
       "contacts=[\"" + data.contact + "\"]", "--set",
       "marker_bias_m=" + FormatNumber(data.marker_bias_m)},
      "force_estimation.log");
}

std::unique_ptr<app::ChildProcess> StartPlayer(const DemoData& data, const DemoPlace& place) {
  return place.Start(
      "palpate-player",
      {"--data", data.experiment.string(), "--recording", data.hung_weight, "--step"},
      "player.log");
}

std::filesystem::path RecordingFile(const DemoPlace& place) {
  return place.folder / "recording.mcap";
}

/// Without an earlier recording, which palpate-recorder would not replace.
std::unique_ptr<app::ChildProcess> StartRecorder(const DemoPlace& place) {
  std::error_code error;
  std::filesystem::remove(RecordingFile(place), error);
  return place.Start(
      "palpate-recorder",
      {"--out", RecordingFile(place).string(), "--robot", "beam", "--set", "recent_s=0"},
      "recorder.log");
}

void TellPage(app::ChildProcess* page, ForceListener* listener) {
  std::string url;
  listener->Listen(
      [&] {
        url = PageUrlIn(page->log());
        return !url.empty() || page->ExitCode();
      },
      kPageLimit);
  if (!url.empty()) fmt::print("  Look at it in a browser: {}\n", url);
}

void WriteForcePlot(const DemoPlace& place, const ForceListener& listener) {
  ForceTracks tracks(false);
  for (const auto& [stamp_ns, estimate] : listener.estimates()) {
    tracks.Add(NsToSeconds(stamp_ns - listener.estimates().begin()->first),
               HasResult(estimate.status), WithoutTruth(estimate));
  }
  view::SaveTimePlot(place.folder / "forces.svg",
                     view::MakeForcePlot("Force estimated from markers", tracks.Tracks()));
  fmt::print("  plot: {}\n", (place.folder / "forces.svg").string());
}

/// `page`: null where there is none.
void ListenWhileItPlays(const DemoData& data, const DemoPlace& place, app::ChildProcess* page,
                        ForceListener* listener) {
  const DemoStep step(
      fmt::format("[3/4] Markers of {} through DDS: palpate-player -> "
                  "palpate-force-estimation (domain {}, loopback only)",
                  data.hung_weight, place.domain_id));
  const auto estimation = StartEstimation(data, place);
  listener->Listen([&] { return listener->estimator_is_there() || estimation->ExitCode(); },
                   kStartLimit);
  if (const auto ended = estimation->ExitCode()) {
    RefuseEnded(*estimation, *ended);
  }
  if (page) TellPage(page, listener);
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
  fmt::print("  {} marker frames estimated on /forces; logs: {}, {}\n",
             listener->estimates().size(), player->log().string(), estimation->log().string());
}

}  // namespace

int BeamDemo(const BeamDemoOptions& options) {
  const DemoPlace place = MakeDemoPlace(options.out);
  fmt::print("palpate demo: a weight on a soft beam, estimated from its markers; results in {}\n",
             place.folder.string());
  const DemoData data = PrepareData(options, place);
  CalibrateOnSelfWeight(data, place);
  ForceListener listener(place.domain_id);
  {
    const auto recorder = StartRecorder(place);
    const auto page = options.no_view ? nullptr : place.Start("palpate-view", {"beam"}, "view.log");
    ListenWhileItPlays(data, place, page.get(), &listener);
  }

  const DemoStep step("[4/4] Force against truth");
  const DemoResult result =
      EvaluateDemo(data, CalibrationFile(place), listener.estimates(), listener.mesh_state_m());
  fmt::print("{}", result.text);
  if (!result.found) {
    return app::kExitFailed;
  }
  view::SaveScene(place.folder / "scene.png", result.scene);
  fmt::print("  image: {}\n", (place.folder / "scene.png").string());
  WriteForcePlot(place, listener);
  TellRecording(RecordingFile(place), "beam");
  return app::kExitDone;
}

}  // namespace palpate::command

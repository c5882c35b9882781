// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/system_demo.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/capture/network/socket_report.hpp"
#include "components/force_estimation/shape/shape_config.hpp"
#include "components/palpate/compare/live_line.hpp"
#include "components/palpate/estimate/known_truth.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/node/demo/demo_place.hpp"
#include "components/palpate/node/demo/demo_results.hpp"
#include "components/palpate/node/demo/demo_step.hpp"
#include "components/palpate/node/demo/live_listener.hpp"
#include "components/palpate/node/demo/live_table.hpp"
#include "components/palpate/node/demo/replayed_images.hpp"
#include "components/palpate/node/demo/system_processes.hpp"
#include "components/palpate/robot_scene.hpp"
#include "components/palpate/touches/touch_plan.hpp"
#include "components/palpate/touches/touch_scenario.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/stop_signal.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/robot/calibration_file.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::command {

namespace {

using std::chrono::duration;

constexpr duration<double> kSystemStartLimit = std::chrono::seconds(60);
// The virtual robot of a fine mesh first finds its balance: minutes on a slow computer.
constexpr duration<double> kFirstForceLimit = std::chrono::minutes(5);
constexpr duration<double> kLongestReplay = std::chrono::hours(24);
constexpr int kUsualSeconds = 30;
constexpr int kSlowestBench = 10;  ///< the demonstration ends after so many times that
// Receive buffer that a depth camera at 30 Hz needs.
// From a state of the virtual robot to its forces, on a computer that is fast enough.
constexpr double kUsualLatency_s = 0.1;
constexpr int kPictureBuffer_bytes = 2'097'152;
void AdviseOnKernel() {
  const auto granted = capture::GrantedReceiveBuffer_bytes(kPictureBuffer_bytes);
  if (!granted || *granted >= kPictureBuffer_bytes) return;
  fmt::print(
      "  Note: the kernel limits UDP receive buffers to {} kB; frames will be lost.\n  Fix with: "
      "sudo "
      "sysctl -w net.core.rmem_max={}\n",
      *granted / 1024, kPictureBuffer_bytes);
}

// The scenario that is given, sensing.yaml of the robot that it is made for, or touches derived
// from the robot, written to `folder`.
std::filesystem::path ScenarioFile(const SystemDemoOptions& options,
                                   const std::filesystem::path& robot,
                                   const std::filesystem::path& folder) {
  if (!options.scenario.empty()) return std::filesystem::absolute(options.scenario);
  if (std::filesystem::equivalent(robot, FindRobotFile("four_leg"))) {
    const std::filesystem::path file = FindProjectFile("config/scenarios/sensing.yaml");
    if (file.empty()) {
      throw InputError("config/scenarios/sensing.yaml is not there; give --scenario");
    }
    return file;
  }
  const std::unique_ptr<robot::RobotModel> model = LoadRobot(robot);
  const std::filesystem::path file = folder / "scenario.yaml";
  WriteFile(file, TouchScenario(model->body(), PlanTouches(model.get())));
  fmt::print("Touches by the size and stiffness of {}: {}\n", model->body().name, file.string());
  return file;
}

// The running system and its listener.
class DemoRun {
 public:
  DemoRun(const DemoPlace& place, LiveListener::Truth truth, const std::vector<std::string>& remap,
          double same_place_m)
      : listener_(place.domain_id, truth, remap, same_place_m), processes_(place, remap) {}

  SystemProcesses& processes() { return processes_; }
  const LiveComparison& comparison() const { return listener_.comparison(); }
  const StageTimes& stages() const { return listener_.stages(); }
  const LiveListener::BenchTime& bench_time() const { return listener_.bench_time(); }

  // Waits for the status of all of these. Throws RunError where it does not come; false where the
  // user stops the demonstration.
  bool AwaitComponents(const std::vector<std::string>& components) {
    const auto all_there = [&] {
      for (const std::string& component : components) {
        if (!listener_.Heard(component)) return false;
      }
      return true;
    };
    const bool there = Listen(all_there, kSystemStartLimit);
    if (!there && !stop_.Requested()) {
      throw RunError("the processes do not answer within 60 s; see their logs in " +
                     log_folder_hint_);
    }
    return there;
  }

  // Listens and shows the newest line until `done` (true), or the user's stop or `limit` (false).
  bool Listen(const std::function<bool()>& done, duration<double> limit) {
    const auto finished = [&] {
      processes_.CheckAlive();
      return stop_.Requested() || done();
    };
    listener_.Listen(finished, limit,
                     [&](const force_estimation::ForceEstimate& estimate,
                         const std::vector<ComparedForce>& compared) {
                       if (first_s_ < 0.0) first_s_ = estimate.t_s;
                       force_estimation::ForceEstimate shown = estimate;
                       shown.t_s -= first_s_;
                       if (table_) table_->Show(LiveLine(shown, compared));
                     });
    return done() && !stop_.Requested();
  }

  void ShowTable() { table_ = std::make_unique<LiveTable>(); }
  void HideTable() { table_.reset(); }
  std::string Troubles() const { return listener_.Troubles(); }
  bool stopped() const { return stop_.Requested(); }
  void SetLogFolder(const std::filesystem::path& folder) { log_folder_hint_ = folder.string(); }

 private:
  app::StopSignal stop_;
  LiveListener listener_;
  SystemProcesses processes_;
  std::unique_ptr<LiveTable> table_;
  double first_s_ = -1.0;
  std::string log_folder_hint_;
};

void TellPage(DemoRun* run) {
  const SystemProcesses& processes = run->processes();
  run->Listen([&] { return !processes.HasPage() || !processes.PageUrl().empty(); }, kPageLimit);
  const std::string url = processes.PageUrl();
  if (!url.empty()) fmt::print("  Look at it in a browser: {}\n", url);
  std::fflush(stdout);
}

// How far into its scenario a virtual robot is, s; without a time the duration of all of it.
double ScenarioTime_s(const scenario::Scenario& scenario,
                      const std::optional<LiveListener::BenchTime>& time) {
  double sum_s = 0.0;
  for (std::size_t r = 0; r < scenario.recordings.size(); ++r) {
    sum_s += scenario.rest_between_s;
    if (time && time->recording == r) return sum_s + time->t_s;
    sum_s += scenario.recordings[r].duration_s;
  }
  return sum_s;
}

// One state is computed while the frames of those before are estimated.
std::string MostAhead(double rate_hz) {
  return std::to_string(static_cast<int>(std::ceil(kUsualLatency_s * rate_hz)) + 1);
}

void PlayBench(const SystemDemoOptions& options, const std::filesystem::path& robot,
               const DemoPlace& place, const std::filesystem::path& recording, DemoRun* run) {
  const std::filesystem::path scenario_file = ScenarioFile(options, robot, place.folder);
  const auto scenario = scenario::ReadScenario(scenario_file, app::LoadYaml);
  if (!scenario.camera)
    throw InputError(scenario_file.string() + ": the scenario has no camera; add the key 'camera'");
  {
    const DemoStep step(
        "[1/3] Start: virtual camera (GigE Vision), capture, perception, force "
        "estimation, virtual robot");
    AdviseOnKernel();
    run->processes().Start(
        {.name = "demo",
         .variables = {{"robot", robot.string()},
                       {"scenario", scenario_file.string()},
                       {"camera_address", place.CameraAddress()},
                       {"camera_pose", geometry::FormatPose(scenario.camera->T_robot_camera)}},
         .calibration = options.calibration,
         .settings = {"virtual_robot.rate_hz=" + FormatNumber(scenario.camera->rate_hz),
                      "virtual_robot.most_ahead=" + MostAhead(scenario.camera->rate_hz)},
         .last = "virtual_robot",
         .page = !options.no_view,
         .recording = recording});
    if (!run->AwaitComponents({"capture", "perception", "force_estimation"})) return;
    run->processes().StartLast();
    const auto answered = [&] { return run->comparison().frames() > 0; };
    if (!run->Listen(answered, kFirstForceLimit)) return;
  }
  TellPage(run);
  const int seconds = options.seconds > 0 ? options.seconds : kUsualSeconds;
  const DemoStep step(fmt::format("[2/3] {} s of {}: forces against truth", seconds,
                                  scenario_file.filename().string()));
  run->ShowTable();
  // A virtual robot of a fine mesh is slower than the clock: its own time counts.
  const bool by_bench = options.seconds == 0 && ScenarioTime_s(scenario, {}) >= seconds;
  const auto over = [&] {
    constexpr double kLastStates_s = 0.2;
    return by_bench && ScenarioTime_s(scenario, run->bench_time()) >= seconds - kLastStates_s;
  };
  run->Listen(over, duration<double>(by_bench ? kSlowestBench * seconds : seconds));
  run->HideTable();
}

/// A depth bias holds for the pose with which it was calibrated. Without one, the first frames of
/// each recording, which is a sequence, are used for it and give no forces. Of short recordings
/// none would be left.
std::vector<std::string> EstimationSettings(const ReplayedImages& images,
                                            const robot::CalibrationFile& calibration) {
  std::vector<std::string> settings;
  if (calibration.pose) {
    settings = {"force_estimation.camera_pose=''", "force_estimation.source=shape"};
  }
  const int bias_frames = force_estimation::ShapeConfig().untouched_frames;
  const bool biased = calibration.pose && calibration.depth_bias;
  if (biased || images.fewest_frames > bias_frames) return settings;
  fmt::print(
      "  recordings of {} frames and more, none with a calibrated depth bias: it is estimated with "
      "the forces of each frame. Intervals are wider (palpate calibrate, --calibration)\n",
      images.fewest_frames);
  settings.emplace_back("force_estimation.shape.untouched_frames=0");
  return settings;
}

void PlayRecordings(const SystemDemoOptions& options, const std::filesystem::path& robot,
                    const std::filesystem::path& recording, DemoRun* run) {
  const robot::CalibrationFile calibration =
      options.calibration.empty() ? robot::CalibrationFile()
                                  : robot::ReadCalibrationFile(options.calibration, app::LoadYaml);
  std::optional<Eigen::Isometry3d> calibrated;
  if (calibration.pose) calibrated = calibration.pose->T_robot_camera;
  const ReplayedImages images = ExamineImages(options.data, calibrated);
  {
    const DemoStep step("[1/3] Start: perception, force estimation, player");
    AdviseOnKernel();
    run->processes().Start(
        {.name = "replay",
         .variables = {{"robot", robot.string()},
                       {"data", std::filesystem::absolute(options.data)},
                       {"camera_pose", geometry::FormatPose(images.T_robot_camera)}},
         .calibration = options.calibration,
         .settings = EstimationSettings(images, calibration),
         .last = "player",
         .page = !options.no_view,
         .recording = recording});
    if (!run->AwaitComponents({"perception", "force_estimation"})) return;
    run->processes().StartLast();
    const auto answered = [&] { return run->comparison().frames() > 0; };
    if (!run->Listen(answered, kFirstForceLimit)) return;
  }
  TellPage(run);
  const DemoStep step(fmt::format("[2/3] {} recordings, {} frames, each estimated before the next",
                                  images.recordings, images.frames));
  run->ShowTable();
  const auto ended = [&] { return run->processes().HasEnded("player"); };
  run->Listen(ended, options.seconds > 0 ? duration<double>(options.seconds) : kLongestReplay);
  run->HideTable();
}

int Conclude(const DemoPlace& place, const std::filesystem::path& robot, bool with_truth,
             const std::filesystem::path& recording, DemoRun* run) {
  const std::string troubles = run->Troubles();
  run->processes().Stop();
  const DemoStep step("[3/3] Result");
  const LiveComparison& comparison = run->comparison();
  if (comparison.frames() == 0) {
    fmt::print("  no message arrived on /forces\n{}  logs: {}\n", troubles, place.folder.string());
    return app::kExitFailed;
  }
  fmt::print("{}{}", comparison.ToText(), run->stages().ToText());
  if (run->stages().frames() > 0) {
    WriteFile(place.folder / "latency.csv", run->stages().ToCsv());
    fmt::print("  {:<18} {}\n", "latency", (place.folder / "latency.csv").string());
  }
  WriteDemoResults(place.folder, robot, "Forces estimated from depth images", comparison);
  TellRecording(recording, robot);
  const bool worked = with_truth ? comparison.summary().found() > 0 : comparison.results() > 0;
  if (worked) return app::kExitDone;
  fmt::print("  failed: no {}\n{}  logs: {}\n",
             with_truth ? "steady force was detected" : "frame has a result", troubles,
             place.folder.string());
  return app::kExitFailed;
}

}  // namespace

int SystemDemo(const SystemDemoOptions& options) {
  const DemoPlace place = MakeDemoPlace(options.out);
  const std::filesystem::path robot =
      std::filesystem::absolute(FindRobotFile(options.robot.empty() ? "four_leg" : options.robot));
  const bool with_truth = options.data.empty();
  const std::filesystem::path recording = place.folder / "recording.mcap";
  fmt::print(
      "palpate demo: forces on a soft robot, estimated live from a depth camera.\nDDS domain {}, "
      "this machine only; results in {}\n",
      place.domain_id, place.folder.string());
  DemoRun run(place, with_truth ? LiveListener::Truth::kKnown : LiveListener::Truth::kNone,
              options.remap, SamePlace_m(BodyDiagonal_m(LoadRobot(robot)->body())));
  run.SetLogFolder(place.folder);
  if (with_truth) {
    PlayBench(options, robot, place, recording, &run);
  } else {
    PlayRecordings(options, robot, recording, &run);
  }
  return Conclude(place, robot, with_truth, recording, &run);
}

}  // namespace palpate::command

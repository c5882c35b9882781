// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/node/demo/system_processes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "components/palpate/launch/launch_plan.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace {

/// A demonstration without its page and its recording is still one.
constexpr const char* kPage = "view";
constexpr const char* kRecorder = "recorder";

bool IsNeeded(const std::string& process) { return process != kPage && process != kRecorder; }

/// What the page shows of a robot; images and clouds would be a hundred times as much.
ProcessPlan RecorderOf(const DemoSystem& demo) {
  ProcessPlan plan;
  plan.name = plan.component = kRecorder;
  plan.arguments = {"--out", demo.recording.string()};
  for (const char* large : {"/camera/*/image_raw*", "/perception/*_cloud"}) {
    plan.arguments.insert(plan.arguments.end(), {"--exclude", large});
  }
  plan.set = {"recent_s=0"};  // the whole run is recorded, so that snapshots add nothing
  plan.nice = 10;             // what it misses costs less than what it delays
  return plan;
}

/// Without an earlier recording of the same name, which palpate-recorder would not replace.
void AddRecorder(const DemoSystem& demo, HostPlan* host) {
  std::error_code error;
  std::filesystem::remove(demo.recording, error);
  if (error) {
    throw RunError("cannot replace " + demo.recording.string() + ": " + error.message());
  }
  host->processes.insert(host->processes.begin(), RecorderOf(demo));
}

}  // namespace

std::string PageUrlIn(const std::filesystem::path& log) {
  std::ifstream stream(log);
  constexpr std::string_view kMark = "page: ";
  for (std::string line; std::getline(stream, line);) {
    const std::size_t at = line.find(kMark);
    if (at != line.npos) return line.substr(at + kMark.size());
  }
  return {};
}

void LogFiles::Line(const std::string& process, std::string_view line) {
  Append(FileOf(process), line);
}

void LogFiles::Event(const std::string& process, Severity, const std::string& text) {
  Append(folder_ / "launch.log", process.empty() ? text : process + ": " + text);
}

std::filesystem::path LogFiles::FileOf(const std::string& process) const {
  std::string name = process;
  std::replace(name.begin(), name.end(), '_', '-');
  return folder_ / (name + ".log");
}

void LogFiles::Append(const std::filesystem::path& file, std::string_view line) {
  const bool begins = begun_.emplace(file, true).second;
  std::ofstream stream(file, begins ? std::ios::trunc : std::ios::app);
  stream << line << '\n';
  stream.close();
  if (!stream) throw RunError("cannot write " + file.string() + ": " + std::strerror(errno));
}

void SystemProcesses::Start(const DemoSystem& demo) {
  SystemFile system = ReadSystemFile(FindSystemFile(demo.name), app::LoadYaml, demo.variables);
  system.domain_id = place_.domain_id;
  HostPlan& host = ChooseHost(system, "");
  if (!demo.page) {
    std::erase_if(host.processes, [](const ProcessPlan& plan) { return plan.name == kPage; });
  }
  if (!demo.recording.empty()) AddRecorder(demo, &host);
  for (ProcessPlan& plan : host.processes) {
    plan.respawn.reset();
    plan.remap.insert(plan.remap.end(), remap_.begin(), remap_.end());
  }
  for (const std::string& setting : demo.settings) ApplySet(setting, &host);
  if (!demo.calibration.empty()) {
    auto& words = FindProcess(host, "force_estimation").arguments;
    words.insert(words.end(), {"--calibration", demo.calibration.string()});
  }
  launcher_ = std::make_unique<Launcher>(MakeLaunchPlan(system, host), system.stop, &logs_);
  last_ = demo.last;
  launcher_->Hold(last_);
  CheckAlive();
}

void SystemProcesses::StartLast() {
  PALPATE_CHECK(launcher_ != nullptr, "nothing was started");
  launcher_->Release(last_);
  CheckAlive();
}

void SystemProcesses::CheckAlive() {
  if (!launcher_) return;
  launcher_->Turn(0.0);
  for (const ProcessReport& report : launcher_->Reports()) {
    if (report.state != LaunchState::kFailed || !IsNeeded(report.name)) continue;
    RefuseEnded(report.name, report.reason, logs_.FileOf(report.name));
  }
}

bool SystemProcesses::HasEnded(const std::string& process) const {
  for (const ProcessReport& report : launcher_->Reports()) {
    if (report.name == process) return report.state == LaunchState::kFinished;
  }
  return false;
}

bool SystemProcesses::HasPage() const {
  if (!launcher_) return false;
  const std::vector<ProcessReport> reports = launcher_->Reports();
  return std::any_of(reports.begin(), reports.end(), [](const ProcessReport& one) {
    return one.name == kPage && one.state != LaunchState::kFailed;
  });
}

std::string SystemProcesses::PageUrl() const {
  // Where there is no page, the log is an old one.
  return HasPage() ? PageUrlIn(logs_.FileOf(kPage)) : std::string();
}

void SystemProcesses::Stop() {
  if (launcher_) launcher_->StopAll("the demonstration ends");
}

}  // namespace palpate::command

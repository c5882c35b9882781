// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/palpate/launch/launcher.hpp"
#include "components/palpate/node/demo/demo_place.hpp"

namespace palpate::command {

/// What a demonstration changes of a system file.
struct DemoSystem {
  std::string name;  ///< in config/systems
  SystemVariables variables;
  std::filesystem::path calibration;       ///< of the process force_estimation; empty: none
  std::vector<std::string> settings = {};  ///< "PROCESS.KEY=VALUE"
  std::string last;                        ///< the process that starts at StartLast()
  bool page = true;                        ///< with the process view
  std::filesystem::path recording = {};    ///< of all but images and clouds; empty: none
};

/// How long to wait for the page. A demonstration goes on without it.
constexpr std::chrono::seconds kPageLimit(10);

/// What palpate-view has written to its log about where the page is; empty: nothing yet.
std::string PageUrlIn(const std::filesystem::path& log);

/// Each process writes to a log of its own, "force-estimation.log".
class LogFiles : public LaunchOutput {
 public:
  explicit LogFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void Line(const std::string& process, std::string_view line) override;
  void Event(const std::string& process, Severity severity, const std::string& text) override;
  std::filesystem::path FileOf(const std::string& process) const;

 private:
  void Append(const std::filesystem::path& file, std::string_view line);

  std::filesystem::path folder_;
  std::map<std::filesystem::path, bool> begun_;
};

/// The processes of a system file on one machine, in the domain of the demonstration, without
/// restarts. All end with this object.
class SystemProcesses {
 public:
  /// `remap`: rules for the names of topics, for every process.
  SystemProcesses(const DemoPlace& place, std::vector<std::string> remap)
      : place_(place), remap_(std::move(remap)), logs_(place.folder) {}

  /// Starts all but the last one. Throws InputError and RunError.
  void Start(const DemoSystem& system);
  void StartLast();

  /// To be called often: passes on what the processes write. Throws RunError where one has failed.
  void CheckAlive();
  /// Whether the process has ended.
  bool HasEnded(const std::string& process) const;
  /// Whether the process of the live page runs or will run.
  bool HasPage() const;
  /// Of the live page, once it has said so; empty: not yet, or there is none.
  std::string PageUrl() const;
  /// Lets all end, the youngest first.
  void Stop();

 private:
  const DemoPlace& place_;
  std::vector<std::string> remap_;
  LogFiles logs_;
  std::string last_;
  std::unique_ptr<Launcher> launcher_;
};

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "libs/app/child_process.hpp"

namespace palpate::command {

/// Surroundings of a demonstration: its folder, the programs that it starts, and a DDS domain of
/// its own on 127.0.0.1.
struct DemoPlace {
  std::filesystem::path folder;
  std::filesystem::path programs;
  int domain_id = 0;

  /// A loopback address that no other demonstration uses, for the virtual camera.
  std::string CameraAddress() const;
  /// Starts a program in the domain; its output goes to `log` in the folder. Throws RunError.
  std::unique_ptr<app::ChildProcess> Start(const std::string& program,
                                           std::vector<std::string> arguments,
                                           const std::string& log) const;
};

/// `out`: the folder, made where it is absent; empty: demo/ beside the folder of the programs. From
/// then on this process, and those that it starts, use DDS on loopback only
/// (config/cyclonedds/one_host.xml). Throws InputError and RunError.
DemoPlace MakeDemoPlace(const std::filesystem::path& out);

/// Throws RunError with the process, how it ended, its log and the last line of the log.
[[noreturn]] void RefuseEnded(const app::ChildProcess& process, int exit_code);
[[noreturn]] void RefuseEnded(const std::string& process, const std::string& end,
                              const std::filesystem::path& log);

}  // namespace palpate::command

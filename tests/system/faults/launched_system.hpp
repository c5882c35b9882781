// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/system/process.hpp"
#include "tests/system/sample_data.hpp"

namespace palpate::system_test {

/// Virtual robot, virtual camera, capture, perception and force estimation, as `palpate launch`
/// starts them. A ball presses the robot from the sixth second on; ten frames come a second.
class LaunchedSystem {
 public:
  struct Settings {
    std::string camera_address;  ///< on loopback, of this test alone
    std::string keys = {};       ///< of the system file, "allow_faults: true\n"
    std::string respawn = {};    ///< of each process, "{backoff_s: 0.5}"; empty: none
  };

  LaunchedSystem(const TestFolder& folder, const Settings& settings);

  Process& launch() { return launch_; }
  /// The processes that run now, by component; those that were just killed are missing.
  std::map<std::string, pid_t> Pids() const;

 private:
  Process launch_;
};

}  // namespace palpate::system_test

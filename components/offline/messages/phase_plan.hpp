// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"
#include "libs/core/key_table.hpp"
#include "libs/experiment/experiment.hpp"

namespace palpate::offline {

/// A stretch of a recording that becomes one recording of the experiment.
struct Phase {
  experiment::Recording recording;                                   ///< name and settings
  std::int64_t begin_ns = std::numeric_limits<std::int64_t>::min();  ///< on the clock of t_s
  std::int64_t end_ns = std::numeric_limits<std::int64_t>::max();    ///< included
  int segment = kAnySegment;                                         ///< with stamps of its own

  static constexpr int kAnySegment = -1;
  bool Contains(std::int64_t t_ns, int of_segment) const {
    return t_ns >= begin_ns && t_ns <= end_ns && (segment == kAnySegment || segment == of_segment);
  }
};

/// The file of phases beside a recording, and what it says about the topics.
struct PhaseFile {
  std::filesystem::path file;
  std::string robot_frame = "robot";
  std::optional<Eigen::Vector3d> load_point_m;  ///< of wrenches, on the undeformed body
  std::map<std::string, std::string> cables;    ///< joint -> cable; empty: joints are cables
  experiment::Experiment experiment;            ///< settings alone
  std::vector<Phase> phases;
};

/// The keys of a file of phases.
const KeyTable& PhaseFileKeys();

/// FILE.phases.yaml beside FILE.mcap, or phases.yaml in a folder; nullopt: there is none. Throws
/// InputError (file:line:column).
std::optional<PhaseFile> ReadPhaseFile(const std::filesystem::path& target,
                                       const ConfigLoader& load);

/// Where the file would be.
std::filesystem::path PhaseFileOf(const std::filesystem::path& target);

/// A word on /experiment/phase, "KIND" or "KIND NAME". nullopt: the phase ends, without another
/// ("end", or nothing). Throws InputError for an unknown kind.
std::optional<experiment::Recording> ParsePhase(const std::string& text);

}  // namespace palpate::offline

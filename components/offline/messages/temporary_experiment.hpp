// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "libs/core/config_node.hpp"

namespace palpate::offline {

/// Whether `data` is or holds recorded messages, not an experiment.
bool HoldsMessages(const std::filesystem::path& data);

/// Recorded messages as an experiment (MakeExperiment) in a temporary folder, which ends with this.
class TemporaryExperiment {
 public:
  /// Called with the folder when it is there, and with nothing before it is removed.
  using Watch = std::function<void(const std::filesystem::path&)>;

  /// Throws as MakeExperiment; RunError where no folder can be made.
  TemporaryExperiment(const std::filesystem::path& data, const std::vector<std::string>& remap,
                      const std::filesystem::path& robot, const ConfigLoader& load,
                      Watch watch = {});
  ~TemporaryExperiment();
  TemporaryExperiment(const TemporaryExperiment&) = delete;
  TemporaryExperiment& operator=(const TemporaryExperiment&) = delete;

  const std::filesystem::path& path() const { return path_; }       ///< of the experiment
  const std::vector<std::string>& notes() const { return notes_; }  ///< what was made of them
  /// `text` with the messages' name in the place of the folder, which is gone soon.
  std::string Named(std::string text) const;

 private:
  void Remove() const;

  std::filesystem::path data_;
  std::filesystem::path folder_;
  std::filesystem::path path_;
  Watch watch_;
  std::vector<std::string> notes_;
};

}  // namespace palpate::offline

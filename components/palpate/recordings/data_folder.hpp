// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "components/offline/messages/temporary_experiment.hpp"
#include "libs/app/arguments.hpp"

namespace palpate::command {

/// What --data names: an experiment or recording folder, or recorded messages, which are then made
/// into an experiment in a folder that ends with this.
class DataFolder {
 public:
  /// Prints on the standard error output what was made of the messages, of the robot of that file
  /// (MakeExperiment). Throws as MakeExperiment; InputError, too, where `remap` is given for a
  /// folder.
  DataFolder(const std::filesystem::path& data, const std::vector<std::string>& remap,
             const std::filesystem::path& robot);

  const std::filesystem::path& path() const { return path_; }

  /// Runs a verb. The text of an InputError that names a file of the folder names `data` instead.
  int Run(const std::function<int(const std::filesystem::path&)>& verb) const;

  /// `text` with the recording's name in the place of the folder, which is gone soon.
  std::string Named(std::string text) const;

 private:
  std::filesystem::path path_;
  std::unique_ptr<const offline::TemporaryExperiment> made_;  ///< of recorded messages
};

/// The option --remap of a verb with --data.
void DeclareRemap(app::Arguments& arguments, std::vector<std::string>* remap);

}  // namespace palpate::command

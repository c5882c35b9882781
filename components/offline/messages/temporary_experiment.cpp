// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/temporary_experiment.hpp"

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "components/offline/messages/make_experiment.hpp"
#include "libs/core/error.hpp"
#include "libs/recording/recorded_messages.hpp"

namespace palpate::offline {

namespace {

namespace fs = std::filesystem;

fs::path MakeTemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "palpate_data_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw RunError(name + ": cannot be created: " + std::strerror(errno) +
                   "; name a folder with TMPDIR");
  }
  return name;
}

}  // namespace

bool HoldsMessages(const fs::path& data) {
  return !data.empty() && !recording::MessageFilesOf(data).empty();
}

TemporaryExperiment::TemporaryExperiment(const fs::path& data,
                                         const std::vector<std::string>& remap,
                                         const fs::path& robot, const ConfigLoader& load,
                                         Watch watch)
    : data_(data),
      folder_(MakeTemporaryFolder()),
      path_(folder_ / "experiment"),
      watch_(std::move(watch)) {
  if (watch_) watch_(folder_);
  try {
    notes_ = MakeExperiment(data, remap, robot, path_, load);
  } catch (...) {
    Remove();
    throw;
  }
}

TemporaryExperiment::~TemporaryExperiment() { Remove(); }

void TemporaryExperiment::Remove() const {
  if (watch_) watch_({});
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string TemporaryExperiment::Named(std::string text) const {
  const std::string folder = path_.string();
  bool named = false;
  for (std::size_t at = text.find(folder); at != text.npos; at = text.find(folder, at)) {
    text.replace(at, folder.size(), data_.string() + " as an experiment");
    named = true;
  }
  if (named) text += " (`palpate export --experiment` keeps these files)";
  return text;
}

}  // namespace palpate::offline

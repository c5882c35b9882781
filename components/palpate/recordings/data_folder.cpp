// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/data_folder.hpp"

#include <fmt/core.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "components/palpate/end_on_signal.hpp"
#include "components/palpate/recordings/make_experiment.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/recording/recorded_messages.hpp"

namespace palpate::command {

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

DataFolder::DataFolder(const fs::path& data, const std::vector<std::string>& remap,
                       const fs::path& robot)
    : data_(data), path_(data) {
  if (data.empty() || recording::MessageFilesOf(data).empty()) {
    if (remap.empty()) return;
    throw InputError({data.string()},
                     "holds no recorded messages, so that --remap means nothing; leave it out");
  }
  temporary_ = MakeTemporaryFolder();
  RemoveOnSignal(temporary_);
  path_ = temporary_ / "experiment";
  try {
    for (const std::string& note : MakeExperiment(data, remap, robot, path_, app::LoadYaml)) {
      fmt::print(stderr, "{}: {}\n", data.string(), note);
    }
  } catch (...) {
    Remove();
    throw;
  }
}

DataFolder::~DataFolder() { Remove(); }

void DataFolder::Remove() const {
  if (temporary_.empty()) return;
  RemoveOnSignal({});
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

int DataFolder::Run(const std::function<int(const fs::path&)>& verb) const {
  if (temporary_.empty()) return verb(path_);
  try {
    return verb(path_);
  } catch (const InputError& error) {
    throw InputError(Named(error.what()));
  }
}

std::string DataFolder::Named(std::string text) const {
  if (temporary_.empty()) return text;
  const std::string folder = path_.string();
  bool named = false;
  for (std::size_t at = text.find(folder); at != text.npos; at = text.find(folder, at)) {
    text.replace(at, folder.size(), data_.string() + " as an experiment");
    named = true;
  }
  if (named) text += " (`palpate export --experiment` keeps these files)";
  return text;
}

void DeclareRemap(app::Arguments& arguments, std::vector<std::string>* remap) {
  arguments.Repeated("--remap FROM:=TO", remap,
                     "Take topic FROM of recorded messages for TO; another name than those of "
                     "docs/experiment.md leaves it out");
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/recordings/data_folder.hpp"

#include <fmt/core.h>

#include <utility>

#include "components/palpate/end_on_signal.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"

namespace palpate::command {

namespace fs = std::filesystem;

DataFolder::DataFolder(const fs::path& data, const std::vector<std::string>& remap,
                       const fs::path& robot)
    : path_(data) {
  if (!offline::HoldsMessages(data)) {
    if (remap.empty()) return;
    throw InputError({data.string()},
                     "holds no recorded messages, so that --remap means nothing; leave it out");
  }
  made_ = std::make_unique<offline::TemporaryExperiment>(data, remap, robot, app::LoadYaml,
                                                         RemoveOnSignal);
  path_ = made_->path();
  for (const std::string& note : made_->notes()) {
    fmt::print(stderr, "{}: {}\n", data.string(), note);
  }
}

int DataFolder::Run(const std::function<int(const fs::path&)>& verb) const {
  if (!made_) return verb(path_);
  try {
    return verb(path_);
  } catch (const InputError& error) {
    throw InputError(Named(error.what()));
  }
}

std::string DataFolder::Named(std::string text) const {
  return made_ ? made_->Named(std::move(text)) : text;
}

void DeclareRemap(app::Arguments& arguments, std::vector<std::string>* remap) {
  arguments.Repeated("--remap FROM:=TO", remap,
                     "Take topic FROM of recorded messages for TO; another name than those of "
                     "docs/experiment.md leaves it out");
}

}  // namespace palpate::command

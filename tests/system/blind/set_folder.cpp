// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/blind/set_folder.hpp"

#include <unistd.h>

#include <string>
#include <system_error>

namespace palpate::blind {

namespace fs = std::filesystem;

SetFolder::SetFolder(const fs::path& to_keep)
    : keeps_(!to_keep.empty()),
      path_(keeps_ ? fs::absolute(to_keep)
                   : fs::temp_directory_path() / ("palpate_blind_" + std::to_string(getpid()))) {
  fs::create_directories(path_);
}

SetFolder::~SetFolder() {
  std::error_code ignored;
  if (!keeps_) fs::remove_all(path_, ignored);
}

}  // namespace palpate::blind

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

namespace palpate::blind {

/// Where a set works: the folder that is to keep everything, else a new one in the temporary folder
/// of the machine, which is removed at the end.
class SetFolder {
 public:
  /// `to_keep`: made where it is not there; empty: nothing is kept.
  explicit SetFolder(const std::filesystem::path& to_keep);
  ~SetFolder();
  SetFolder(const SetFolder&) = delete;
  SetFolder& operator=(const SetFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }  ///< absolute
  bool keeps() const { return keeps_; }

 private:
  bool keeps_;
  std::filesystem::path path_;
};

}  // namespace palpate::blind

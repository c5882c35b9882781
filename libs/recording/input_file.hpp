// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace palpate::recording {

/// A file of any size, read piece by piece. Safe from many threads at once.
class InputFile {
 public:
  /// Throws InputError where it cannot be read.
  explicit InputFile(std::filesystem::path file);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& path() const { return file_; }
  std::uint64_t size() const { return size_; }

  /// Up to `size` bytes from `offset` on; fewer where the file ends. Throws InputError for a disk
  /// that cannot be read.
  std::string Read(std::uint64_t offset, std::uint64_t size) const;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace palpate::recording

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace palpate::recording {

/// Where a recording goes. Bytes are in the file, or in the system's care, once Append() returned.
class Output {
 public:
  virtual ~Output() = default;
  /// Throws RunError where not all of it was taken, for instance on a full disk.
  virtual void Append(std::string_view bytes) = 0;
  /// Cuts what was appended to its first `size` bytes. Throws RunError.
  virtual void Truncate(std::uint64_t size) = 0;
  /// Throws RunError where the system reports a late error.
  virtual void Close() = 0;
};

/// A new file, written without a buffer of its own: a killed process loses nothing of it.
class OutputFile : public Output {
 public:
  /// Throws RunError where the file exists or cannot be made.
  explicit OutputFile(std::filesystem::path file);
  ~OutputFile() override;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void Append(std::string_view bytes) override;
  void Truncate(std::uint64_t size) override;
  void Close() override;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace palpate::recording

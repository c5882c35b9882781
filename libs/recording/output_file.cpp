// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/recording/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "libs/core/error.hpp"

namespace palpate::recording {

namespace {

[[noreturn]] void CannotWrite(const std::filesystem::path& file, int error) {
  throw RunError(file.string() + ": cannot be written: " + std::strerror(error));
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)) {
  constexpr mode_t kMode = 0666;
  descriptor_ = open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
  if (descriptor_ < 0) CannotWrite(file_, errno);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void OutputFile::Append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) CannotWrite(file_, written == 0 ? ENOSPC : errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFile::Truncate(std::uint64_t size) {
  const auto offset = static_cast<off_t>(size);
  if (ftruncate(descriptor_, offset) != 0) CannotWrite(file_, errno);
  if (lseek(descriptor_, offset, SEEK_SET) != offset) CannotWrite(file_, errno);
}

void OutputFile::Close() {
  if (descriptor_ < 0) return;
  const int result = close(std::exchange(descriptor_, -1));
  if (result != 0) CannotWrite(file_, errno);
}

}  // namespace palpate::recording

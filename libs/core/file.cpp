// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "libs/core/error.hpp"
#include "libs/core/large_pages.hpp"

namespace palpate {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

std::string Cause() { return std::strerror(errno); }

void WriteWhole(const std::filesystem::path& file, const std::string& bytes) {
  FileHandle handle(std::fopen(file.c_str(), "wb"));
  if (handle == nullptr) throw RunError(file.string() + ": cannot be written: " + Cause());
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), handle.get()) == bytes.size() &&
                       std::fflush(handle.get()) == 0;
  if (!written || std::fclose(handle.release()) != 0) {
    throw RunError(file.string() + ": cannot be written: " + Cause());
  }
}

}  // namespace

std::string ReadFile(const std::filesystem::path& file) {
  const FileHandle handle(std::fopen(file.c_str(), "rb"));
  if (handle == nullptr) throw InputError({file.string()}, "cannot be read: " + Cause());
  std::string bytes;
  std::error_code unknown_size;  // of a pipe
  const auto size = std::filesystem::file_size(file, unknown_size);
  if (!unknown_size) bytes.reserve(size);
  AdviseLargePages(bytes);
  std::string block(1 << 16, '\0');
  while (const size_t count = std::fread(block.data(), 1, block.size(), handle.get())) {
    bytes.append(block, 0, count);
  }
  if (std::ferror(handle.get()) != 0) {
    throw InputError({file.string()}, "cannot be read: " + Cause());
  }
  return bytes;
}

void WriteFile(const std::filesystem::path& file, const std::string& bytes) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error)) {
    WriteWhole(file, bytes);
    return;
  }
  std::filesystem::path whole = file;
  whole += ".part" + std::to_string(getpid());
  try {
    WriteWhole(whole, bytes);
    std::filesystem::rename(whole, file);
  } catch (const std::filesystem::filesystem_error& failure) {
    std::filesystem::remove(whole, error);
    throw RunError(file.string() + ": cannot be written: " + failure.code().message());
  } catch (const RunError&) {
    std::filesystem::remove(whole, error);
    throw;
  }
}

}  // namespace palpate

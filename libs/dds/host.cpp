// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/dds/host.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>

namespace palpate::dds {

namespace {

constexpr std::size_t kIdLength = 13;  // of the boot identifier's 36 characters

std::string HostName() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// What a partition's name and the user data of a participant can hold.
std::string Plain(std::string text) {
  const auto is_special = [](char c) { return c == ';' || c == ',' || c == '=' || c == '*'; };
  std::replace_if(text.begin(), text.end(), is_special, '_');
  return text;
}

}  // namespace

Host ThisHost() {
  const char* given = std::getenv("PALPATE_HOST");
  if (given != nullptr && *given != '\0') return {Plain(given), Plain(given)};
  std::string boot_id;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot_id;
  const std::string name = Plain(HostName());
  return {boot_id.empty() ? name : boot_id.substr(0, kIdLength), name};
}

}  // namespace palpate::dds

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>

namespace palpate::dds {

/// The machine on which a process runs, that is: its clock.
struct Host {
  std::string id;    ///< equal in all processes of one running kernel, containers too
  std::string name;  ///< for a person
};

/// This machine: the kernel's boot identifier and the host's name. The environment variable
/// PALPATE_HOST replaces both; tests use it to be several hosts.
Host ThisHost();

}  // namespace palpate::dds

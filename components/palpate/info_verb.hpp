// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct InfoOptions {
  std::filesystem::path target;  ///< robot, mesh, folder of measured data, or any other file
  std::string unit;              ///< of the lengths in a mesh file: m, cm or mm; empty: not told
  std::filesystem::path png;     ///< of the undeformed robot, to draw; empty: none
  bool json = false;
};

/// `palpate info`: what a file or folder is, what it holds, and which verb takes it. Throws
/// InputError where that is not known, and for a picture of what is no robot.
int Info(const InfoOptions& options);

app::Verb InfoVerb();

}  // namespace palpate::command

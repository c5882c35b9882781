// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct DemoOptions {
  std::filesystem::path out;   ///< empty: demo/ beside the folder of the program
  std::filesystem::path data;  ///< folder with silicone_beam/; empty: see FindMeasuredData
  bool computed = false;       ///< the computed data set, though the measured one is there
};

/// `palpate demo`: from recordings of a beam to the weight that hangs on it, through the processes
/// and DDS on loopback, and a picture of it. Returns 0 where a force was found, else 1; throws
/// InputError and RunError.
int Demo(const DemoOptions& options);

app::Verb DemoVerb();

}  // namespace palpate::command

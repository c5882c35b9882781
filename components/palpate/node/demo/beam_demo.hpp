// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

namespace palpate::command {

struct BeamDemoOptions {
  std::filesystem::path out;   ///< empty: demo/ beside the folder of the program
  std::filesystem::path data;  ///< folder with silicone_beam/; empty: see FindMeasuredData
  bool computed = false;       ///< the computed data set, though the measured one is there
};

/// `palpate demo --recording beam`: from recordings of a beam to the weight that hangs on it,
/// through the processes and DDS on loopback, and a picture of it. Returns 0 where a force was
/// found, else 1; throws InputError and RunError.
int BeamDemo(const BeamDemoOptions& options);

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>

namespace palpate::command {

struct BeamDemoOptions {
  std::filesystem::path out;   ///< empty: demo/ beside the folder of the program
  std::filesystem::path data;  ///< folder with silicone_beam/; empty: see FindMeasuredData
  bool computed = false;       ///< the computed data set even where the measured one is there
  bool no_view = false;        ///< without the live page
};

/// `palpate demo --recording beam`: estimates the weight that hangs on a beam from its recordings,
/// through the processes and DDS on loopback, and writes forces.svg, scene.png and recording.mcap.
/// Returns 0 where a force was estimated, else 1; throws InputError and RunError.
int BeamDemo(const BeamDemoOptions& options);

}  // namespace palpate::command

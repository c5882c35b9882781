// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>

#include "components/palpate/node/demo/beam_demo.hpp"
#include "components/palpate/node/demo/system_demo.hpp"
#include "libs/app/verbs.hpp"

namespace palpate::command {

struct DemoOptions {
  SystemDemoOptions system;
  std::string recording;                ///< "beam": BeamDemo, with system.out and system.data
  bool computed = false;                ///< BeamDemo with the computed data set
  std::filesystem::path keystore = {};  ///< of a secured domain; empty: as the environment has it
};

/// `palpate demo`: SystemDemo, or BeamDemo with --recording beam or --computed. Throws InputError
/// for options that do not go together.
int Demo(const DemoOptions& options);

app::Verb DemoVerb();

}  // namespace palpate::command

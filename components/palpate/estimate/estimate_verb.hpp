// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "libs/app/verbs.hpp"

namespace palpate::command {

struct EstimateOptions {
  std::filesystem::path robot;
  std::filesystem::path calibration;    ///< empty: the moduli of the robot file, with a warning
  std::filesystem::path data;           ///< experiment or recording folder, or recorded messages
  std::vector<std::string> remap;       ///< FROM:=TO, of recorded messages
  std::vector<std::string> recordings;  ///< names; empty: all that can be estimated
  std::string from;  ///< "markers" | "shape"; empty: shape where there are images
  /// Frames from which the depth bias is estimated: "recordings" (FindBiasFrames), "first" (the
  /// first shape.untouched_frames frames; all else, too, is as the processes do it), "none".
  std::string bias_frames = "recordings";
  std::vector<std::string> contacts;   ///< added to the settings' contacts
  std::filesystem::path config;        ///< EstimateSettings; empty: defaults
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::string cable_input = "displacement";
  double rate_Hz = 0.0;  ///< largest frame rate; 0: all frames
  std::filesystem::path out;
  std::filesystem::path plot;    ///< SVG of forces over time; empty: none
  std::filesystem::path answer;  ///< EXP.answer.json to compare with; empty: none
  bool json = false;
};

/// `palpate estimate`: forces from the images or the markers of recordings, written as forces.csv.
/// Returns 0, or 1 where not a single frame had a result, or a rest recording has forces. Throws
/// InputError and RunError, and app::Interrupted once the forces of the frames before a signal are
/// written.
int Estimate(const EstimateOptions& options);

app::Verb EstimateVerb();

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/forces/rest_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "components/offline/forces/estimate_plan.hpp"
#include "components/offline/forces/has_force.hpp"

namespace palpate::offline {

RestCheck::RestCheck(const experiment::Experiment& experiment,
                     const experiment::Recording& recording, const Known& known,
                     const RestCheckTuning& tuning)
    : experiment_(experiment), recording_(recording), known_(known), tuning_(tuning) {}

void RestCheck::Add(const force_estimation::ForceEstimate& estimate) {
  if (recording_.kind != experiment::RecordingKind::kRest || !IsContactFree(recording_)) return;
  const auto& window = recording_.steady_window_s;
  if (!force_estimation::IsUsable(estimate.status) || (window && !window->Contains(estimate.t_s)))
    return;
  ++frames_;
  touched_frames_ += estimate.status.ok() ? 1 : 0;
  for (const auto& contact : estimate.contacts) {
    if (HasForce(contact)) largest_N_ = std::max(largest_N_, contact.force_N.norm());
  }
}

std::optional<std::string> RestCheck::Failure() const {
  const double expected = known_.significance * frames_;
  const double by_chance = expected + tuning_.chance_sigmas * std::sqrt(expected) + 2.0;
  if (touched_frames_ <= std::max(by_chance, tuning_.accepted_share * frames_)) return std::nullopt;
  const std::string size = largest_N_ > 0.0 ? fmt::format(", up to {:.2g} N", largest_N_) : "";
  return fmt::format(
      "{}: contacts in {} of {} frames of a rest recording{}, where nothing touches the robot: "
      "forces of the other recordings are as wrong. Likely reasons: {}",
      recording_.name, touched_frames_, frames_, size, Reasons());
}

std::string RestCheck::Reasons() const {
  std::vector<std::string> likely;
  std::vector<std::string> possible;
  const auto& reference = recording_.reference;
  const bool straight = reference && reference->shape == experiment::ReferenceShape::kUndeformed;
  (straight && !known_.gravity_m_s2.isZero() ? likely : possible)
      .push_back(straight ? "rest shape (recording.yaml says undeformed, but gravity acts; "
                            "equilibrium unless it was held straight)"
                          : "rest shape (the body was held or had not settled)");
  (experiment_.markers_sigma_m || !recording_.markers ? possible : likely)
      .emplace_back("noise (markers_sigma_m of experiment.yaml)");
  (known_.calibrated ? possible : likely)
      .emplace_back("modulus (palpate calibrate, and --calibration here)");
  (reference ? possible : likely)
      .emplace_back("pose (frame and T_robot_camera; palpate import --register)");
  likely.insert(likely.end(), possible.begin(), possible.end());
  std::string text;
  for (std::size_t k = 0; k < likely.size(); ++k) {
    text += fmt::format("{}{}) {}", k == 0 ? "" : ", ", k + 1, likely[k]);
  }
  return text;
}

}  // namespace palpate::offline

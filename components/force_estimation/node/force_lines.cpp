// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/node/force_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>

namespace palpate::force_estimation {

namespace {

bool HasNumber(const ContactForce& contact) {
  switch (contact.status.code()) {
    case StatusCode::kNotRun:
    case StatusCode::kNoContact:
    case StatusCode::kUnobservable:
    case StatusCode::kInvalidInput: return false;
    default: return contact.force_N.allFinite() && !contact.force_N.isZero(0.0);
  }
}

std::string TextOf(const ContactForce& contact) {
  const Eigen::Vector3d at_mm = 1e3 * contact.position_m;
  std::string text =
      fmt::format("{} {:.3f} +- {:.3f} N at ({:.0f}, {:.0f}, {:.0f}) mm", contact.name,
                  contact.force_N.norm(), contact.ci95_N, at_mm.x(), at_mm.y(), at_mm.z());
  if (!contact.status.ok()) text += fmt::format(" ({})", ToString(contact.status.code()));
  return text;
}

}  // namespace

void ForceLines::Add(const ForceEstimate& estimate) {
  ++frames_;
  if (!IsUsable(estimate.status)) return;
  ++usable_frames_;
  for (const ContactForce& contact : estimate.contacts) {
    if (!HasNumber(contact)) continue;
    const auto [force, is_new] = forces_.try_emplace(contact.name);
    if (is_new) force->second.begin_s = taken_s_;
    force->second.last = contact;
    ++force->second.frames;
    force->second.largest_N = std::max(force->second.largest_N, contact.force_N.norm());
  }
}

std::vector<std::string> ForceLines::Take(double now_s) {
  std::vector<std::string> lines;
  const std::string summary = Summary(now_s - taken_s_);
  if (!summary.empty()) lines.push_back(summary);
  for (auto force = forces_.begin(); force != forces_.end();) {
    const auto next = std::next(force);
    if (force->second.frames == 0 && usable_frames_ > 0) {
      lines.push_back(fmt::format("force '{}' ended after {:.1f} s, at most {:.3f} N", force->first,
                                  taken_s_ - force->second.begin_s, force->second.largest_N));
      forces_.erase(force);
    } else {
      force->second.frames = 0;
    }
    force = next;
  }
  frames_ = usable_frames_ = 0;
  taken_s_ = now_s;
  return lines;
}

/// Empty where the interval has no force.
std::string ForceLines::Summary(double interval_s) const {
  std::string text;
  for (const auto& [name, force] : forces_) {
    if (force.frames == 0) continue;
    text += fmt::format("{}{} in {} of {} frames", text.empty() ? "forces: " : "; ",
                        TextOf(force.last), force.frames, frames_);
  }
  if (text.empty() || interval_s <= 0.0) return text;
  return text + fmt::format("; {:.1f} frames/s", frames_ / interval_s);
}

}  // namespace palpate::force_estimation

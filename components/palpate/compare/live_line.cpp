// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/live_line.hpp"

#include <fmt/core.h>

namespace palpate::command {

namespace {

// Smaller true forces are not shown: they are below what can be detected.
constexpr double kShown_N = 0.05;

std::string EstimateText(const force_estimation::ContactForce& contact) {
  const Eigen::Vector3d at_mm = 1e3 * contact.position_m;
  return fmt::format("{:.3f} +- {:.3f} N at ({:.0f}, {:.0f}, {:.0f}) mm{}", contact.force_N.norm(),
                     contact.ci95_N, at_mm.x(), at_mm.y(), at_mm.z(),
                     contact.status.code() == StatusCode::kHidden ? " out of view" : "");
}

std::string Text(const ComparedForce& force) {
  if (!force.truth) return force.estimate->name + " " + EstimateText(*force.estimate) + ", true 0";
  const double true_N = force.truth->force_N.norm();
  if (force.estimate) {
    return fmt::format("{} {}, true {:.3f} N", force.truth->name, EstimateText(*force.estimate),
                       true_N);
  }
  return true_N < kShown_N
             ? std::string()
             : fmt::format("{} not detected, true {:.3f} N", force.truth->name, true_N);
}

}  // namespace

std::string LiveLine(const force_estimation::ForceEstimate& estimate,
                     const std::vector<ComparedForce>& compared) {
  std::string line =
      fmt::format("{:6.1f} s  {:<14}", estimate.t_s, ToString(estimate.status.code()));
  std::vector<std::string> parts;
  for (const ComparedForce& force : compared) parts.push_back(Text(force));
  for (const force_estimation::ContactForce& contact : estimate.contacts) {
    if (compared.empty() && HasForce(contact)) {
      parts.push_back(contact.name + " " + EstimateText(contact));
    }
  }
  bool first = true;
  for (const std::string& part : parts) {
    if (part.empty()) continue;
    line += (first ? "  " : " | ") + part;
    first = false;
  }
  return line;
}

std::string Cut(const std::string& line, std::size_t columns) {
  if (line.size() <= columns) return line;
  return columns < 4 ? line.substr(0, columns) : line.substr(0, columns - 3) + "...";
}

}  // namespace palpate::command

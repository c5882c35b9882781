// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/estimate/force_summary.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/force_estimation/shape/known_contacts.hpp"
#include "components/palpate/compare/force_comparison.hpp"
#include "libs/core/statistics.hpp"

namespace palpate::command {

namespace {

double MedianOr0(std::vector<double> values) { return values.empty() ? 0.0 : UpperMedian(values); }

std::string MostFrequent(const std::map<std::string, int>& counts) {
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? "" : most->first;
}

/// Size of the known load that acts at the contact of this name.
std::optional<double> KnownForce_N(const std::vector<experiment::KnownLoad>& loads, double t_s,
                                   const std::string& contact) {
  for (const force_estimation::ContactSite& site : force_estimation::SitesOfLoads(loads, t_s)) {
    if (site.name != contact) continue;
    for (const experiment::KnownLoad& load : experiment::LoadsAt(loads, t_s)) {
      if (load.position_m == site.position_m) return load.force_N.norm();
    }
  }
  return std::nullopt;
}

}  // namespace

ForceSummary::ForceSummary(std::string recording,
                           std::optional<experiment::TimeWindow> steady_window_s,
                           std::vector<experiment::KnownLoad> loads)
    : recording_(std::move(recording)), window_s_(steady_window_s), loads_(std::move(loads)) {}

void ForceSummary::Add(const force_estimation::ForceEstimate& estimate) {
  const std::string word(ToString(estimate.status.code()));
  ++statuses_[word];
  if (!estimate.status.message().empty()) reasons_.emplace(word, estimate.status.message());
  if (!estimate.status.ok() || (window_s_ && !window_s_->Contains(estimate.t_s))) {
    return;
  }
  for (const force_estimation::ContactForce& contact : estimate.contacts) {
    Samples& samples = contacts_[contact.name];
    ++samples.statuses[std::string(ToString(contact.status.code()))];
    if (HasForce(contact)) {
      samples.x_N.push_back(contact.force_N.x());
      samples.y_N.push_back(contact.force_N.y());
      samples.z_N.push_back(contact.force_N.z());
      samples.magnitude_N.push_back(contact.force_N.norm());
      samples.ci95_N.push_back(contact.ci95_N);
      const auto known_N = KnownForce_N(loads_, estimate.t_s, contact.name);
      if (known_N) samples.known_N.push_back(*known_N);
    }
  }
}

std::vector<std::string> ForceSummary::Contacts() const {
  std::vector<std::string> names;
  for (const auto& [name, samples] : contacts_) {
    names.push_back(name);
  }
  return names;
}

ForceSummary::Contact ForceSummary::MedianOf(const std::string& contact) const {
  const auto found = contacts_.find(contact);
  if (found == contacts_.end()) {
    return {};
  }
  const Samples& samples = found->second;
  return {.count = static_cast<int>(samples.magnitude_N.size()),
          .force_N = {MedianOr0(samples.x_N), MedianOr0(samples.y_N), MedianOr0(samples.z_N)},
          .magnitude_N = MedianOr0(samples.magnitude_N),
          .ci95_N = MedianOr0(samples.ci95_N),
          .status = MostFrequent(samples.statuses),
          .known_N =
              samples.known_N.empty() ? std::nullopt : std::optional(MedianOr0(samples.known_N))};
}

std::string ForceSummary::ToText() const {
  std::string text = recording_ + ":";
  for (const auto& [status, count] : statuses_) {
    text += fmt::format(" {} frames {}", count, status);
    text += status == statuses_.rbegin()->first ? "\n" : ",";
  }
  if (statuses_.empty()) {
    text += " no frames\n";
  }
  for (const auto& [status, reason] : reasons_) {
    text += fmt::format("  {}: {}\n", status, reason);
  }
  for (const std::string& name : Contacts()) {
    const Contact median = MedianOf(name);
    text += median.count == 0
                ? fmt::format("  {}: {}\n", name, median.status)
                : fmt::format(
                      "  {}: {:.4f} N +- {:.4f} (95 %), ({:.4f}, {:.4f}, {:.4f}) N, {}; "
                      "median of {} frames{}{}\n",
                      name, median.magnitude_N, median.ci95_N, median.force_N.x(),
                      median.force_N.y(), median.force_N.z(), median.status, median.count,
                      window_s_ ? " in the static phase" : "",
                      median.known_N ? fmt::format("; known load {:.4f} N", *median.known_N) : "");
  }
  return text;
}

nlohmann::ordered_json ForceSummary::ToJson() const {
  nlohmann::ordered_json contacts = nlohmann::ordered_json::array();
  for (const std::string& name : Contacts()) {
    const Contact median = MedianOf(name);
    nlohmann::ordered_json contact = {
        {"contact", name}, {"status", median.status}, {"frames", median.count}};
    if (median.count > 0) {
      contact["force_N"] = {median.force_N.x(), median.force_N.y(), median.force_N.z()};
      contact["magnitude_N"] = median.magnitude_N;
      contact["ci95_N"] = median.ci95_N;
      if (median.known_N) contact["known_load_N"] = *median.known_N;
    }
    contacts.push_back(contact);
  }
  return {{"recording", recording_},
          {"frames", statuses_},
          {"reasons", reasons_},
          {"contacts", contacts}};
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/compare/comparison_output.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace palpate::command {

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string Row(const std::string& name, const std::string& value) {
  return fmt::format("  {:<22} {}\n", name, value);
}

std::string FindsText(const ComparisonSummary& summary) {
  return Row("steady forces",
             fmt::format("{} of {} detected, {} missed", summary.due() - summary.misses(),
                         summary.due(), summary.misses())) +
         Row("false contacts", fmt::format("{}, in {} of {} frames", summary.false_alarms(),
                                           summary.frames_with_false_alarm(), summary.frames()));
}

std::string ErrorsText(const ForceScore& score) {
  std::string text =
      Row("error of |F|", fmt::format("median {:.4f} N, 95 % {:.4f} N, bias {:+.4f} N",
                                      score.median_error_N, score.p95_error_N, score.bias_N)) +
      Row("  relative",
          fmt::format("median {:.1f} %, 95 % {:.1f} %, mean {:.1f} %",
                      100.0 * score.median_relative_error, 100.0 * score.p95_relative_error,
                      100.0 * score.mean_relative_error));
  if (std::isfinite(score.mean_direction_error_rad)) {
    text += Row("  along, across F", fmt::format("median {:.4f} N, {:.4f} N", score.median_along_N,
                                                 score.median_across_N)) +
            Row("direction",
                fmt::format("mean {:.1f} deg off", kDegrees * score.mean_direction_error_rad));
  }
  return text + Row("location", fmt::format("median {:.1f} mm, 95 % {:.1f} mm off",
                                            1e3 * score.median_location_error_m,
                                            1e3 * score.p95_location_error_m));
}

std::string IntervalsText(const ForceScore& score) {
  std::string text;
  if (std::isfinite(score.coverage)) {
    text += Row("95 % interval of |F|", fmt::format("{:.0f} % inside", 100.0 * score.coverage));
  }
  if (std::isfinite(score.location_coverage)) {
    text +=
        Row("  of the location", fmt::format("{:.0f} % inside", 100.0 * score.location_coverage));
  }
  const force_estimation::ErrorConsistency& consistency = score.consistency;
  if (consistency.forces() == 0) return text;
  return text +
         Row("NEES / freedom",
             fmt::format("{:.2f}, expected {:.2f} to {:.2f} ({} contacts)",
                         consistency.NeesPerDegree(), consistency.LowestExpected(),
                         consistency.HighestExpected(), consistency.contacts())) +
         Row("  95 % ellipsoid",
             fmt::format("{:.0f} % inside", 100.0 * consistency.ShareWithin95()));
}

}  // namespace

std::string ToLine(const ComparisonSummary& summary) {
  std::string line = fmt::format("{} of {} steady forces detected",
                                 summary.due() - summary.misses(), summary.due());
  const ForceScore score = summary.All();
  if (score.frames > 0) {
    line += fmt::format(
        "; error of |F| {:.1f} % (median), {:.1f} % (95 %); location error {:.1f} mm (median)",
        100.0 * score.median_relative_error, 100.0 * score.p95_relative_error,
        1e3 * score.median_location_error_m);
  }
  if (std::isfinite(score.coverage)) {
    line += fmt::format("; {:.0f} % inside the 95 % interval", 100.0 * score.coverage);
  }
  return line + fmt::format("; false alarms in {} of {} frames", summary.frames_with_false_alarm(),
                            summary.frames());
}

std::string ToTable(const ComparisonSummary& summary) {
  const ForceScore score = summary.All();
  if (score.frames == 0) return FindsText(summary);
  return FindsText(summary) + ErrorsText(score) + IntervalsText(score);
}

nlohmann::ordered_json ToJson(const ComparisonSummary& summary) {
  nlohmann::ordered_json json = {{"frames", summary.frames()},
                                 {"steady_forces", summary.due()},
                                 {"missed", summary.misses()},
                                 {"false_alarms", summary.false_alarms()},
                                 {"frames_with_false_alarm", summary.frames_with_false_alarm()}};
  const ForceScore score = summary.All();
  if (score.frames == 0) return json;
  const auto add = [&](const char* key, double value) {
    if (std::isfinite(value)) json[key] = value;
  };
  add("relative_error_mean", score.mean_relative_error);
  add("relative_error_median", score.median_relative_error);
  add("relative_error_p95", score.p95_relative_error);
  add("bias_N", score.bias_N);
  add("error_N_median", score.median_error_N);
  add("error_N_p95", score.p95_error_N);
  add("error_along_N_median", score.median_along_N);
  add("error_across_N_median", score.median_across_N);
  add("direction_error_rad_mean", score.mean_direction_error_rad);
  add("location_error_m_median", score.median_location_error_m);
  add("location_error_m_p95", score.p95_location_error_m);
  add("coverage_of_ci95", score.coverage);
  add("coverage_of_location_ci95", score.location_coverage);
  const force_estimation::ErrorConsistency& location = score.location_consistency;
  if (location.forces() > 0) {
    json["location_nees_per_degree"] = location.NeesPerDegree();
    json["location_nees_per_degree_expected"] = {location.LowestExpected(),
                                                 location.HighestExpected()};
  }
  const force_estimation::ErrorConsistency& consistency = score.consistency;
  if (consistency.forces() == 0) return json;
  json["nees_per_degree"] = consistency.NeesPerDegree();
  json["nees_per_degree_expected"] = {consistency.LowestExpected(), consistency.HighestExpected()};
  json["contacts"] = consistency.contacts();
  json["coverage_of_ellipsoid95"] = consistency.ShareWithin95();
  return json;
}

}  // namespace palpate::command

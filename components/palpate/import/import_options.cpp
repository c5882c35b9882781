// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import/import_options.hpp"

#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

using experiment::TimeWindow;

namespace {

/// Empty where `text` is not `count` numbers.
std::vector<double> NumbersOf(const std::string& text, char separator, std::size_t count) {
  std::vector<double> numbers;
  const std::vector<std::string> parts = SplitNames(text, separator);
  for (const std::string& part : parts) {
    double number = 0.0;
    if (!ParseFinite(part, &number)) return {};
    numbers.push_back(number);
  }
  return numbers.size() == count ? numbers : std::vector<double>();
}

std::vector<double> ParseNumbers(const std::string& option, const std::string& text, char separator,
                                 std::size_t count, const std::string& form) {
  std::vector<double> numbers = NumbersOf(text, separator, count);
  if (numbers.empty()) throw InputError("--" + option + " '" + text + "': expected " + form);
  return numbers;
}

std::string WithoutBlanks(std::string text) {
  std::erase(text, ' ');
  return text;
}

}  // namespace

std::vector<std::string> SplitNames(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::optional<TimeWindow> ParseWindow(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::vector<double> ends = ParseNumbers(option, text, ':', 2, "T0:T1 in seconds");
  if (ends[0] >= ends[1]) {
    throw InputError("--" + option + " '" + text + "': the window must end after it begins");
  }
  return TimeWindow{ends[0], ends[1]};
}

std::optional<Eigen::Isometry3d> ParsePose(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::vector<double> p = ParseNumbers("pose", text, ',', 7, "x,y,z,qx,qy,qz,qw");
  const Eigen::Quaterniond rotation(p[6], p[3], p[4], p[5]);
  if (std::abs(rotation.norm() - 1.0) > 1e-3) {
    throw InputError("--pose '" + text + "': the quaternion's norm must be 1, not " +
                     FormatNumber(rotation.norm()));
  }
  return Eigen::Translation3d(p[0], p[1], p[2]) * rotation.normalized();
}

std::vector<experiment::KnownLoad> ParseLoads(const std::vector<std::string>& loads, double t_s) {
  const std::string form = "\"x, y, z[, patch radius]: fx, fy, fz\" in m and N";
  std::vector<experiment::KnownLoad> parsed;
  for (const std::string& text : loads) {
    const std::vector<std::string> parts = SplitNames(WithoutBlanks(text), ':');
    const bool has_radius = SplitNames(parts[0]).size() == 4;
    const std::vector<double> place_m = NumbersOf(parts[0], ',', has_radius ? 4 : 3);
    const std::vector<double> force_N = NumbersOf(parts.back(), ',', 3);
    if (parts.size() != 2 || place_m.empty() || force_N.empty()) {
      throw InputError("--load '" + text + "': expected " + form);
    }
    experiment::KnownLoad& load = parsed.emplace_back();
    load.t_s = t_s;
    load.position_m = {place_m[0], place_m[1], place_m[2]};
    load.force_N = {force_N[0], force_N[1], force_N[2]};
    if (has_radius) load.patch_radius_m = place_m[3];
    if (load.patch_radius_m < 0.0) {
      throw InputError("--load '" + text + "': the patch radius must be 0 or more");
    }
    if (load.position_m.norm() > experiment::kLargestCoordinate_m) {
      throw InputError("--load '" + text + "': metres are expected, are these millimetres?");
    }
  }
  return parsed;
}

std::map<std::string, std::string> ParseRenames(const std::vector<std::string>& renames) {
  std::map<std::string, std::string> new_names;
  for (const std::string& rename : renames) {
    const std::vector<std::string> names = SplitNames(rename, '=');
    if (names.size() != 2 || names[0].empty() || names[1].empty()) {
      throw InputError("--rename '" + rename + "': expected NAME=NEW_NAME");
    }
    if (!new_names.emplace(names[0], names[1]).second) {
      throw InputError("--rename '" + rename + "': '" + names[0] + "' is renamed twice");
    }
  }
  return new_names;
}

}  // namespace palpate::command

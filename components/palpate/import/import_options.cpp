// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/import/import_options.hpp"

#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

using experiment::TimeWindow;

namespace {

std::vector<double> ParseNumbers(const std::string& option, const std::string& text, char separator,
                                 std::size_t count, const std::string& form) {
  std::vector<double> numbers;
  for (const std::string& part : SplitNames(text, separator)) {
    double number = 0.0;
    if (!ParseFinite(part, &number)) break;
    numbers.push_back(number);
  }
  if (numbers.size() != count || SplitNames(text, separator).size() != count) {
    throw InputError("--" + option + " '" + text + "': expected " + form);
  }
  return numbers;
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

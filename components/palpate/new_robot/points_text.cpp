// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/points_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

std::string_view WithoutBlanksAround(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Without the minus of a zero and the digits of rounding.
double Tidy_mm(double value_m) {
  const double rounded = std::round(1e6 * value_m) / 1e3;
  return rounded == 0.0 ? 0.0 : rounded;
}

}  // namespace

std::vector<std::string> SplitText(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    pieces.emplace_back(WithoutBlanksAround(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return pieces;
}

Eigen::Vector3d ParsePoint(std::string_view text, const std::string& what) {
  const std::vector<std::string> numbers = SplitText(text, ',');
  Eigen::Vector3d point;
  bool read = numbers.size() == 3;
  for (Eigen::Index axis = 0; read && axis < 3; ++axis) {
    read = ParseFinite(numbers[At(axis)], &point(axis));
  }
  if (!read) throw InputError(what + ": '" + Excerpt(text) + "' is no point x,y,z");
  return point;
}

Eigen::Matrix3Xd ParsePoints(std::string_view text, const std::string& what) {
  const std::vector<std::string> pieces = SplitText(text, ';');
  Eigen::Matrix3Xd points(3, ToIndex(pieces.size()));
  for (size_t k = 0; k < pieces.size(); ++k) points.col(ToIndex(k)) = ParsePoint(pieces[k], what);
  return points;
}

std::string PointText_mm(const Eigen::Vector3d& point_m) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g}) mm", Tidy_mm(point_m.x()), Tidy_mm(point_m.y()),
                     Tidy_mm(point_m.z()));
}

}  // namespace palpate::command

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/misfit_reason.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace palpate::calibration {

namespace {

struct MisfitReasonTuning {
  double near_unit = 0.1;       ///< relative difference from the ratio of two units
  double near_axis_rad = 0.17;  ///< turn from one between axes that still counts as that
};
constexpr MisfitReasonTuning kMisfitReasonTuning;

}  // namespace

void MisfitReasons::SortBestFirst() {
  std::stable_sort(
      reasons.begin(), reasons.end(),
      [](const MisfitReason& a, const MisfitReason& b) { return a.residual < b.residual; });
}

std::string MisfitReasons::Text() const {
  if (reasons.empty()) return where_none;
  std::string text;
  for (std::size_t k = 0; k < reasons.size(); ++k) {
    if (k > 0) text += '\n';
    text += "  " + std::to_string(k + 1) + ". " + reasons[k].text;
  }
  if (!not_excluded.empty()) text += "\n  not excluded: " + not_excluded;
  return text;
}

std::optional<std::string> UnitOfRatio(double ratio) {
  constexpr std::array<std::pair<double, const char*>, 6> kUnits{{{1e3, "millimetres"},
                                                                  {1e2, "centimetres"},
                                                                  {1e1, "decimetres"},
                                                                  {1.0 / 0.0254, "inches"},
                                                                  {1.0 / 0.3048, "feet"},
                                                                  {1e-3, "kilometres"}}};
  for (const auto& [of_metre, name] : kUnits) {
    if (std::abs(ratio / of_metre - 1.0) < kMisfitReasonTuning.near_unit) return name;
  }
  return std::nullopt;
}

std::optional<std::string> AxesText(const Eigen::Quaterniond& turn) {
  const Eigen::Matrix3d R = turn.toRotationMatrix();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
  std::string text;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Eigen::Index largest = 0;
    R.row(i).cwiseAbs().maxCoeff(&largest);
    axes(i, largest) = R(i, largest) > 0.0 ? 1.0 : -1.0;
    text += (i == 0 ? "" : ", ") + std::string(1, "xyz"[i]) + " is its " +
            (axes(i, largest) > 0.0 ? "" : "-") + "xyz"[largest];
  }
  if (axes.determinant() < 0.5 || axes.isIdentity()) return std::nullopt;
  if (Eigen::AngleAxisd(axes.transpose() * R).angle() > kMisfitReasonTuning.near_axis_rad) {
    return std::nullopt;
  }
  return "the axes of the measurement are not those assumed: the robot's " + text;
}

std::string PoseDifference::Text() const {
  return FormatReason("%.1f mm and %.1f degrees off", 1e3 * off_m,
                      180.0 / std::numbers::pi * turned_rad());
}

PoseDifference DifferenceOf(const geometry::RigidTransform& given,
                            const geometry::RigidTransform& found,
                            const Eigen::Vector3d& place_measured_m) {
  return {.off_m = (found * place_measured_m - given * place_measured_m).norm(),
          .turn = found.rotation() * given.rotation().conjugate()};
}

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "components/diagnosis/vocabulary/diagnosis_result.hpp"

namespace palpate::diagnosis {

/// Arrows that stand on the body, each twice: as it was before and as it is after.
struct BodyArrows {
  Eigen::Matrix3Xd foot_m;         ///< [3 x n] robot frame
  std::vector<std::string> names;  ///< [n] of their feet, or none
  Eigen::Matrix3Xd before, after;  ///< [3 x n] in `unit`s; NaN: not known
  std::string unit;                ///< "mm", "N"
};

/// The longest of vectors [3 x n] that are known.
double Longest(const Eigen::Matrix3Xd& vectors);

/// How many millimetres one unit is drawn as: the longest arrow is a fifth of the body, rounded
/// down to a number that is easily read.
double Enlargement(const DiagnosisResult& result, const BodyArrows& arrows);

/// An svg element: the body in the two straight views that show the most of it, the arrows on it,
/// and one arrow that tells how long they are. Something must be longer than nothing.
std::string DrawBodyArrows(const DiagnosisResult& result, const BodyArrows& arrows,
                           const std::string& id);

}  // namespace palpate::diagnosis

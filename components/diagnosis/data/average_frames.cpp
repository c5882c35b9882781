// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/average_frames.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

using experiment::MarkerFrame;

std::optional<Eigen::Vector3d> OnTheLine(const MarkerFrames& of_motion, std::size_t column,
                                         double t_s) {
  const MarkerFrame* before = nullptr;
  for (const MarkerFrame* frame : of_motion) {
    if (!frame->positions_m[column]) continue;
    if (frame->t_s < t_s) {
      before = frame;
      continue;
    }
    if (before == nullptr) return std::nullopt;
    const double share = (t_s - before->t_s) / (frame->t_s - before->t_s);
    return *before->positions_m[column] +
           share * (*frame->positions_m[column] - *before->positions_m[column]);
  }
  return std::nullopt;
}

/// Sum over all frames, of which some did not see it; nullopt: it is not known.
std::optional<Eigen::Vector3d> SumOf(const MarkerFrames& frames, const MarkerFrames& of_motion,
                                     std::size_t column) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (const MarkerFrame* frame : frames) {
    const auto& seen = frame->positions_m[column];
    const auto position_m = seen ? seen : OnTheLine(of_motion, column, frame->t_s);
    if (!position_m) return std::nullopt;
    sum_m += *position_m;
  }
  return sum_m;
}

Eigen::Vector3d SumOfSeen(const MarkerFrames& frames, std::size_t column) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (const MarkerFrame* frame : frames) {
    if (const auto& seen = frame->positions_m[column]) sum_m += *seen;
  }
  return sum_m;
}

}  // namespace

Sample AverageFrames(const MarkerFrames& frames, const MarkerFrames& of_motion,
                     const std::vector<int>& columns) {
  Sample sample;
  const auto markers = ToIndex(columns.size());
  sample.position_m =
      Eigen::Matrix3Xd::Constant(3, markers, std::numeric_limits<double>::quiet_NaN());
  sample.count = Eigen::VectorXi::Zero(markers);
  const auto all = static_cast<double>(frames.size());
  for (const MarkerFrame* frame : frames) {
    sample.frame_t_s.push_back(frame->t_s);
    sample.t_s += frame->t_s / all;
  }
  for (Eigen::Index m = 0; m < markers; ++m) {
    if (columns[At(m)] < 0) continue;
    const std::size_t column = At(columns[At(m)]);
    const auto seen = std::count_if(frames.begin(), frames.end(), [&](const MarkerFrame* frame) {
      return frame->positions_m[column].has_value();
    });
    if (seen == 0) continue;
    if (of_motion.empty() || seen == std::ssize(frames)) {
      sample.position_m.col(m) = SumOfSeen(frames, column) / static_cast<double>(seen);
    } else {
      const auto sum_m =
          2 * seen >= std::ssize(frames) ? SumOf(frames, of_motion, column) : std::nullopt;
      if (!sum_m) continue;
      sample.position_m.col(m) = *sum_m / all;
    }
    sample.count[m] = static_cast<int>(seen);
  }
  return sample;
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/data/scatter.hpp"

#include <algorithm>
#include <limits>

#include "libs/core/index.hpp"

namespace palpate::diagnosis {

void Scatter::Add(const std::vector<const experiment::MarkerFrame*>& frames) {
  constexpr std::size_t kFewest = 4;
  if (frames.size() < kFewest) return;
  for (std::size_t marker = 0; marker < frames.front()->positions_m.size(); ++marker) {
    std::vector<double> t_s;
    Eigen::Matrix3Xd seen_m(3, ToIndex(frames.size()));
    for (const experiment::MarkerFrame* frame : frames) {
      const auto& position_m = frame->positions_m[marker];
      if (!position_m) continue;
      seen_m.col(ToIndex(t_s.size())) = *position_m;
      t_s.push_back(frame->t_s);
    }
    const auto count = ToIndex(t_s.size());
    if (t_s.size() < kFewest) continue;
    Eigen::Map<const Eigen::VectorXd> times_s(t_s.data(), count);
    const Eigen::RowVectorXd along = (times_s.array() - times_s.mean()).matrix().normalized();
    Eigen::Matrix3Xd off_m = seen_m.leftCols(count);
    off_m.colwise() -= off_m.rowwise().mean().eval();
    off_m -= (off_m * along.transpose()) * along;
    squares_m2_ += off_m.array().square().rowwise().sum();
    freedom_ += static_cast<double>(count - 2);
  }
}

Eigen::Vector3d Scatter::Measured_m() const {
  constexpr double kFewest = 30.0;
  if (freedom_ < kFewest) {
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  return (squares_m2_ / freedom_).sqrt();
}

Eigen::Vector3d Scatter::Sigma_m(const std::optional<Eigen::Vector3d>& stated) const {
  constexpr double kFloor_m = 1e-6;
  constexpr double kClearlyMore = 1.2;
  const Eigen::Vector3d measured_m = Measured_m();
  Eigen::Vector3d sigma_m = stated.value_or(Eigen::Vector3d::Constant(kFloor_m));
  for (int axis = 0; axis < 3; ++axis) {
    const bool more = measured_m[axis] > kClearlyMore * sigma_m[axis];
    if (more || (!stated && measured_m[axis] > kFloor_m)) sigma_m[axis] = measured_m[axis];
  }
  return sigma_m;
}

}  // namespace palpate::diagnosis

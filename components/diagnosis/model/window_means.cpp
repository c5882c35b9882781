// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/model/window_means.hpp"

#include <algorithm>
#include <vector>

namespace palpate::diagnosis {

namespace {

double VarianceOfStamps(const Sample& sample) {
  double variance_s2 = 0.0;
  for (const double t_s : sample.frame_t_s) variance_s2 += (t_s - sample.t_s) * (t_s - sample.t_s);
  return variance_s2 / static_cast<double>(sample.frame_t_s.size());
}

/// Samples [first, end) of one piece.
class PieceOfMotion {
 public:
  PieceOfMotion(const ObservedExperiment& observed, const Simulation& simulation, std::size_t first,
                std::size_t end)
      : observed_(observed), simulation_(simulation), first_(first), end_(end) {}

  bool CanBeMoved() const {
    constexpr std::size_t kFewest = 3;
    if (end_ - first_ < kFewest || observed_.samples[first_].still) return false;
    for (std::size_t s = first_; s < end_; ++s) {
      if (!simulation_.samples[s].status.ok()) return false;
    }
    return true;
  }

  /// [3 x markers] second derivative in time, m/s^2; at the ends that of the neighbour.
  Eigen::Matrix3Xd Acceleration(std::size_t sample) const {
    const std::size_t k = std::clamp(sample, first_ + 1, end_ - 2);
    const auto t_s = [&](std::size_t s) { return observed_.samples[s].t_s; };
    const auto slope = [&](std::size_t from) -> Eigen::Matrix3Xd {
      return (simulation_.samples[from + 1].markers_m - simulation_.samples[from].markers_m) /
             (t_s(from + 1) - t_s(from));
    };
    return 2.0 / (t_s(k + 1) - t_s(k - 1)) * (slope(k) - slope(k - 1));
  }

 private:
  const ObservedExperiment& observed_;
  const Simulation& simulation_;
  std::size_t first_;
  std::size_t end_;
};

}  // namespace

void MoveToWindowMeans(const ObservedExperiment& observed, Simulation* simulation) {
  const std::vector<Sample>& samples = observed.samples;
  std::vector<Eigen::Matrix3Xd> moved_m;
  for (const SimulatedSample& sample : simulation->samples) moved_m.push_back(sample.markers_m);
  for (std::size_t first = 0, end = 0; first < samples.size(); first = end) {
    while (end < samples.size() && samples[end].recording == samples[first].recording &&
           samples[end].piece_begin_s == samples[first].piece_begin_s) {
      ++end;
    }
    const PieceOfMotion piece(observed, *simulation, first, end);
    if (!piece.CanBeMoved()) continue;
    for (std::size_t s = first; s < end; ++s) {
      moved_m[s] += 0.5 * VarianceOfStamps(samples[s]) * piece.Acceleration(s);
    }
  }
  for (std::size_t s = 0; s < samples.size(); ++s) {
    simulation->samples[s].markers_m = std::move(moved_m[s]);
  }
}

}  // namespace palpate::diagnosis

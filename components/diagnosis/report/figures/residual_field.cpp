// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/report/figures/body_arrows.hpp"
#include "components/diagnosis/report/figures/figures.hpp"
#include "libs/plot/axis_ticks.hpp"

namespace palpate::diagnosis {

namespace {

/// So many samples make a mean; of a recording that has no more, half of them, for what its
/// reference was off by has been taken off the mean of all.
constexpr std::size_t kMeanOf = 5;

/// Some samples of one recording, one after another: [first, last).
struct Stretch {
  std::size_t first = 0, last = 0;
};

/// Mean residual of each marker over the samples that saw it, m; NaN: never seen.
Eigen::Matrix3Xd MeanResidual(const DiagnosisResult& result, const Stretch& stretch,
                              Eigen::Matrix3Xd ComparedSample::*field) {
  const Eigen::Index count = result.marker_rest_m.cols();
  Eigen::Matrix3Xd sum_m = Eigen::Matrix3Xd::Zero(3, count);
  Eigen::VectorXd seen = Eigen::VectorXd::Zero(count);
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    const Eigen::Matrix3Xd& residual_m = result.compared_samples[i].*field;
    for (Eigen::Index m = 0; m < std::min(count, residual_m.cols()); ++m) {
      if (!residual_m.col(m).allFinite()) continue;
      sum_m.col(m) += residual_m.col(m);
      ++seen[m];
    }
  }
  return sum_m.array().rowwise() / seen.transpose().array();
}

/// RMS length of those that are known.
double Rms(const Eigen::Matrix3Xd& vectors) {
  double squares = 0.0, count = 0.0;
  for (const auto& vector : vectors.colwise()) {
    if (!vector.allFinite()) continue;
    squares += vector.squaredNorm();
    ++count;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// Where the simulation is most wrong. A mean over all samples would cancel what changes its sign,
/// as friction does; a single one would show noise.
Stretch FindWorst(const DiagnosisResult& result) {
  Stretch worst;
  double largest_m = 0.0;
  for (std::size_t first = 0; first < result.compared_samples.size(); ++first) {
    const int recording = result.compared_samples[first].recording;
    const auto compared_samples = static_cast<std::size_t>(std::count_if(
        result.compared_samples.begin(), result.compared_samples.end(),
        [&](const ComparedSample& compared) { return compared.recording == recording; }));
    const std::size_t mean_of = compared_samples > kMeanOf ? kMeanOf : (compared_samples + 1) / 2;
    Stretch stretch{first, first};
    while (stretch.last < std::min(first + mean_of, result.compared_samples.size()) &&
           result.compared_samples[stretch.last].recording == recording) {
      ++stretch.last;
    }
    const bool is_tail = first > 0 && stretch.last - first < mean_of &&
                         result.compared_samples[first - 1].recording == recording;
    if (is_tail) continue;  // of a longer stretch, and noisier
    const double rms_m = Rms(MeanResidual(result, stretch, &ComparedSample::before_m));
    if (rms_m <= largest_m) continue;
    largest_m = rms_m;
    worst = stretch;
  }
  return worst;
}

/// "02_ramp_north, 18.0 to 22.0 s"
std::string DescribeStretch(const DiagnosisResult& result, const Stretch& stretch) {
  const ComparedSample& first = result.compared_samples[stretch.first];
  const auto recording = static_cast<std::size_t>(first.recording);
  const std::string name =
      recording < result.recordings.size() ? result.recordings[recording].name + ", " : "";
  return name + plot::FixedText(first.t_s, 1) + " to " +
         plot::FixedText(result.compared_samples[stretch.last - 1].t_s, 1) + " s";
}

}  // namespace

Figure DrawResidualField(const DiagnosisResult& result) {
  Figure figure{.id = "residual-field",
                .title = "Where on the body: the markers' residuals at their largest",
                .caption =
                    "Arrows point from where the simulation has a marker to where it was "
                    "measured, mean over the samples with the largest residuals (",
                .svg = {},
                .absent = {}};
  const Stretch worst = FindWorst(result);
  BodyArrows arrows{.foot_m = result.marker_rest_m,
                    .names = result.markers,
                    .before = 1e3 * MeanResidual(result, worst, &ComparedSample::before_m),
                    .after = 1e3 * MeanResidual(result, worst, &ComparedSample::after_m),
                    .unit = "mm"};
  if (result.causes.empty()) {
    arrows.after.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const bool seen = Longest(arrows.before) > 0.0 || Longest(arrows.after) > 0.0;
  if (result.compared_samples.empty() || result.marker_rest_m.cols() == 0 || !seen) {
    figure.absent = "No marker was compared with the simulation.";
    return figure;
  }
  figure.caption += DescribeStretch(result, worst) + "), drawn " +
                    plot::FixedText(Enlargement(result, arrows), 0) + " times as long as to scale.";
  figure.svg = DrawBodyArrows(result, arrows, figure.id);
  return figure;
}

}  // namespace palpate::diagnosis

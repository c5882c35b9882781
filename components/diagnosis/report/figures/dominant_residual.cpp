// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/report/figures/dominant_residual.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/index.hpp"
#include "libs/plot/axis_ticks.hpp"
#include "libs/plot/text_width.hpp"

namespace palpate::diagnosis {

namespace {

constexpr Eigen::Index kFewestMoments = 4;

/// One marker's residuals before, where it was seen, and the samples' x.
struct Seen {
  Eigen::Matrix3Xd residual_m;
  Eigen::VectorXd x;
};

Seen SeenOf(Eigen::Index marker, const ComparedSamples& compared_samples,
            const std::vector<double>& x) {
  Seen seen{Eigen::Matrix3Xd(3, ToIndex(compared_samples.size())),
            Eigen::VectorXd(ToIndex(compared_samples.size()))};
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < compared_samples.size(); ++i) {
    const Eigen::Matrix3Xd& residual_m = compared_samples[i]->before_m;
    const bool is_seen = marker < residual_m.cols() && residual_m.col(marker).allFinite();
    if (!is_seen || !std::isfinite(x[i])) continue;
    seen.residual_m.col(count) = residual_m.col(marker);
    seen.x[count++] = x[i];
  }
  return {seen.residual_m.leftCols(count), seen.x.head(count)};
}

/// The marker whose direction from `find` (length: how much it counts) is the longest.
template <typename Find>
DominantResidual FindLongest(const ComparedSamples& compared_samples, const std::vector<double>& x,
                             const Find& find) {
  DominantResidual dominant;
  double longest = 0.0;
  Eigen::Index markers = 0;
  for (const ComparedSample* compared : compared_samples)
    markers = std::max(markers, compared->before_m.cols());
  for (Eigen::Index marker = 0; marker < markers; ++marker) {
    const Seen seen = SeenOf(marker, compared_samples, x);
    if (seen.x.size() < kFewestMoments) continue;
    const Eigen::Vector3d direction = find(seen);
    if (!(direction.norm() > longest)) continue;
    longest = direction.norm();
    dominant = {marker, direction / longest};
  }
  return dominant;
}

}  // namespace

DominantResidual FindDominant(const ComparedSamples& compared_samples) {
  return FindLongest(
      compared_samples, std::vector<double>(compared_samples.size(), 0.0), [](const Seen& seen) {
        const Eigen::Index half = seen.x.size() / 2;
        const Eigen::Matrix3Xd off_m = seen.residual_m.colwise() - seen.residual_m.rowwise().mean();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(off_m * off_m.transpose());
        const double deviation_m =
            std::sqrt(std::max(0.0, axes.eigenvalues()[2]) / static_cast<double>(seen.x.size()));
        const Eigen::Vector3d axis = axes.eigenvectors().col(2);
        const double rise_m =
            axis.dot(off_m.rightCols(half).rowwise().sum() - off_m.leftCols(half).rowwise().sum());
        return Eigen::Vector3d((rise_m < 0.0 ? -deviation_m : deviation_m) * axis);
      });
}

DominantResidual FindRise(const ComparedSamples& compared_samples, const std::vector<double>& x) {
  return FindLongest(compared_samples, x, [](const Seen& seen) {
    const Eigen::VectorXd off = seen.x.array() - seen.x.mean();
    return Eigen::Vector3d(seen.residual_m * off / std::max(off.squaredNorm(), 1e-30));
  });
}

double Along_mm(const DominantResidual& dominant, const Eigen::Matrix3Xd& residual_m) {
  if (dominant.marker < 0 || dominant.marker >= residual_m.cols()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return 1e3 * dominant.direction.dot(residual_m.col(dominant.marker));
}

std::string DescribeDominant(const DominantResidual& dominant, const DiagnosisResult& result) {
  const auto marker = static_cast<std::size_t>(dominant.marker);
  const std::string name =
      marker < result.markers.size() ? result.markers[marker] : std::to_string(marker + 1);
  std::string direction;
  for (const double part : dominant.direction) {
    direction += (direction.empty() ? "" : ", ") + plot::FixedText(part, 1);
  }
  const std::string what = name.starts_with("surface point ") ? "" : "marker ";
  return what + plot::Shortened(name, 11.0, 140.0) + ", along (" + direction + ")";
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/sticking.hpp"

#include <algorithm>
#include <cmath>

#include "components/diagnosis/forward/eyelet_slides.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// [times] what is known of the sample that is nearest to each.
std::vector<const EyeletSlides*> NearestSlides(const std::vector<double>& t_s,
                                               const std::vector<SimulatedSample>& samples) {
  std::vector<const EyeletSlides*> known;
  for (const SimulatedSample& sample : samples) {
    for (const EyeletSlides& slides : sample.slides) known.push_back(&slides);
  }
  std::vector<const EyeletSlides*> nearest;
  std::size_t now = 0;
  for (const double at_s : t_s) {
    const auto away_s = [&](std::size_t moment) { return std::abs(known[moment]->t_s - at_s); };
    while (now + 1 < known.size() && away_s(now + 1) <= away_s(now)) ++now;
    nearest.push_back(known[now]);
  }
  return nearest;
}

}  // namespace

/// Gauss-Seidel's method on s = clamp(before - slide / presliding), of which the slide falls as s
/// grows.
Eigen::VectorXd StickOrSlide(const Eigen::VectorXd& before, const Eigen::VectorXd& freely_m,
                             const Eigen::MatrixXd& slide_m) {
  constexpr int kMostRounds = 100;
  constexpr double kLittle = 1e-6;
  Eigen::VectorXd s = before;
  for (int round = 0; round < kMostRounds; ++round) {
    double moved = 0.0;
    for (Eigen::Index e = 0; e < s.size(); ++e) {
      const double own_m = std::max(0.0, slide_m(e, e));
      const double others_m = slide_m.row(e).dot(s - before) - slide_m(e, e) * (s[e] - before[e]);
      const double next = std::clamp(
          before[e] - (freely_m[e] + others_m) / (Sticking::kPresliding_m + own_m), -1.0, 1.0);
      moved = std::max(moved, std::abs(next - s[e]));
      s[e] = next;
    }
    if (moved < kLittle) break;
  }
  return s;
}

/// [eyelets x times]
Eigen::MatrixXd Sticking::ThroughTime(const ModelHypothesis& hypothesis,
                                      const std::vector<SimulatedSample>& samples) const {
  const std::vector<RubbingEyelet> eyelets = RubbingEyelets(hypothesis.body);
  const Eigen::VectorXd coefficient = FrictionAt(eyelets, hypothesis.body);
  const Eigen::MatrixXd path = actuators_.Path(hypothesis.actuators);
  const std::vector<const EyeletSlides*> nearest = NearestSlides(actuators_.t_s(), samples);
  Eigen::MatrixXd sliding = Eigen::MatrixXd::Zero(coefficient.size(), path.cols());
  for (Eigen::Index k = 1; k < path.cols(); ++k) {
    const EyeletSlides& slides = *nearest[At(k)];
    const Eigen::VectorXd step = (path.col(k) - path.col(k - 1)).unaryExpr([](double taken_in) {
      return std::isnan(taken_in) ? 0.0 : taken_in;
    });
    sliding.col(k) = step.isZero(0.0) ? Eigen::VectorXd(sliding.col(k - 1))
                                      : StickOrSlide(sliding.col(k - 1), slides.by_command * step,
                                                     slides.by_friction * coefficient.asDiagonal());
  }
  return sliding;
}

std::vector<bool> Sticking::Follow(const ModelHypothesis& hypothesis,
                                   const std::vector<SimulatedSample>& samples,
                                   std::vector<std::vector<SamplePart>>* parts) const {
  constexpr double kLittle = 1e-3;
  std::vector<bool> is_other(parts->size(), false);
  const std::vector<RubbingEyelet> eyelets = RubbingEyelets(hypothesis.body);
  if (eyelets.empty() || samples.empty()) return is_other;
  const Eigen::VectorXd coefficient = FrictionAt(eyelets, hypothesis.body);
  const bool known = std::any_of(samples.begin(), samples.end(),
                                 [](const SimulatedSample& one) { return !one.slides.empty(); });
  const Eigen::MatrixXd in_time = known ? ThroughTime(hypothesis, samples) : Eigen::MatrixXd();
  const Eigen::MatrixXi way = known ? Eigen::MatrixXi() : actuators_.Sliding(hypothesis.actuators);
  for (std::size_t s = 0; s < parts->size(); ++s) {
    for (SamplePart& part : (*parts)[s]) {
      Eigen::VectorXd now = Eigen::VectorXd::Zero(std::ssize(eyelets));
      for (const int k : part.times) {
        if (known) now += in_time.col(k) / static_cast<double>(part.times.size());
      }
      for (std::size_t e = 0; e < eyelets.size() && !known; ++e) {
        now[ToIndex(e)] = way(eyelets[e].cable, ToIndex(s));
      }
      now = now.cwiseMax(-1.0).cwiseMin(1.0);  // a mean may be beyond by rounding
      const Eigen::VectorXd was =
          part.sliding.size() == 0 ? Eigen::VectorXd::Zero(now.size()) : part.sliding;
      if ((now - was).cwiseProduct(coefficient).cwiseAbs().maxCoeff() > kLittle) is_other[s] = true;
      part.sliding = std::move(now);
    }
  }
  return is_other;
}

}  // namespace palpate::diagnosis

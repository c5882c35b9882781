// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/sticking.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/eyelet_slides.hpp"
#include "libs/robot/sticking.hpp"

namespace palpate::diagnosis {

namespace {

/// [times] what is known of the sample that is nearest to each.
std::vector<const robot::EyeletSlides*> NearestSlides(const std::vector<double>& t_s,
                                                      const std::vector<SimulatedSample>& samples) {
  std::vector<const robot::EyeletSlides*> known;
  for (const SimulatedSample& sample : samples) {
    for (const robot::EyeletSlides& slides : sample.slides) known.push_back(&slides);
  }
  std::vector<const robot::EyeletSlides*> nearest;
  std::size_t now = 0;
  for (const double at_s : t_s) {
    const auto away_s = [&](std::size_t moment) { return std::abs(known[moment]->t_s - at_s); };
    while (now + 1 < known.size() && away_s(now + 1) <= away_s(now)) ++now;
    nearest.push_back(known[now]);
  }
  return nearest;
}

}  // namespace

/// [eyelets x times]
Eigen::MatrixXd Sticking::ThroughTime(const ModelHypothesis& hypothesis,
                                      const std::vector<SimulatedSample>& samples) const {
  const std::vector<robot::RubbingEyelet> eyelets = robot::RubbingEyelets(hypothesis.body);
  const Eigen::VectorXd coefficient = robot::FrictionAt(eyelets, hypothesis.body);
  const Eigen::MatrixXd path = actuators_.Path(hypothesis.actuators);
  const std::vector<const robot::EyeletSlides*> nearest = NearestSlides(actuators_.t_s(), samples);
  Eigen::MatrixXd sliding = Eigen::MatrixXd::Zero(coefficient.size(), path.cols());
  for (Eigen::Index k = 1; k < path.cols(); ++k) {
    const robot::EyeletSlides& slides = *nearest[At(k)];
    const Eigen::VectorXd step = (path.col(k) - path.col(k - 1)).unaryExpr([](double taken_in) {
      return std::isnan(taken_in) ? 0.0 : taken_in;
    });
    sliding.col(k) = step.isZero(0.0)
                         ? Eigen::VectorXd(sliding.col(k - 1))
                         : robot::StickOrSlide(sliding.col(k - 1), slides.by_command * step,
                                               slides.by_friction * coefficient.asDiagonal());
  }
  return sliding;
}

std::vector<bool> Sticking::Follow(const ModelHypothesis& hypothesis,
                                   const std::vector<SimulatedSample>& samples,
                                   std::vector<std::vector<SamplePart>>* parts) const {
  constexpr double kLittle = 1e-3;
  std::vector<bool> is_other(parts->size(), false);
  const std::vector<robot::RubbingEyelet> eyelets = robot::RubbingEyelets(hypothesis.body);
  if (eyelets.empty() || samples.empty()) return is_other;
  const Eigen::VectorXd coefficient = robot::FrictionAt(eyelets, hypothesis.body);
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

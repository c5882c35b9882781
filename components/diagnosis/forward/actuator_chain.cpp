// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/actuator_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libs/core/index.hpp"
#include "libs/robot/play_operator.hpp"

namespace palpate::diagnosis {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

ActuatorSettings::ActuatorSettings(int cables)
    : mixing(Eigen::MatrixXd::Identity(cables, cables)),
      gain(Eigen::VectorXd::Zero(cables)),
      offset_m(Eigen::VectorXd::Zero(cables)),
      play_m(Eigen::VectorXd::Zero(cables)) {}

ActuatorChain::ActuatorChain(const ObservedExperiment& observed) : observed_(observed) {
  t_s_ = observed.timeline.t_s;
  for (const Sample& sample : observed.samples) {
    t_s_.insert(t_s_.end(), sample.frame_t_s.begin(), sample.frame_t_s.end());
  }
  std::sort(t_s_.begin(), t_s_.end());
  t_s_.erase(std::unique(t_s_.begin(), t_s_.end()), t_s_.end());
  for (const Sample& sample : observed.samples) {
    std::vector<int>& times = times_of_.emplace_back();
    for (const double frame_s : sample.frame_t_s) {
      const auto found = std::lower_bound(t_s_.begin(), t_s_.end(), frame_s);
      times.push_back(static_cast<int>(found - t_s_.begin()));
    }
  }
}

/// After mixing and delay. A cable that gets nothing but commands of actuators that are off is off.
Eigen::VectorXd ActuatorChain::Commanded(const ActuatorSettings& settings, double t_s) const {
  const Eigen::VectorXd command = observed_.timeline.CommandAt(t_s - settings.delay_s);
  Eigen::VectorXd commanded(command.size());
  for (Eigen::Index cable = 0; cable < commanded.size(); ++cable) {
    double sum = 0.0;
    bool driven = false;
    for (Eigen::Index drive = 0; drive < commanded.size(); ++drive) {
      const double share = settings.mixing(cable, drive);
      if (share == 0.0 || std::isnan(command[drive])) continue;
      sum += share * command[drive];
      driven = true;
    }
    commanded[cable] = driven ? sum : kUnknown;
  }
  return commanded;
}

void ActuatorChain::GoTo(double t_s, const ActuatorSettings& settings, Place* now) const {
  const Eigen::VectorXd next = Commanded(settings, t_s);
  const double h_s = t_s - now->t_s;
  for (Eigen::Index c = 0; c < next.size(); ++c) {
    // tau dy/dt + y = u, exactly for u that goes linearly.
    const double commanded = now->commanded[c];
    double& followed = now->followed[c];
    const double behind = h_s > 0.0 ? (next[c] - commanded) / h_s * settings.tau_s : 0.0;
    const bool lags = settings.tau_s > 0.0 && h_s > 0.0 && !std::isnan(followed + behind);
    followed =
        lags ? next[c] - behind + (followed - commanded + behind) * std::exp(-h_s / settings.tau_s)
             : next[c];
    const bool by_tension = observed_.timeline.by_tension[palpate::At(c)];
    const double geared =
        (1.0 + settings.gain[c]) * followed + (by_tension ? 0.0 : settings.offset_m[c]);
    double& taken_in = now->taken_in[c];
    taken_in = robot::Play(taken_in, geared, by_tension ? 0.0 : std::abs(settings.play_m[c]));
  }
  now->commanded = next;
  now->t_s = t_s;
}

Eigen::MatrixXd ActuatorChain::Path(const ActuatorSettings& settings) const {
  const std::vector<double>& turns_s = observed_.timeline.t_s;
  Eigen::MatrixXd path(std::ssize(observed_.timeline.cables), std::ssize(t_s_));
  const Eigen::VectorXd commanded = Commanded(settings, t_s_.front());
  Place now{.t_s = t_s_.front(),
            .commanded = commanded,
            .followed = commanded,
            .taken_in = Eigen::VectorXd::Constant(commanded.size(), kUnknown)};
  auto turn = turns_s.begin();
  for (Eigen::Index k = 0; k < path.cols(); ++k) {
    const double t_s = t_s_[palpate::At(k)];
    // What is delayed turns between these times.
    for (; turn != turns_s.end() && *turn + settings.delay_s < t_s; ++turn) {
      if (*turn + settings.delay_s > now.t_s) GoTo(*turn + settings.delay_s, settings, &now);
    }
    GoTo(t_s, settings, &now);
    path.col(k) = now.taken_in;
  }
  return path;
}

Eigen::MatrixXd ActuatorChain::At(const ActuatorSettings& settings) const {
  const Eigen::MatrixXd path = Path(settings);
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(path.rows(), std::ssize(times_of_));
  for (std::size_t s = 0; s < times_of_.size(); ++s) {
    const auto column = ToIndex(s);
    for (const int k : times_of_[s]) mean.col(column) += path.col(k);
    mean.col(column) /= static_cast<double>(times_of_[s].size());
  }
  return mean;
}

std::vector<std::vector<SamplePart>> ActuatorChain::PartsAt(
    const ActuatorSettings& settings) const {
  constexpr std::size_t kMostParts = 5;
  const Eigen::MatrixXd path = Path(settings);
  std::vector<std::vector<SamplePart>> parts;
  for (std::size_t s = 0; s < times_of_.size(); ++s) {
    const std::vector<int>& times = times_of_[s];
    const std::size_t count = observed_.samples[s].still ? 1 : std::min(kMostParts, times.size());
    std::vector<SamplePart>& of_sample = parts.emplace_back();
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t first = k * times.size() / count;
      const std::size_t end = (k + 1) * times.size() / count;
      SamplePart part{.taken_in = Eigen::VectorXd::Zero(path.rows()), .times = {}, .sliding = {}};
      for (std::size_t f = first; f < end; ++f) {
        part.taken_in += path.col(times[f]) / static_cast<double>(end - first);
        part.t_s += t_s_[palpate::At(times[f])] / static_cast<double>(end - first);
        part.times.push_back(times[f]);
      }
      part.share = static_cast<double>(end - first) / static_cast<double>(times.size());
      of_sample.push_back(std::move(part));
    }
  }
  return parts;
}

Eigen::MatrixXi ActuatorChain::Sliding(const ActuatorSettings& settings) const {
  constexpr double kStill = 1e-9;
  const Eigen::MatrixXd path = Path(settings);
  Eigen::MatrixXi way = Eigen::MatrixXi::Zero(path.rows(), path.cols());
  for (Eigen::Index k = 1; k < path.cols(); ++k) {
    for (Eigen::Index c = 0; c < path.rows(); ++c) {
      const double step = path(c, k) - path(c, k - 1);
      way(c, k) = step > kStill ? 1 : step < -kStill ? -1 : way(c, k - 1);
    }
  }
  Eigen::MatrixXi of_sample(path.rows(), std::ssize(times_of_));
  for (std::size_t s = 0; s < times_of_.size(); ++s) {
    of_sample.col(ToIndex(s)) = way.col(times_of_[s].back());
  }
  return of_sample;
}

}  // namespace palpate::diagnosis

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

/// tau dy/dt + y = u, exactly for u that goes linearly from `u0` to `u1` within `h_s`.
double Follow(double from, double u0, double u1, double h_s, double tau_s) {
  const double behind = h_s > 0.0 ? (u1 - u0) / h_s * tau_s : 0.0;
  if (!(tau_s > 0.0) || !(h_s > 0.0) || std::isnan(from + behind)) return u1;
  return u1 - behind + (from - u0 + behind) * std::exp(-h_s / tau_s);
}

}  // namespace

ActuatorSettings::ActuatorSettings(int actuators)
    : mixing(Eigen::MatrixXd::Identity(actuators, actuators)),
      gain(Eigen::VectorXd::Zero(actuators)),
      offset_m(gain),
      play_m(gain),
      pressure_zero_N(gain),
      valve_tau_s(gain),
      leak_ratio(gain),
      blocked_share(gain),
      blocked_from_s(
          Eigen::VectorXd::Constant(actuators, std::numeric_limits<double>::infinity())) {}

/// One that is commanded by pressure.
bool ActuatorChain::IsChamber(Eigen::Index actuator) const {
  const Timeline& timeline = observed_.timeline;
  return timeline.actuators[palpate::At(actuator)].IsChamber() &&
         timeline.by_tension[palpate::At(actuator)];
}

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

/// After mixing and delay, of chambers after the sensor. A cable that gets nothing but commands of
/// actuators that are off is off.
Eigen::VectorXd ActuatorChain::Commanded(const ActuatorSettings& settings, double t_s) const {
  const Eigen::VectorXd delayed = observed_.timeline.CommandAt(t_s - settings.delay_s);
  const Eigen::VectorXd present = observed_.timeline.CommandAt(t_s);
  Eigen::VectorXd commanded(delayed.size());
  for (Eigen::Index cable = 0; cable < commanded.size(); ++cable) {
    const bool is_chamber = IsChamber(cable);
    const Eigen::VectorXd& command = is_chamber ? present : delayed;
    double sum = 0.0;
    bool driven = false;
    for (Eigen::Index drive = 0; drive < commanded.size(); ++drive) {
      const double share = settings.mixing(cable, drive);
      if (share == 0.0 || std::isnan(command[drive])) continue;
      sum += share * command[drive];
      driven = true;
    }
    commanded[cable] = driven ? sum : kUnknown;
    if (is_chamber) {
      commanded[cable] =
          (1.0 + settings.gain[cable]) * commanded[cable] + settings.pressure_zero_N[cable];
    }
  }
  return commanded;
}

void ActuatorChain::GoToAsCable(Eigen::Index c, double h_s, double next,
                                const ActuatorSettings& settings, Place* now) const {
  double& followed = now->followed[c];
  followed = Follow(followed, now->commanded[c], next, h_s, settings.tau_s);
  const bool by_tension = observed_.timeline.by_tension[palpate::At(c)];
  const double geared =
      (1.0 + settings.gain[c]) * followed + (by_tension ? 0.0 : settings.offset_m[c]);
  double& taken_in = now->taken_in[c];
  taken_in = robot::Play(taken_in, geared, by_tension ? 0.0 : std::abs(settings.play_m[c]));
}

void ActuatorChain::GoToAsChamber(Eigen::Index c, double t_s, double next,
                                  const ActuatorSettings& settings, Place* now) const {
  const double h_s = t_s - now->t_s;
  const double share = 1.0 / (1.0 + settings.leak_ratio[c]);
  double& followed = now->followed[c];
  // A chamber that was open is at ambient pressure.
  const double was = std::isnan(followed) && h_s > 0.0 && !std::isnan(next) ? 0.0 : followed;
  const double from = std::isnan(now->commanded[c]) ? next : now->commanded[c];
  followed = Follow(was, share * from, share * next, h_s, share * settings.valve_tau_s[c]);
  double& kept = now->kept[c];
  if (t_s <= settings.blocked_from_s[c] || std::isnan(kept)) kept = followed;
  const double blocked = settings.blocked_share[c];
  now->taken_in[c] =
      blocked == 0.0 || std::isnan(kept) ? followed : followed + blocked * (kept - followed);
}

void ActuatorChain::GoTo(double t_s, const ActuatorSettings& settings, Place* now) const {
  const Eigen::VectorXd next = Commanded(settings, t_s);
  const double h_s = t_s - now->t_s;
  for (Eigen::Index c = 0; c < next.size(); ++c) {
    if (IsChamber(c)) {
      GoToAsChamber(c, t_s, next[c], settings, now);
    } else {
      GoToAsCable(c, h_s, next[c], settings, now);
    }
  }
  now->commanded = next;
  now->t_s = t_s;
}

Eigen::MatrixXd ActuatorChain::Path(const ActuatorSettings& settings) const {
  const std::vector<double>& turns_s = observed_.timeline.t_s;
  Eigen::MatrixXd path(std::ssize(observed_.timeline.actuators), std::ssize(t_s_));
  const Eigen::VectorXd commanded = Commanded(settings, t_s_.front());
  Place now{.t_s = t_s_.front(),
            .commanded = commanded,
            .followed = commanded.cwiseQuotient((1.0 + settings.leak_ratio.array()).matrix()),
            .taken_in = Eigen::VectorXd::Constant(commanded.size(), kUnknown),
            .kept = Eigen::VectorXd::Constant(commanded.size(), kUnknown)};
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

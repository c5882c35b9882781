// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/actuator_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libs/core/index.hpp"
#include "libs/robot/play_operator.hpp"

namespace palpate::virtual_robot {

namespace {

Eigen::Index Index(size_t i) { return ToIndex(i); }

/// Where one end is not driven, the later one counts.
double Between(double from, double to, double fraction) {
  return std::isnan(from) || std::isnan(to) ? to : from + fraction * (to - from);
}

}  // namespace

ActuatorChain::ActuatorChain(const std::vector<robot::BodyCable>& cables, const Effects& effects)
    : cable_of_actuator_(cables.size()) {
  const auto count = Index(cables.size());
  std::iota(cable_of_actuator_.begin(), cable_of_actuator_.end(), 0);
  coupling_ = Eigen::MatrixXd::Identity(count, count);
  gain_ = Eigen::VectorXd::Ones(count);
  offset_m_ = Eigen::VectorXd::Zero(count);
  play_m_ = Eigen::VectorXd::Zero(count);
  std::vector<std::string> cable_names;
  for (const robot::BodyCable& cable : cables) {
    play_m_[Index(cable_names.size())] = cable.play_m;
    cable_names.push_back(cable.name);
  }
  for (const auto* effect : OfKind(effects, "swapped_cables")) {
    const std::vector<int> two = PlacesOf(*effect, "cable", cable_names, 2);
    std::swap(cable_of_actuator_[At(two[0])], cable_of_actuator_[At(two[1])]);
  }
  for (const auto* effect : OfKind(effects, "drive_coupling")) {
    const std::vector<int> two = PlacesOf(*effect, "cable", cable_names, 2);
    coupling_(two[0], two[1]) += Value(*effect, "coupling");
  }
  for (const auto* effect : OfKind(effects, "lag")) {
    delay_s_ += NonNegativeValue(*effect, "delay_s");
    tau_s_ += NonNegativeValue(*effect, "tau_s");
  }
  for (const auto* effect : OfKind(effects, "cable_gain")) {
    gain_[PlaceOf(*effect, "cable", cable_names)] *= 1.0 + Value(*effect, "g");
  }
  for (const auto* effect : OfKind(effects, "cable_offset")) {
    offset_m_[PlaceOf(*effect, "cable", cable_names)] += Value(*effect, "offset_m");
  }
  for (const auto* effect : OfKind(effects, "backlash")) {
    play_m_[PlaceOf(*effect, "cable", cable_names)] += NonNegativeValue(*effect, "play_m");
  }
}

Eigen::VectorXd ActuatorChain::Coupled(const Eigen::VectorXd& command_m) const {
  Eigen::VectorXd of_cable(command_m.size());
  for (size_t actuator = 0; actuator < cable_of_actuator_.size(); ++actuator) {
    of_cable[cable_of_actuator_[actuator]] = command_m[Index(actuator)];
  }
  Eigen::VectorXd coupled = coupling_.diagonal().cwiseProduct(of_cable);
  for (Eigen::Index i = 0; i < coupled.size(); ++i) {
    for (Eigen::Index j = 0; j < coupled.size(); ++j) {
      if (i != j && coupling_(i, j) != 0.0 && !std::isnan(of_cable[j])) {
        coupled[i] += coupling_(i, j) * of_cable[j];
      }
    }
  }
  return coupled;
}

double ActuatorChain::Geared(Eigen::Index cable, double followed_m) const {
  return gain_[cable] * followed_m + offset_m_[cable];
}

void ActuatorChain::Reset(double t_s, const Eigen::VectorXd& command_m) {
  now_.commanded = {t_s, Coupled(command_m)};
  now_.delayed_m = now_.commanded.command_m;
  now_.followed_m = now_.commanded.command_m;
  now_.pulled_in_m.resize(command_m.size());
  for (Eigen::Index c = 0; c < command_m.size(); ++c) {
    now_.pulled_in_m[c] = Geared(c, now_.followed_m[c]);
  }
  proposed_ = now_;
  history_.assign(1, now_.commanded);
}

Eigen::VectorXd ActuatorChain::Delayed(const Commanded& latest) const {
  const double t_s = latest.t_s - delay_s_;
  const Commanded* later = &latest;
  for (auto commanded = history_.rbegin(); commanded != history_.rend(); ++commanded) {
    if (commanded->t_s <= t_s) {
      const double span_s = later->t_s - commanded->t_s;
      const double fraction = span_s > 0.0 ? (t_s - commanded->t_s) / span_s : 1.0;
      Eigen::VectorXd command_m(latest.command_m.size());
      for (Eigen::Index c = 0; c < command_m.size(); ++c) {
        command_m[c] = Between(commanded->command_m[c], later->command_m[c], fraction);
      }
      return command_m;
    }
    later = &*commanded;
  }
  return later->command_m;
}

/// tau dy/dt + y = u, exactly for u that goes linearly from u0 to u1.
double ActuatorChain::Follow(double from_m, double u0_m, double u1_m, double h_s) const {
  if (tau_s_ == 0.0 || std::isnan(from_m) || std::isnan(u0_m)) return u1_m;
  const double behind_m = (u1_m - u0_m) / h_s * tau_s_;
  return u1_m - behind_m + (from_m - u0_m + behind_m) * std::exp(-h_s / tau_s_);
}

void ActuatorChain::Propose(double t_s, const Eigen::VectorXd& command_m) {
  proposed_.commanded = {t_s, Coupled(command_m)};
  proposed_.delayed_m =
      delay_s_ > 0.0 ? Delayed(proposed_.commanded) : proposed_.commanded.command_m;
  const double h_s = t_s - now_.commanded.t_s;
  for (Eigen::Index c = 0; c < command_m.size(); ++c) {
    proposed_.followed_m[c] =
        Follow(now_.followed_m[c], now_.delayed_m[c], proposed_.delayed_m[c], h_s);
    const double geared_m = Geared(c, proposed_.followed_m[c]);
    proposed_.pulled_in_m[c] = robot::Play(now_.pulled_in_m[c], geared_m, play_m_[c]);
  }
}

void ActuatorChain::Commit() {
  now_ = proposed_;
  if (delay_s_ == 0.0) return;
  history_.push_back(now_.commanded);
  while (history_.size() > 2 && history_[1].t_s <= now_.commanded.t_s - delay_s_)
    history_.pop_front();
}

}  // namespace palpate::virtual_robot

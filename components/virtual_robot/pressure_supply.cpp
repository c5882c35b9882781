// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/pressure_supply.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "libs/core/error.hpp"

namespace palpate::virtual_robot {

namespace {

std::vector<std::string> NamesOf(const std::vector<robot::BodyChamber>& chambers) {
  std::vector<std::string> names;
  for (const robot::BodyChamber& chamber : chambers) names.push_back(chamber.name);
  return names;
}

/// Of the chamber that the scenario's supply names.
Eigen::Index IndexOfChamber(const scenario::ChamberSupply& supply,
                            const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), supply.chamber);
  if (found == names.end())
    throw InputError("supply: the robot has no chamber '" + supply.chamber + "'");
  return found - names.begin();
}

}  // namespace

PressureSupply::PressureSupply(const std::vector<robot::BodyChamber>& chambers,
                               const scenario::Scenario& scenario, const Effects& effects)
    : chamber_of_supply_(chambers.size()),
      gain_(Eigen::VectorXd::Ones(std::ssize(chambers))),
      zero_Pa_(Eigen::VectorXd::Zero(std::ssize(chambers))),
      tau_s_(zero_Pa_),
      leak_ratio_(zero_Pa_),
      blocked_from_s_(
          Eigen::VectorXd::Constant(std::ssize(chambers), std::numeric_limits<double>::infinity())),
      sensor_noise_Pa_(zero_Pa_) {
  std::iota(chamber_of_supply_.begin(), chamber_of_supply_.end(), 0);
  const std::vector<std::string> names = NamesOf(chambers);
  for (const scenario::ChamberSupply& supply : scenario.supply) {
    const Eigen::Index c = IndexOfChamber(supply, names);
    gain_[c] = 1.0 + supply.sensor_gain;
    zero_Pa_[c] = supply.sensor_zero_Pa;
    tau_s_[c] = supply.valve_time_constant_s;
    leak_ratio_[c] = supply.leak_ratio;
    sensor_noise_Pa_[c] = supply.sensor_noise_Pa;
  }
  ApplyEffects(names, scenario.RecordingBegins_s(), effects);
}

void PressureSupply::ApplyEffects(const std::vector<std::string>& names,
                                  const std::vector<double>& begins_s, const Effects& effects) {
  for (const auto* effect : OfKind(effects, "swapped_tubes")) {
    const std::vector<int> two = PlacesOf(*effect, "chamber", names, 2);
    std::swap(chamber_of_supply_[At(two[0])], chamber_of_supply_[At(two[1])]);
  }
  for (const auto* effect : OfKind(effects, "pressure_gain"))
    gain_[PlaceOf(*effect, "chamber", names)] *= 1.0 + Value(*effect, "g");
  for (const auto* effect : OfKind(effects, "pressure_zero"))
    zero_Pa_[PlaceOf(*effect, "chamber", names)] += Value(*effect, "zero_Pa");
  for (const auto* effect : OfKind(effects, "slow_valve"))
    tau_s_[PlaceOf(*effect, "chamber", names)] += NonNegativeValue(*effect, "tau_s");
  for (const auto* effect : OfKind(effects, "leak"))
    leak_ratio_[PlaceOf(*effect, "chamber", names)] += NonNegativeValue(*effect, "ratio");
  for (const auto* effect : OfKind(effects, "blocked_valve")) {
    const auto recording = static_cast<std::size_t>(NonNegativeValue(*effect, "from_recording"));
    if (recording >= begins_s.size()) {
      throw InputError("effect blocked_valve: from_recording: the last recording is " +
                       std::to_string(std::ssize(begins_s) - 1));
    }
    double& from_s = blocked_from_s_[PlaceOf(*effect, "chamber", names)];
    from_s = std::min(from_s, begins_s[recording]);
  }
}

Eigen::VectorXd PressureSupply::Supplied(const Eigen::VectorXd& command_Pa) const {
  Eigen::VectorXd supplied_Pa(command_Pa.size());
  for (std::size_t supply = 0; supply < chamber_of_supply_.size(); ++supply) {
    const Eigen::Index c = chamber_of_supply_[supply];
    supplied_Pa[c] = gain_[c] * command_Pa[ToIndex(supply)] + zero_Pa_[c];
  }
  return supplied_Pa;
}

void PressureSupply::Reset(double t_s, const Eigen::VectorXd& command_Pa) {
  now_.t_s = t_s;
  now_.supplied_Pa = Supplied(command_Pa);
  now_.pressure_Pa = now_.supplied_Pa.cwiseQuotient((1.0 + leak_ratio_.array()).matrix());
  proposed_ = now_;
}

/// tau dp/dt + (1 + ratio) p = u, exactly for u that goes linearly from u0 to u1. A chamber that
/// was open is at ambient pressure.
double PressureSupply::Follow(Eigen::Index chamber, double from_Pa, double u0_Pa, double u1_Pa,
                              double h_s) const {
  const double share = 1.0 / (1.0 + leak_ratio_[chamber]);
  const double tau_s = share * tau_s_[chamber];
  if (tau_s == 0.0 || std::isnan(u1_Pa)) return share * u1_Pa;
  const double start_Pa = share * (std::isnan(u0_Pa) ? u1_Pa : u0_Pa);
  const double end_Pa = share * u1_Pa;
  const double behind_Pa = (end_Pa - start_Pa) / h_s * tau_s;
  const double was_Pa = std::isnan(from_Pa) ? 0.0 : from_Pa;
  return end_Pa - behind_Pa + (was_Pa - start_Pa + behind_Pa) * std::exp(-h_s / tau_s);
}

void PressureSupply::Propose(double t_s, const Eigen::VectorXd& command_Pa) {
  proposed_.t_s = t_s;
  proposed_.supplied_Pa = Supplied(command_Pa);
  const double h_s = t_s - now_.t_s;
  for (Eigen::Index c = 0; c < command_Pa.size(); ++c) {
    const double open_s = std::clamp(blocked_from_s_[c] - now_.t_s, 0.0, h_s);
    double& pressure_Pa = proposed_.pressure_Pa[c];
    pressure_Pa = now_.pressure_Pa[c];
    if (!(open_s > 0.0)) continue;
    const double start_Pa = now_.supplied_Pa[c];
    const double end_Pa = open_s < h_s && !std::isnan(start_Pa)
                              ? start_Pa + open_s / h_s * (proposed_.supplied_Pa[c] - start_Pa)
                              : proposed_.supplied_Pa[c];
    pressure_Pa = Follow(c, pressure_Pa, start_Pa, end_Pa, open_s);
  }
}

}  // namespace palpate::virtual_robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/truth.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "libs/core/index.hpp"
#include "libs/fem/embedding.hpp"

namespace palpate::virtual_robot {

namespace {

constexpr double kNotDriven = std::numeric_limits<double>::quiet_NaN();

/// In [0, 1), the same on every machine.
double Uniform(std::mt19937_64* engine) {
  return static_cast<double>((*engine)() >> 11U) * 0x1.0p-53;
}

Eigen::Vector3d Direction(std::mt19937_64* engine) {
  const double z = 2.0 * Uniform(engine) - 1.0;
  const double angle_rad = 2.0 * std::numbers::pi * Uniform(engine);
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle_rad), across * std::sin(angle_rad), z};
}

}  // namespace

Truth::Truth(const Bench& bench, const Effects& effects, std::uint64_t seed)
    : bench_(bench),
      rest_surface_(fem::RestSurface(bench.body().mesh, bench.body().boundary)),
      readings_(static_cast<size_t>(bench.cable_system().CableCount() +
                                    bench.chamber_system().ChamberCount())) {
  for (const robot::BodyChamber& chamber : bench.body().chambers)
    sensor_noise_.emplace_back(seed, "pressure sensor " + chamber.name);
  for (const robot::BodyMarker& marker : bench.body().markers) {
    markers_.push_back(marker.point.weights);
  }
  const auto misplaced = OfKind(effects, "marker_misplacement");
  if (misplaced.empty()) return;
  const fem::PointLocator locator(bench.body().nominal);
  std::mt19937_64 engine(seed);
  for (const auto* effect : misplaced) {
    const int marker = PlaceOf(*effect, "marker", bench.body().MarkerNames());
    const Eigen::Vector3d by_m = Value(*effect, "d_m") * Direction(&engine);
    const auto index = static_cast<size_t>(marker);
    markers_[index] = locator.Embed(bench.body().markers[index].point.rest_m + by_m).weights;
  }
}

void Truth::Update() {
  const ChamberSystem& chambers = bench_.chamber_system();
  const auto cables = At(bench_.cable_system().CableCount());
  for (int c = 0; c < chambers.ChamberCount(); ++c) {
    const double command_Pa = bench_.command_m()[ToIndex(cables) + c];
    const double noise_Pa = bench_.supply().sensor_noise_Pa()[c] * sensor_noise_[At(c)].Normal();
    const int fed = bench_.supply().ChamberOfSupply(c);
    readings_[cables + At(c)] =
        std::isnan(command_Pa)
            ? CableReading{kNotDriven, 0.0}
            : CableReading{chambers.Change_m3(fed, bench_.state().x_m), command_Pa + noise_Pa};
  }
  for (size_t actuator = 0; actuator < cables; ++actuator) {
    const int cable = bench_.actuators().CableOfActuator(static_cast<int>(actuator));
    readings_[actuator] = {bench_.command_m()[ToIndex(actuator)],
                           bench_.cable_system().DriveTension_N(cable)};
  }
}

std::vector<TrueForce> Truth::Forces() const {
  std::vector<TrueForce> forces;
  const Eigen::VectorXd rest_m = bench_.body().rest_m();
  const Eigen::VectorXd& x_m = bench_.state().x_m;
  for (const Contact& contact : bench_.contacts()) {
    const ContactResult result = contact.Result(bench_.surface(), x_m, rest_m);
    if (!(result.normal_N > 0.0)) continue;
    forces.push_back({contact.name(), result.centre_m,
                      rest_surface_.Closest(result.rest_m).position_m, result.force_N});
  }
  for (const PointLoad& load : bench_.point_loads()) {
    forces.push_back({load.name, load.weights.Position(x_m), load.rest_m, load.force_N});
  }
  return forces;
}

Eigen::Matrix3Xd Truth::MarkerPositions_m() const {
  Eigen::Matrix3Xd positions_m(3, ToIndex(markers_.size()));
  for (size_t k = 0; k < markers_.size(); ++k) {
    positions_m.col(ToIndex(k)) = markers_[k].Position(bench_.state().x_m);
  }
  return positions_m;
}

}  // namespace palpate::virtual_robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/diagnosis/faults/makers.hpp"
#include "components/diagnosis/faults/quantile.hpp"

namespace palpate::diagnosis {

namespace {

/// z[0] by how much actuators are late in all, delay and time constant together; z[1] how much more
/// than half of the square of it is the time constant's. Commands that turn slowly are answered
/// late by the sum, and the squares tell by how much their turns are rounded off: these, other than
/// delay and time constant, are nearly linear in what is seen, and the second is often all but
/// unknown.
class Lag final : public FaultModel {
 public:
  Lag()
      : FaultModel({"lag", {"body"}}, "lag of the actuators",
                   {{.name = "late_s", .tolerance = 0.01, .fault = 0.2, .least = 0.0},
                    {.name = "rounded",
                     .nominal = 0.5,
                     .fault = 0.4,
                     .least = -0.5,
                     .most = 0.5,
                     .qualifies = true}}) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const double late_s = std::max(0.0, z[0]);
    hypothesis->actuators.tau_s += late_s * Share(z[1]);
    hypothesis->actuators.delay_s += late_s * (1.0 - Share(z[1]));
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    const auto delay = [](double late_share) { return 1.0 - late_share; };
    const auto tau = [](double late_share) { return late_share; };
    return {Part("delay_s", z, covariance, delay), Part("tau_s", z, covariance, tau)};
  }

 private:
  /// Of all lateness, the time constant.
  double Share(double z_rounded) const {
    return std::sqrt(std::clamp(parameters()[1].ValueOf(z_rounded), 0.0, 1.0));
  }

  template <typename PartOf>
  FittedParameter Part(const std::string& name, const Eigen::VectorXd& z,
                       const Eigen::MatrixXd& covariance, const PartOf& part_of) const {
    constexpr double kFarthest = 10.0;  // sigma
    const FaultParameter& rounded = parameters()[1];
    const TwoParameters both{z, covariance, rounded.least, rounded.most};
    const double most_s = z[0] + kFarthest * std::sqrt(covariance(0, 0));
    const auto late_at = [&](double value_s, double z_rounded) {
      const double part = part_of(Share(z_rounded));
      return part > 0.0 ? value_s / part : std::numeric_limits<double>::infinity();
    };
    return {name, z[0] * part_of(Share(z[1])), Quantile(0.025, both, most_s, late_at),
            Quantile(0.975, both, most_s, late_at)};
  }
};

}  // namespace

void MakeLag(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (inputs.body.cables.empty()) return;
  faults->push_back(std::make_unique<Lag>());
}

}  // namespace palpate::diagnosis

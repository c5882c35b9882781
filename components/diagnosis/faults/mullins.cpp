// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <numbers>

#include "components/diagnosis/faults/makers.hpp"
#include "components/diagnosis/faults/quantile.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/mullins.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// MullinsSoftening: z[0] how much an element softens that is so far below its largest energy
/// density as m is searched at, z[1] ln of how many times that m is. Data that tell little of where
/// softening ends tell z[0] all the same; of 1 / r they would only tell what it is if m were known,
/// and about every m another share of that. What it does at a sample is a force: that of the
/// softened elements, as far as they are. What the energies then answer is left out. 1 / r adds to
/// that of a robot file that softens, whose m is then searched at.
class Mullins final : public FaultModel {
 public:
  /// No material softens to nothing.
  static constexpr double kLeastR = 1.001;

  Mullins(double m_J_m3, double inverse_r)
      : FaultModel({"mullins", {"body"}}, "strain softening of the body (Mullins effect)",
                   {{.name = "softening", .fault = 0.4, .least = 0.0, .most = 1.0},
                    {.name = "m",
                     .nominal = m_J_m3,
                     .fault = 0.6,
                     .scale = FaultParameter::Scale::kFactor,
                     .qualifies = true}}),
        inverse_r_(inverse_r) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    if (z[0] > 0.0) {
      hypothesis->mullins =
          MullinsSoftening{std::min(1.0 / kLeastR, InverseR(z)), parameters()[1].ValueOf(z[1])};
    }
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    if (z[0] > 0.0) {
      robot->softening = fem::MullinsLaw{.r = std::max(kLeastR, 1.0 / InverseR(z)),
                                         .m_J_m3 = parameters()[1].ValueOf(z[1])};
    }
    return true;
  }

  /// What energies answer to the softening is up to twice 1 / r of it.
  bool NeedsSimulation(const Eigen::VectorXd& z) const override { return z[0] > 0.02; }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    if (parameter == 1 && z[0] == 0.0) return nullptr;
    const double m_J_m3 = parameters()[1].ValueOf(z[1]);
    const Eigen::Array<double, Eigen::Dynamic, HistoryOperator::kTimesPerSample> below =
        at.simulation.below_largest_J_m3
            .middleCols<HistoryOperator::kTimesPerSample>(HistoryOperator::kTimesPerSample *
                                                          at.sample)
            .cast<double>()
            .array() /
        m_J_m3;
    const double reach = Reach(z[1]);
    Eigen::VectorXd softer =
        below.unaryExpr([](double u) { return std::erf(u); }).rowwise().mean() / reach;
    if (parameter == 1) {
      softer *= -z[0] * ReachChange(z[1]) / reach;
      softer -= 2.0 * std::numbers::inv_sqrtpi * InverseR(z) *
                (below * (-below.square()).exp()).rowwise().mean().matrix();
    }
    return robot::NodalForce(ForceOf(softer, at));
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& undeformed_m) const override {
    std::vector<FittedParameter> report = FaultModel::Report(z, covariance, undeformed_m);
    constexpr double kLeast = 1e-6;  // of 1 / r
    const TwoParameters both{z, covariance, parameters()[1].least, parameters()[1].most};
    const auto inverse_below = [&](double probability) {
      const double added =
          Quantile(probability, both, 1.0 - inverse_r_,
                   [](double inverse, double z_m) { return inverse * Reach(z_m); });
      return std::max(kLeast, inverse_r_ + added);
    };
    report[0] = {.name = "r",
                 .value = std::max(1.0, 1.0 / InverseR(z)),
                 .ci95_low = 1.0 / inverse_below(0.975),
                 .ci95_high = 1.0 / inverse_below(0.025)};
    return report;
  }

 private:
  double InverseR(const Eigen::VectorXd& z) const { return inverse_r_ + z[0] / Reach(z[1]); }

  /// z[0] over what it adds to 1 / r, and its derivative.
  static double Reach(double z_m) { return std::erf(std::exp(-z_m)); }
  static double ReachChange(double z_m) {
    const double u = std::exp(-z_m);
    return -2.0 * std::numbers::inv_sqrtpi * u * std::exp(-u * u);
  }

  /// F_int of the elements, each so weighted; weights above -1.
  static Eigen::VectorXd ForceOf(const Eigen::VectorXd& weight, const FaultContext& at) {
    fem::ElasticBody& body = at.model.elastic_body();
    const Eigen::VectorXd& x_m = at.shape.state.x_m;
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(weight.size());
    Eigen::VectorXd more_N = Eigen::VectorXd::Zero(x_m.size());
    body.SetCellFactors(ones + weight);
    body.AddForces(x_m, more_N);
    Eigen::VectorXd once_N = Eigen::VectorXd::Zero(x_m.size());
    body.SetCellFactors(ones);
    body.AddForces(x_m, once_N);
    const Eigen::VectorXd& factor = at.simulation.history_variables[At(at.sample)].cell_factor;
    if (factor.size() > 0) body.SetCellFactors(factor);
    return more_N - once_N;
  }

  double inverse_r_;  ///< of the robot file
};

}  // namespace

void MakeMullins(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (const auto& law = inputs.body.softening) {
    faults->push_back(std::make_unique<Mullins>(law->m_J_m3, 1.0 / law->r));
    return;
  }
  for (const double m_J_m3 : {30.0, 100.0, 300.0, 1000.0, 3000.0}) {
    faults->push_back(std::make_unique<Mullins>(m_J_m3, 0.0));
  }
}

}  // namespace palpate::diagnosis

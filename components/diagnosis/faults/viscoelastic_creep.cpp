// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/faults/makers.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// One Prony term with a relaxation time near one that it is searched at. What it does at a sample
/// is the force of a stress: the elastic ones of the past, as far as they have not faded
/// (HistoryOperator::Fading), which have stayed with the material.
class ViscoelasticCreep final : public FaultModel {
 public:
  ViscoelasticCreep(double tau_s, double tolerance)
      : FaultModel({"viscoelastic_creep", {"body"}}, "creep of the body",
                   {{.name = "g", .tolerance = tolerance, .fault = 0.25, .least = 0.0},
                    {.name = "tau_s",
                     .nominal = tau_s,
                     .fault = 0.6,
                     .scale = FaultParameter::Scale::kFactor,
                     .qualifies = true}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    if (z[0] == 0.0) return;
    hypothesis->creep.push_back({.g = z[0], .tau_s = parameters()[1].ValueOf(z[1])});
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    if (z[0] > 0.0) robot->creep.push_back({.g = z[0], .tau_s = parameters()[1].ValueOf(z[1])});
    return true;
  }

  /// What stresses of the past answer to g is of the order of g.
  bool NeedsSimulation(const Eigen::VectorXd& z) const override { return z[0] > 0.05; }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const FaultContext& at) const override {
    const double tau_s = parameters()[1].ValueOf(z[1]);
    if (parameter == 0) return Force(at, -at.history.Fading(tau_s).row(at.sample));
    if (z[0] == 0.0) return nullptr;
    constexpr double kStep = 1e-3;
    return Force(at, -z[0] / kStep *
                         (at.history.Fading(tau_s * std::exp(kStep)).row(at.sample) -
                          at.history.Fading(tau_s).row(at.sample)));
  }

 private:
  /// Of the elastic stresses of all samples, so weighted.
  static robot::ParameterPtr Force(const FaultContext& at, const Eigen::RowVectorXd& weights) {
    PointStresses stress_Pa = PointStresses::Zero(6, at.points.PointCount());
    AddHistoryStress(at.simulation, weights.transpose(), &stress_Pa);
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(at.shape.state.x_m.size());
    at.points.AddForces(stress_Pa.cast<double>(), at.shape.state.x_m, &force_N);
    return robot::NodalForce(std::move(force_N));
  }
};

}  // namespace

void MakeViscoelasticCreep(const CatalogueInputs& /*inputs*/, std::vector<FaultModelPtr>* faults) {
  constexpr double kNominal = 0.02;
  constexpr double kNominalTau_s = 10.0;
  for (const double tau_s : {1.0, 3.0, kNominalTau_s, 30.0, 100.0}) {
    faults->push_back(
        std::make_unique<ViscoelasticCreep>(tau_s, tau_s == kNominalTau_s ? kNominal : 0.0));
  }
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <numbers>

#include "components/diagnosis/causes/makers.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// MullinsSoftening, z[0] = 1 / r, z[1] about one of the energy densities that it is looked for at.
/// What it does at a moment is a force: that of the softened cells, as far as they are. What the
/// energies then answer is left out.
class Mullins final : public Cause {
 public:
  explicit Mullins(double m_J_m3)
      : Cause({"mullins", {"body"}}, "softening of the body where it was strained before",
              {{.name = "r",
                .fault = 0.4,
                .least = 0.0,
                .most = 1.0,
                .scale = CauseParameter::Scale::kInverse},
               {.name = "m",
                .nominal = m_J_m3,
                .fault = 0.6,
                .scale = CauseParameter::Scale::kFactor,
                .qualifies = true}}) {}

  void Apply(const Eigen::VectorXd& z, ModelDraft* draft) const override {
    if (z[0] > 0.0) draft->mullins = MullinsSoftening{z[0], parameters()[1].ValueOf(z[1])};
  }

  /// What energies answer to the softening is up to twice 1 / r of it.
  bool NeedsRuns(const Eigen::VectorXd& z) const override { return z[0] > 0.02; }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& z,
                             const CauseMoment& at) const override {
    if (parameter == 1 && z[0] == 0.0) return nullptr;
    const double m_J_m3 = parameters()[1].ValueOf(z[1]);
    const Eigen::Array<double, Eigen::Dynamic, Memory::kLooks> below =
        at.simulation.below_largest_J_m3.middleCols<Memory::kLooks>(Memory::kLooks * at.sample)
            .cast<double>()
            .array() /
        m_J_m3;
    Eigen::VectorXd softer;
    if (parameter == 0) {
      softer = below.unaryExpr([](double u) { return std::erf(u); }).rowwise().mean();
    } else {
      softer = -2.0 * std::numbers::inv_sqrtpi * z[0] *
               (below * (-below.square()).exp()).rowwise().mean();
    }
    return robot::NodalForce(ForceOf(softer, at));
  }

 private:
  /// F_int of the cells, each so weighted; weights above -1.
  static Eigen::VectorXd ForceOf(const Eigen::VectorXd& weight, const CauseMoment& at) {
    fem::ElasticBody& body = at.model.elastic_body();
    const Eigen::VectorXd& x_m = at.shape.state.x_m;
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(weight.size());
    Eigen::VectorXd more_N = Eigen::VectorXd::Zero(x_m.size());
    body.SetCellFactors(ones + weight);
    body.AddForces(x_m, more_N);
    Eigen::VectorXd once_N = Eigen::VectorXd::Zero(x_m.size());
    body.SetCellFactors(ones);
    body.AddForces(x_m, once_N);
    const Eigen::VectorXd& factor =
        at.simulation.past[static_cast<std::size_t>(at.sample)].cell_factor;
    if (factor.size() > 0) body.SetCellFactors(factor);
    return more_N - once_N;
  }
};

}  // namespace

void MakeMullins(const CauseWorld& /*world*/, std::vector<CausePtr>* causes) {
  for (const double m_J_m3 : {30.0, 100.0, 300.0, 1000.0, 3000.0}) {
    causes->push_back(std::make_unique<Mullins>(m_J_m3));
  }
}

}  // namespace palpate::diagnosis

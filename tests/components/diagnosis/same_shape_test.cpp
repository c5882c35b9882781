// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <vector>

#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/forward/tangent_state.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

/// Samples whose body has the same shape, as while a command is held.
class SameShape : public HiddenFaults {
 protected:
  void Differentiate(Simulation* simulation) const {
    const ModelHypothesis nominal = NominalHypothesis(body_, observed_);
    const Eigen::VectorXd z = Eigen::VectorXd::Zero(hypotheses_.parameter_count());
    const std::vector<bool> all(static_cast<std::size_t>(hypotheses_.size()), true);
    simulator_.Differentiate(nominal, hypotheses_.All(), z, all, nominal, simulation);
  }

  Simulator simulator_{observed_, 1};
  Simulation simulated_ = simulator_.Run(NominalHypothesis(body_, observed_));
};

/// The last sample has the shape of another, with which its rows are solved; then it alone has it.
TEST_F(SameShape, HasTheSameDerivativesWithRowsThatAreKept) {
  ASSERT_TRUE(simulated_.status.ok());
  Simulation together = simulated_;
  Simulation alone = simulated_;
  const std::size_t last = simulated_.samples.size() - 1;
  HeldShape shape = simulated_.samples[last / 2].middle;
  shape.state.x_m *= 1.0 + 1e-12;  // nobody else's
  together.samples[last / 2].middle = together.samples[last].middle = shape;
  alone.samples[last].middle = shape;
  Differentiate(&together);
  Differentiate(&alone);
  EXPECT_GT(together.samples[last].jacobian_m.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(together.samples[last].jacobian_m, alone.samples[last].jacobian_m);
}

TEST_F(SameShape, IsOneOnlyWhereAllIsTheSameThatTheTangentDependsOn) {
  TangentState one;
  one.state = simulated_.samples.front().middle.state;
  one.friction = Eigen::VectorXd::Ones(2);
  EXPECT_TRUE(one.IsSame(one));
  std::vector<TangentState> others(8, one);
  others[0].modulus_change = 1e-9;
  others[1].history_variables.scale = 1e-9;
  others[2].history_variables.stress_Pa = PointStresses::Zero(6, 1);
  others[3].history_variables.cell_factor = Eigen::VectorXd::Ones(3);
  others[4].friction[1] = -1.0;
  others[5].state.x_m[0] += 1e-15;
  others[6].state.multipliers_N[0] += 1e-15;
  others[7].state.loads.external_force_N[0] += 1e-15;
  for (std::size_t k = 0; k < others.size(); ++k) EXPECT_FALSE(one.IsSame(others[k])) << k;
}

}  // namespace
}  // namespace palpate::diagnosis

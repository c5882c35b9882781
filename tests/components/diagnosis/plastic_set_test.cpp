// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "libs/fem/elastic_body.hpp"
#include "libs/fem/linearisation.hpp"
#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

using PlasticSet = HiddenFaults;

/// [3n] how a body at rest yields where each node is pushed by so much.
Eigen::VectorXd GivesWay(const robot::RobotBody& body, const Eigen::VectorXd& push) {
  fem::ElasticBody elastic(body.mesh, body.materials, body.material_of_cell);
  fem::Linearisation linearisation(elastic, {}, body.fixed);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(push.size());
  EXPECT_TRUE(linearisation.Update(elastic.rest_m(), {}, none).ok());
  Eigen::MatrixXd load(linearisation.Size(), 1);
  linearisation.matrix().Reduce(push, load.col(0));
  linearisation.Solve(load);
  Eigen::VectorXd moved = none;
  linearisation.matrix().AddExpanded(load.col(0), 1.0, moved);
  return moved;
}

TEST_F(PlasticSet, IsBelievedToBendABodyByItsCompliance) {
  const FaultModel& set = hypotheses_.model(Number("plastic_set", "body"));
  const Eigen::Index shapes = std::ssize(set.parameters());
  Eigen::VectorXd compliance(shapes);
  for (Eigen::Index k = 0; k < shapes; ++k) {
    ModelHypothesis hypothesis = NominalHypothesis(body_, observed_);
    set.Apply(Eigen::VectorXd::Unit(shapes, k), &hypothesis);
    const Eigen::VectorXd shape = (hypothesis.body.mesh.nodes_m - body_.mesh.nodes_m).reshaped();
    const Eigen::VectorXd moved = GivesWay(body_, shape);
    compliance[k] = moved.dot(shape) / shape.squaredNorm();
    EXPECT_LT((moved - compliance[k] * shape).norm(), 0.02 * moved.norm()) << "shape " << k;
  }
  const FaultParameter& softest = set.parameters()[0];
  for (Eigen::Index k = 0; k < shapes; ++k) {
    const FaultParameter& part = set.parameters()[static_cast<std::size_t>(k)];
    EXPECT_GT(part.fault, part.tolerance) << "shape " << k;
    const double beyond_m = std::sqrt(std::pow(part.fault, 2) - std::pow(part.tolerance, 2));
    EXPECT_NEAR(beyond_m / softest.fault, compliance[k] / compliance[0], 0.01) << "shape " << k;
  }
  EXPECT_LT(set.parameters().back().fault, 0.2 * softest.fault);
}

}  // namespace
}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/diagnosis/hidden_faults.hpp"

namespace palpate::diagnosis {
namespace {

using CableElasticity = HiddenFaults;

TEST_F(CableElasticity, IsKnownNoBetterThanWhatTheMeshGivesWayBy) {
  const FaultModel& stretch = hypotheses_.model(Number("cable_elasticity", "cable:up"));
  const double mesh_m_N = stretch.parameters()[0].tolerance;
  const Eigen::VectorXd z = Eigen::VectorXd::Constant(1, 1.0 / 3000.0);
  const auto report = stretch.Report(z, Eigen::MatrixXd::Zero(1, 1), {});
  ASSERT_EQ(report.size(), 1U);
  EXPECT_NEAR(report[0].value, 3000.0, 1e-6);
  EXPECT_NEAR(1.0 / report[0].ci95_low - z[0], 1.96 * mesh_m_N, 1e-3 * mesh_m_N);
  EXPECT_NEAR(z[0] - 1.0 / report[0].ci95_high, 1.96 * mesh_m_N, 1e-3 * mesh_m_N);
  const auto blurred =
      stretch.Report(z, Eigen::MatrixXd::Constant(1, 1, 3.0 * mesh_m_N * mesh_m_N), {});
  EXPECT_NEAR(1.0 / blurred[0].ci95_low - z[0], 2.0 * 1.96 * mesh_m_N, 1e-3 * mesh_m_N);
}

}  // namespace
}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <algorithm>

#include "components/force_estimation/shape/candidate_locations.hpp"
#include "components/force_estimation/shape/observation_jacobian.hpp"
#include "libs/geometry/surface_sampling.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

/// Rows that see all of the markers.
std::vector<robot::ObservationRow> MarkerRows(const robot::RobotModel& model) {
  std::vector<robot::ObservationRow> rows;
  for (const robot::BodyMarker& marker : model.body().markers) {
    for (int axis = 0; axis < 3; ++axis) {
      rows.push_back(robot::RowOfPoint(marker.point.weights, Eigen::Vector3d::Unit(axis)));
    }
  }
  return rows;
}

Eigen::VectorXd ValuesOf(const std::vector<robot::ObservationRow>& rows,
                         const Eigen::VectorXd& x_m) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = rows[i].Value(x_m);
  }
  return values;
}

/// Linearises the model about an equilibrium.
void GoTo(robot::RobotModel& model, const fem::StaticState& state) {
  Eigen::VectorXd weight_N = Eigen::VectorXd::Zero(state.x_m.size());
  model.AddWeight(weight_N);
  EXPECT_TRUE(model.linearisation().Update(state.x_m, state.multipliers_N, weight_N).ok());
}

/// Pulls two cables, of which one goes slack, and compares with equilibria under small forces.
TEST(ObservationJacobian, AreTheDerivativesOfEquilibriaWithCablesHeld) {
  const auto model = Build(QuickFourLegRobot());
  const std::vector<robot::ActuatorCommand> cables = {
      {Kind::kDisplacement, 0.008}, {Kind::kTension, 1.0}, {Kind::kDisplacement, -0.02}, {}};
  const fem::StaticState state = SolveTruth(*model, cables, {});
  ASSERT_GT(state.multipliers_N[0], 0.1);
  ASSERT_EQ(state.multipliers_N[2], 0.0);
  std::vector<fem::SurfacePatch> patches;
  for (const Eigen::Vector3d& about :
       {Eigen::Vector3d(0, 0, 0.125), Eigen::Vector3d(0.06, 0, 0.085)}) {
    patches.push_back(model->Patch(about, 0.006));
  }
  const std::vector<robot::ObservationRow> rows = MarkerRows(*model);
  GoTo(*model, state);
  ObservationJacobian responses;
  ASSERT_TRUE(responses.Add(*model, rows, state.x_m, cables, state.multipliers_N).ok());
  for (Eigen::Index column = 0; column < static_cast<Eigen::Index>(3 * patches.size()); ++column) {
    const fem::SurfacePatch& patch = patches[static_cast<size_t>(column / 3)];
    const Eigen::Vector3d force_N = 1e-3 * Eigen::Vector3d::Unit(column % 3);
    const fem::StaticState plus = SolveTruth(*model, cables, {{patch.weights, force_N}});
    const fem::StaticState minus = SolveTruth(*model, cables, {{patch.weights, -force_N}});
    const Eigen::VectorXd derivative =
        (ValuesOf(rows, plus.x_m) - ValuesOf(rows, minus.x_m)) / 2e-3;
    const Eigen::VectorXd response = responses.To(patch.weights).col(column % 3);
    EXPECT_LT((response - derivative).norm(), 1e-3 * derivative.norm()) << column;
  }
}

TEST(ObservationJacobian, OfRowsThatJoinAreAsIfTheyHadBeenThere) {
  const auto model = Build(QuickFourLegRobot());
  const std::vector<robot::ActuatorCommand> cables(4, {Kind::kDisplacement, 0.004});
  const fem::StaticState state = SolveTruth(*model, cables, {});
  GoTo(*model, state);
  const std::vector<robot::ObservationRow> rows = MarkerRows(*model);
  const std::vector<robot::ObservationRow> first(rows.begin(), rows.begin() + 5);
  const std::vector<robot::ObservationRow> others(rows.begin() + 5, rows.end());
  ObservationJacobian whole, joined;
  ASSERT_TRUE(whole.Add(*model, rows, state.x_m, cables, state.multipliers_N).ok());
  ASSERT_TRUE(joined.Add(*model, first, state.x_m, cables, state.multipliers_N).ok());
  ASSERT_TRUE(joined.Add(*model, others, state.x_m, cables, state.multipliers_N).ok());
  ASSERT_EQ(joined.Count(), static_cast<int>(rows.size()));
  const fem::InterpolationWeights place = model->Patch({0.06, 0, 0.085}, 0.006).weights;
  EXPECT_LT((joined.To(place) - whole.To(place)).norm(), 1e-12 * whole.To(place).norm());
  joined.Clear();
  EXPECT_EQ(joined.Count(), 0);
}

TEST(CandidateLocations, KeepClearOfHeldNodesAndCoverTheRest) {
  const auto model = Build(BeamRobot());
  const CandidateLocations places(*model, 0.005);
  EXPECT_GT(places.CandidateCount(), 50);
  EXPECT_LE(places.CandidateCount(), places.Count());
  EXPECT_GE(places.positions_m().row(0).minCoeff(), -0.1 + 0.00999);  // the clamp is at -0.1
  const geometry::SurfaceSamples samples =
      geometry::SampleByArea(fem::RestSurface(model->body().mesh, model->body().boundary), 500);
  for (const auto& sample_m : samples.positions_m.colwise()) {
    if (sample_m.x() < -0.088) continue;
    const Eigen::Vector3d place_m = places.positions_m().col(places.Nearest(sample_m));
    EXPECT_LT((place_m - sample_m).norm(), 3.0 * places.spacing_m());
  }
}

TEST(CandidateLocations, KnowTheirPatchesAndTheCandidatesAround) {
  const auto model = Build(BeamRobot());
  const CandidateLocations places(*model, 0.005);
  const Eigen::VectorXd rest_m = model->elastic_body().rest_m();
  const auto away_m = [&](int place, int candidate) {
    return (places.positions_m().col(places.PlaceOfCandidate(candidate)) -
            places.positions_m().col(place))
        .norm();
  };
  for (int place = 0; place < places.Count(); place += 13) {
    const Eigen::Vector3d position_m = places.positions_m().col(place);
    EXPECT_LT((places.Patch(place).Position(rest_m) - position_m).norm(), 0.004);
    const auto& around = places.NearestCandidates(place);
    for (int other = 0; other < places.CandidateCount(); ++other) {
      const bool is_around = std::find(around.begin(), around.end(), other) != around.end();
      EXPECT_TRUE(is_around || away_m(place, other) >= away_m(place, around.back()) - 1e-12);
    }
    EXPECT_LE(away_m(place, around.front()), away_m(place, around.back()));
  }
}

TEST(CandidateLocations, NormalsTurnWithTheShape) {
  const auto model = Build(BeamRobot());
  const CandidateLocations places(*model, 0.005);
  const Eigen::VectorXd rest_m = model->elastic_body().rest_m();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::VectorXd turned_m = (turn * rest_m.reshaped(3, rest_m.size() / 3)).reshaped();
  const Eigen::Matrix3Xd normals = places.Normals(rest_m);
  EXPECT_LT((places.Normals(turned_m) - turn * normals).cwiseAbs().maxCoeff(), 1e-12);
  const int top = places.Nearest({-0.05, 0.015, 0.03});
  EXPECT_GT(normals.col(top).z(), 0.99);
}

}  // namespace
}  // namespace palpate::force_estimation

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include "components/force_estimation/shape/patch_responses.hpp"
#include "components/force_estimation/shape/search_places.hpp"
#include "libs/geometry/surface_sampling.hpp"
#include "tests/components/force_estimation/test_bodies.hpp"

namespace palpate::force_estimation {
namespace {

/// Rows that see all of the markers.
std::vector<robot::EffectorRow> MarkerRows(const robot::RobotModel& model) {
  std::vector<robot::EffectorRow> rows;
  for (const robot::BodyMarker& marker : model.body().markers) {
    for (int axis = 0; axis < 3; ++axis) {
      rows.push_back(robot::RowOfPoint(marker.point.weights, Eigen::Vector3d::Unit(axis)));
    }
  }
  return rows;
}

Eigen::VectorXd ValuesOf(const std::vector<robot::EffectorRow>& rows, const Eigen::VectorXd& x_m) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = rows[i].Value(x_m);
  }
  return values;
}

Status SolveAbout(robot::RobotModel& model, const std::vector<robot::CableCommand>& cables,
                  const fem::StaticState& state, const std::vector<fem::SurfacePatch>& patches,
                  PatchResponses* responses) {
  Eigen::VectorXd weight_N = Eigen::VectorXd::Zero(state.x_m.size());
  model.AddWeight(weight_N);
  EXPECT_TRUE(model.linearisation().Update(state.x_m, state.multipliers_N, weight_N).ok());
  return responses->Solve(model, patches, state.x_m, cables, state.multipliers_N);
}

/// Pulls two cables, of which one goes slack, and compares with equilibria under small forces.
TEST(PatchResponses, AreTheDerivativesOfEquilibriaWithCablesHeld) {
  const auto model = Build(FourLegRobot());
  const std::vector<robot::CableCommand> cables = {
      {Kind::kDisplacement, 0.008}, {Kind::kTension, 1.0}, {Kind::kDisplacement, -0.02}, {}};
  const fem::StaticState state = SolveTruth(*model, cables, {});
  ASSERT_GT(state.multipliers_N[0], 0.1);
  ASSERT_EQ(state.multipliers_N[2], 0.0);
  std::vector<fem::SurfacePatch> patches;
  for (const Eigen::Vector3d& about :
       {Eigen::Vector3d(0, 0, 0.125), Eigen::Vector3d(0.06, 0, 0.085)}) {
    patches.push_back(model->Patch(about, 0.006));
  }
  PatchResponses responses;
  ASSERT_TRUE(SolveAbout(*model, cables, state, patches, &responses).ok());
  const std::vector<robot::EffectorRow> rows = MarkerRows(*model);
  const Eigen::VectorXd scale =
      Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(rows.size()), 1.0, 2.0);
  const Eigen::MatrixXd observed = responses.Observe(rows, scale);
  for (Eigen::Index column = 0; column < responses.ColumnCount(); ++column) {
    const fem::SurfacePatch& patch = patches[static_cast<size_t>(column / 3)];
    const Eigen::Vector3d force_N = 1e-3 * Eigen::Vector3d::Unit(column % 3);
    const fem::StaticState plus = SolveTruth(*model, cables, {{patch.weights, force_N}});
    const fem::StaticState minus = SolveTruth(*model, cables, {{patch.weights, -force_N}});
    const Eigen::VectorXd derivative =
        scale.cwiseProduct(ValuesOf(rows, plus.x_m) - ValuesOf(rows, minus.x_m)) / 2e-3;
    EXPECT_LT((observed.col(column) - derivative).norm(), 1e-3 * derivative.norm()) << column;
  }
}

TEST(PatchResponses, ASubstitutionForEachRowTellsTheSameAsOneForEachForce) {
  const auto model = Build(FourLegRobot());
  const std::vector<robot::CableCommand> cables = {
      {Kind::kDisplacement, 0.008}, {Kind::kTension, 1.0}, {Kind::kDisplacement, -0.02}, {}};
  const fem::StaticState state = SolveTruth(*model, cables, {});
  std::vector<fem::SurfacePatch> patches;
  for (const Eigen::Vector3d& about :
       {Eigen::Vector3d(0, 0, 0.125), Eigen::Vector3d(0.06, 0, 0.085)}) {
    patches.push_back(model->Patch(about, 0.006));
  }
  PatchResponses responses;
  ASSERT_TRUE(SolveAbout(*model, cables, state, patches, &responses).ok());
  const std::vector<robot::EffectorRow> rows = MarkerRows(*model);
  const auto count = static_cast<Eigen::Index>(rows.size());
  const Eigen::MatrixXd wanted = responses.Observe(rows, Eigen::VectorXd::Ones(count));
  Eigen::MatrixXd observed;
  ASSERT_TRUE(
      ObserveAbout(*model, patches, rows, state.x_m, cables, state.multipliers_N, &observed).ok());
  ASSERT_EQ(observed.cols(), wanted.cols());
  EXPECT_LT((observed - wanted).norm(), 1e-5 * wanted.norm());
}

TEST(PatchResponses, BetweenCandidatesAreInterpolated) {
  const auto model = Build(FourLegRobot());
  const std::vector<robot::CableCommand> cables(4);
  const fem::StaticState state = SolveTruth(*model, cables, {});
  const SearchPlaces places(*model, 0.006);
  PatchResponses at_candidates, exact;
  ASSERT_TRUE(SolveAbout(*model, cables, state, places.patches(), &at_candidates).ok());
  std::vector<fem::SurfacePatch> between;
  std::vector<int> chosen;
  for (int place = 7; place < places.Count(); place += places.Count() / 40) {
    chosen.push_back(place);
    between.push_back(model->Patch(places.positions_m().col(place), 0.006));
  }
  ASSERT_TRUE(SolveAbout(*model, cables, state, between, &exact).ok());
  const std::vector<robot::EffectorRow> rows = MarkerRows(*model);
  const Eigen::VectorXd scale = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(rows.size()));
  const Eigen::MatrixXd truth = exact.Observe(rows, scale);
  const Eigen::MatrixXd known = at_candidates.Observe(rows, scale);
  double error = 0.0;
  for (size_t k = 0; k < chosen.size(); ++k) {
    const Interpolation& interpolation = places.interpolation(chosen[k]);
    Eigen::MatrixXd made = Eigen::MatrixXd::Zero(truth.rows(), 3);
    for (size_t s = 0; s < interpolation.candidate.size(); ++s) {
      made += interpolation.weight[s] * known.middleCols<3>(3 * interpolation.candidate[s]);
    }
    const auto wanted = truth.middleCols<3>(3 * static_cast<Eigen::Index>(k));
    const double off = (made - wanted).norm() / wanted.norm();
    EXPECT_LT(off, 0.35) << places.positions_m().col(chosen[k]).transpose();
    error += off / static_cast<double>(chosen.size());
  }
  EXPECT_LT(error, 0.06);
}

TEST(SearchPlaces, KeepClearOfHeldNodesAndCoverTheRest) {
  const auto model = Build(BeamRobot());
  const SearchPlaces places(*model, 0.005);
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

TEST(SearchPlaces, InterpolationReproducesAffineMotions) {
  const auto model = Build(BeamRobot());
  const SearchPlaces places(*model, 0.005);
  const Eigen::Vector3d slope(0.3, -2.0, 1.1);
  for (int place = 0; place < places.Count(); place += 13) {
    const Interpolation& interpolation = places.interpolation(place);
    double value = 0.0;
    for (size_t k = 0; k < interpolation.candidate.size(); ++k) {
      const int at = places.PlaceOfCandidate(interpolation.candidate[k]);
      value += interpolation.weight[k] * (5.0 + slope.dot(places.positions_m().col(at)));
    }
    EXPECT_NEAR(value, 5.0 + slope.dot(places.positions_m().col(place)), 1e-4);
  }
}

TEST(SearchPlaces, NormalsTurnWithTheShape) {
  const auto model = Build(BeamRobot());
  const SearchPlaces places(*model, 0.005);
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

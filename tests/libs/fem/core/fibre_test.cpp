// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/fibre.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

#include "libs/fem/elastic_body.hpp"
#include "libs/fem/fibre_forces.hpp"
#include "tests/libs/fem/core/laws.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

using laws::CrookedBox;
using laws::DerivativeAlong;
using laws::RandomVector;
using laws::Rotation;

constexpr double kStiffness_N = 40.0;

EmbeddedFibre Laid(const PointLocator& locator, const Eigen::Matrix3Xd& path_m,
                   double stiffness_N = kStiffness_N) {
  EmbeddedFibre fibre;
  fibre.axial_stiffness_N = stiffness_N;
  AddPolyline(locator, path_m, &fibre);
  return fibre;
}

Eigen::Matrix3Xd ZigZag_m() {
  Eigen::Matrix3Xd path_m(3, 4);
  path_m << 0.003, 0.027, 0.004, 0.026,  //
      0.003, 0.005, 0.007, 0.006,        //
      0.003, 0.004, 0.007, 0.006;
  return path_m;
}

double Length_m(const EmbeddedFibre& fibre) {
  double length_m = 0.0;
  for (const FibrePoint& point : fibre.points) length_m += point.length_m;
  return length_m;
}

double Length_m(const Eigen::Matrix3Xd& path_m) {
  return (path_m.rightCols(path_m.cols() - 1) - path_m.leftCols(path_m.cols() - 1))
      .colwise()
      .norm()
      .sum();
}

Eigen::VectorXd MovedBy(const Eigen::Matrix3d& A, const Eigen::VectorXd& x_m,
                        const Eigen::Vector3d& by_m = Eigen::Vector3d::Zero()) {
  return ((A * x_m.reshaped(3, x_m.size() / 3)).colwise() + by_m).reshaped();
}

class FibresOf : public testing::TestWithParam<ElementType> {
 protected:
  Eigen::VectorXd Forces(const Eigen::VectorXd& x_m) const {
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
    fibres_.AddForces(x_m, force_N);
    return force_N;
  }

  TetMesh mesh_ = CrookedBox(GetParam(), {3, 1, 1});
  PointLocator locator_{mesh_};
  EmbeddedFibre fibre_ = Laid(locator_, ZigZag_m());
  Eigen::VectorXd rest_m_ = mesh_.nodes_m.reshaped();
  FibreForces fibres_{{fibre_}, rest_m_};
  std::mt19937 engine_{5};
  Eigen::VectorXd x_m_ = MovedBy(Eigen::Matrix3d::Identity() +
                                     0.2 * RandomVector(9, 1.0, &engine_).reshaped(3, 3).matrix(),
                                 rest_m_) +
                         RandomVector(rest_m_.size(), 3e-4, &engine_);
};

TEST_P(FibresOf, ItsPiecesAddUpToItsLengthAndPointAlongIt) {
  EXPECT_EQ(fibre_.off_m, 0.0);
  EXPECT_NEAR(Length_m(fibre_), Length_m(ZigZag_m()), 1e-15);
  EXPECT_GT(fibre_.points.size(), 12u);
  for (const FibrePoint& point : fibre_.points) {
    EXPECT_NEAR(point.direction.Position(rest_m_).norm(), 1.0, 1e-12);
    for (size_t k = 0; k < point.direction.nodes.size(); ++k) {
      EXPECT_EQ(point.direction.nodes[k], mesh_.cells(static_cast<Eigen::Index>(k), point.cell));
    }
  }
}

TEST_P(FibresOf, AtRestAndTurnedThereIsNoForce) {
  EXPECT_LE(Forces(rest_m_).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::VectorXd turned_m =
      MovedBy(Rotation(2.1, {1.0, 2.0, -3.0}), rest_m_, {0.1, -0.2, 0});
  EXPECT_LE(Forces(turned_m).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LE(fibres_.Energy(turned_m), 1e-24);
}

TEST_P(FibresOf, ForcesHaveNoResultantAndNoMomentAndTurnWithTheBody) {
  const Eigen::VectorXd force_N = Forces(x_m_);
  ASSERT_GT(force_N.norm(), 1.0);
  Eigen::Vector3d sum_N = Eigen::Vector3d::Zero(), moment_Nm = Eigen::Vector3d::Zero();
  for (Eigen::Index n = 0; n < force_N.size(); n += 3) {
    sum_N += force_N.segment<3>(n);
    moment_Nm += x_m_.segment<3>(n).cross(force_N.segment<3>(n));
  }
  EXPECT_LE(sum_N.norm(), 1e-12 * force_N.norm());
  EXPECT_LE(moment_Nm.norm(), 1e-12 * force_N.norm() * x_m_.cwiseAbs().maxCoeff());
  const Eigen::Matrix3d R = Rotation(2.1, {3.0, 1.0, -2.0});
  EXPECT_LE((Forces(MovedBy(R, x_m_, {0.5, 0.0, -0.2})) - MovedBy(R, force_N)).norm(),
            1e-12 * force_N.norm());
}

TEST_P(FibresOf, ForcesAreTheGradientOfTheEnergy) {
  const Eigen::VectorXd force_N = Forces(x_m_);
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd d = RandomVector(x_m_.size(), 1.0, &engine_);
    const double slope =
        DerivativeAlong([&](const Eigen::VectorXd& x) { return fibres_.Energy(x); }, x_m_, d, 2e-6);
    EXPECT_NEAR(force_N.dot(d), slope, 1e-9 * force_N.norm() * d.norm());
  }
}

/// Through the body's assembly, whose matrix stores one triangle: the tangent is symmetric.
TEST_P(FibresOf, TheTangentOfTheBodyIsTheDerivativeOfItsForces) {
  const Material material{MaterialModel::kStableNeoHookean, Volumetric::kPointwise, 1e3, 0.3};
  ElasticBody body(mesh_, {material}, std::vector<int>(static_cast<size_t>(mesh_.CellCount())),
                   {fibre_});
  StiffnessMatrix K(Eigen::Matrix<bool, 3, Eigen::Dynamic>::Constant(3, body.NodeCount(), false),
                    body.CoupledPairs());
  body.BindTo(K);
  const auto forces = [&](const Eigen::VectorXd& x_m) {
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
    body.AddForces(x_m, force_N);
    return force_N;
  };
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m_.size());
  body.AddForcesAndSetTangent(x_m_, force_N, K);
  EXPECT_LE((force_N - forces(x_m_)).norm(), 1e-13 * force_N.norm());
  double min_J = 0.0;
  Eigen::VectorXd of_cells_J;
  body.CellEnergies(x_m_, &of_cells_J);
  EXPECT_NEAR(body.Energy(x_m_, &min_J), of_cells_J.sum() + fibres_.Energy(x_m_),
              1e-13 * of_cells_J.sum());
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd d = RandomVector(x_m_.size(), 1.0, &engine_);
    const Eigen::VectorXd expected = DerivativeAlong(forces, x_m_, d, 5e-6);
    Eigen::VectorXd reduced(K.Size());
    K.Reduce(d, reduced);
    Eigen::VectorXd product = Eigen::VectorXd::Zero(x_m_.size());
    K.AddExpanded(K.Times(reduced), 1.0, product);
    EXPECT_LE((product - expected).norm(), 1e-8 * expected.norm());
  }
}

/// What error bounds of forces take for dF/dlnE: the forces of the cells, without the fibres.
TEST_P(FibresOf, OnlyTheForcesOfCellsGrowWithTheModulus) {
  constexpr double kModulus_Pa = 1e3, kStep = 1e-3;
  const Material material{MaterialModel::kStableNeoHookean, Volumetric::kPointwise, kModulus_Pa,
                          0.3};
  ElasticBody body(mesh_, {material}, std::vector<int>(static_cast<size_t>(mesh_.CellCount())),
                   {fibre_});
  const auto forces = [&](double factor) {
    body.SetYoungsModulus(0, factor * kModulus_Pa);
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m_.size());
    body.AddForces(x_m_, force_N);
    return force_N;
  };
  const Eigen::VectorXd by_modulus_N = (forces(1.0 + kStep) - forces(1.0 - kStep)) / (2.0 * kStep);
  body.SetYoungsModulus(0, kModulus_Pa);
  Eigen::VectorXd of_cells_N = Eigen::VectorXd::Zero(x_m_.size());
  body.AddForcesOfCells(x_m_, of_cells_N);
  EXPECT_LE((by_modulus_N - of_cells_N).norm(), 1e-9 * of_cells_N.norm());
  EXPECT_GT(Forces(x_m_).norm(), 0.1 * of_cells_N.norm());
}

TEST_P(FibresOf, DerivativesAlongPositionsAndRestShapeAreThoseOfDifferences) {
  for (int trial = 0; trial < 3; ++trial) {
    const Eigen::VectorXd d = RandomVector(x_m_.size(), 1.0, &engine_);
    Eigen::VectorXd along = Eigen::VectorXd::Zero(x_m_.size());
    fibres_.AddAlongPositions(x_m_, d, -2.0, along);
    const Eigen::VectorXd by_x =
        DerivativeAlong([&](const Eigen::VectorXd& x) { return Forces(x); }, x_m_, d, 5e-6);
    EXPECT_LE((along + 2.0 * by_x).norm(), 1e-8 * by_x.norm());

    along.setZero();
    fibres_.AddAlongRestShape(x_m_, d, -2.0, along);
    const Eigen::VectorXd by_X = DerivativeAlong(
        [&](const Eigen::VectorXd& X_m) {
          Eigen::VectorXd force_N = Eigen::VectorXd::Zero(X_m.size());
          FibreForces({fibre_}, X_m).AddForces(x_m_, force_N);
          return force_N;
        },
        rest_m_, d, 5e-6);
    EXPECT_LE((along + 2.0 * by_X).norm(), 1e-8 * by_X.norm());
  }
}

/// A larger body of the same fibre, stretched alike, has the same tension: its energy grows with
/// its length.
TEST_P(FibresOf, AScaledRestShapeScalesTheEnergyByItsLength) {
  const FibreForces larger({fibre_}, 3.0 * rest_m_);
  EXPECT_NEAR(larger.Energy(3.0 * x_m_), 3.0 * fibres_.Energy(x_m_), 1e-12 * fibres_.Energy(x_m_));
}

TEST_P(FibresOf, TellsWhereItLeavesTheBody) {
  Eigen::Matrix3Xd path_m(3, 2);
  path_m << 0.004, 0.004, 0.005, 0.005, 0.005, 0.045;
  const EmbeddedFibre fibre = Laid(locator_, path_m);
  EXPECT_GT(fibre.off_m, 0.01);
  EXPECT_GT(fibre.off_at_m.z(), 0.01);
  EXPECT_NEAR(Length_m(fibre), 0.04, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Elements, FibresOf,
                         testing::Values(ElementType::kTet4, ElementType::kTet10));

/// A bar of E A, nu = 0, with a fibre of EA_f along its whole length, whose ends are pulled apart:
/// the strain is the same everywhere, and the force (E A + EA_f) times it, exactly.
class BarWithFibre : public testing::TestWithParam<ElementType> {};

TEST_P(BarWithFibre, HasTheSumOfBothStiffnesses) {
  constexpr double kLength_m = 0.06, kWidth_m = 0.02, kStrain = 0.01;
  TetMesh mesh = BoxMesh({kLength_m, kWidth_m, kWidth_m}, {5, 3, 3});
  if (GetParam() == ElementType::kTet10) mesh = MakeQuadratic(mesh);
  const Material material{MaterialModel::kLinear, Volumetric::kPointwise, 100e3, 0.0};
  Eigen::Matrix3Xd path_m(3, 2);  // along no edge of the mesh
  path_m << 0.0, kLength_m, 0.0113, 0.0113, 0.0087, 0.0087;
  const ElasticBody body(mesh, {material}, std::vector<int>(static_cast<size_t>(mesh.CellCount())),
                         {Laid(PointLocator(mesh), path_m)});
  Eigen::VectorXd x_m = body.rest_m();
  for (Eigen::Index k = 0; k < x_m.size(); k += 3) x_m[k] *= 1.0 + kStrain;
  Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
  body.AddForces(x_m, force_N);
  double pull_N = 0.0;
  for (Eigen::Index node = 0; node < mesh.nodes_m.cols(); ++node) {
    const double along = mesh.nodes_m(0, node) / kLength_m;
    if (along > 1.0 - 1e-9) {
      pull_N += force_N[3 * node];
    } else if (along > 1e-9) {
      EXPECT_LE(force_N.segment<3>(3 * node).norm(), 1e-12) << "between its ends it is in balance";
    }
  }
  EXPECT_NEAR(pull_N, (100e3 * kWidth_m * kWidth_m + kStiffness_N) * kStrain, 1e-12);
}

/// A fibre at an angle to a homogeneous deformation F has the stretch |F t| all along.
TEST_P(BarWithFibre, StretchesAsTheMaterialDoes) {
  TetMesh mesh = BoxMesh({0.06, 0.02, 0.02}, {4, 2, 2});
  if (GetParam() == ElementType::kTet10) mesh = MakeQuadratic(mesh);
  Eigen::Matrix3Xd path_m(3, 2);
  path_m << 0.003, 0.057, 0.002, 0.018, 0.003, 0.015;
  const FibreForces fibres({Laid(PointLocator(mesh), path_m)}, mesh.nodes_m.reshaped());
  Eigen::Matrix3d F;
  F << 1.2, 0.1, 0.0, -0.05, 0.9, 0.2, 0.0, 0.1, 1.1;
  const Eigen::Vector3d along_m = path_m.col(1) - path_m.col(0);
  const double strain = (F * along_m).norm() / along_m.norm() - 1.0;
  const Eigen::VectorXd x_m = MovedBy(F, mesh.nodes_m.reshaped());
  EXPECT_NEAR(fibres.Energy(x_m), 0.5 * kStiffness_N * along_m.norm() * strain * strain, 1e-14);
  EXPECT_NEAR(fibres.LargestStrains(x_m)[0], strain, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Elements, BarWithFibre,
                         testing::Values(ElementType::kTet4, ElementType::kTet10));

}  // namespace
}  // namespace palpate::fem

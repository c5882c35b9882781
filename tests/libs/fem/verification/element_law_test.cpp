// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "libs/fem/linearisation.hpp"
#include "tests/libs/fem/verification/grid_mesh.hpp"

namespace palpate::fem::verification {
namespace {

/// A material with an element, as the laws below go over all of them.
struct Kind {
  MaterialModel model;
  Volumetric volumetric;
  ElementType element;

  Material MaterialOf() const {
    return {.model = model,
            .volumetric = volumetric,
            .youngs_modulus_Pa = 180e3,
            .poissons_ratio = 0.45};
  }
};

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << ToString(kind.model) << (kind.element == ElementType::kTet4 ? ", tet4" : ", tet10")
       << (kind.volumetric == Volumetric::kMeanDilatation ? ", mean dilatation" : "");
}

/// Every material with every element; `large_strain`: without the small-strain material, which does
/// not know rotations.
std::vector<Kind> Kinds(bool large_strain) {
  std::vector<Kind> kinds;
  for (MaterialModel model :
       {MaterialModel::kLinear, MaterialModel::kCorotational, MaterialModel::kStVenantKirchhoff,
        MaterialModel::kNeoHookean, MaterialModel::kStableNeoHookean}) {
    if (large_strain && model == MaterialModel::kLinear) continue;
    kinds.push_back({model, Volumetric::kPointwise, ElementType::kTet4});
    kinds.push_back({model, Volumetric::kPointwise, ElementType::kTet10});
    const bool has_volume_law =
        model != MaterialModel::kCorotational && model != MaterialModel::kStVenantKirchhoff;
    if (has_volume_law) kinds.push_back({model, Volumetric::kMeanDilatation, ElementType::kTet10});
  }
  return kinds;
}

std::string NameOf(const testing::TestParamInfo<Kind>& each) {
  const Kind& kind = each.param;
  return std::string(ToString(kind.model)) +
         (kind.element == ElementType::kTet4 ? "_tet4" : "_tet10") +
         (kind.volumetric == Volumetric::kMeanDilatation ? "_mean" : "");
}

const Eigen::Array3i kCells(3, 3, 3);
const Eigen::Vector3d kBlock_m(0.06, 0.05, 0.04);

TetMesh MakeMesh(const Kind& kind) { return MakeDistortedBox(kCells, kind.element, kBlock_m, 0.2); }

ElasticBody MakeBody(const Kind& kind, const TetMesh& mesh) {
  return {mesh, {kind.MaterialOf()}, std::vector<int>(static_cast<size_t>(mesh.CellCount()), 0)};
}

bool OnBoxSurface(const Eigen::Vector3d& p) {
  return (p.array() < 1e-9).any() || (p.array() > kBlock_m.array() - 1e-9).any();
}

/// [3 x n], uniform in [-1, 1], the same in each run for a seed.
Eigen::Matrix3Xd Noise(int columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::Matrix3Xd noise(3, columns);
  for (double& value : noise.reshaped()) value = uniform(engine);
  return noise;
}

class ElementLaw : public testing::TestWithParam<Kind> {};
class LargeStrainElementLaw : public ElementLaw {};

TEST_P(LargeStrainElementLaw, RigidRotationCausesNoForce) {
  const TetMesh mesh = MakeMesh(GetParam());
  const ElasticBody body = MakeBody(GetParam(), mesh);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0),
                                      Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, -2, 0.5)}) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(2.1, axis.normalized()).toRotationMatrix();
    const Eigen::Matrix3Xd x_m = R * mesh.nodes_m;
    Eigen::VectorXd force_N = Eigen::VectorXd::Zero(x_m.size());
    const double min_J = body.AddForces(x_m.reshaped(), force_N);
    EXPECT_NEAR(min_J, 1.0, 1e-12);
    EXPECT_LT(force_N.reshaped(3, mesh.NodeCount()).colwise().norm().maxCoeff(), 1e-12)
        << "axis " << axis.transpose();
  }
}

TEST_P(ElementLaw, PatchUnderAffineStrainStaysAffine) {
  Eigen::Matrix3d F;
  F << 1.08, 0.05, -0.03, -0.04, 0.92, 0.06, 0.02, -0.05, 1.10;
  const TetMesh mesh = MakeMesh(GetParam());
  const Eigen::Matrix3Xd expected_m = F * mesh.nodes_m;
  FixedDirections fixed = FixedDirections::Constant(3, mesh.NodeCount(), false);
  Eigen::Matrix3Xd x_m = expected_m + 2e-4 * Noise(mesh.NodeCount(), 1);
  for (int node : NodesWhere(mesh, OnBoxSurface)) {
    fixed.col(node).setConstant(true);
    x_m.col(node) = expected_m.col(node);
  }
  ASSERT_LT(fixed.row(0).count(), fixed.cols()) << "no free node";
  ElasticBody body = MakeBody(GetParam(), mesh);
  Linearisation linearisation(body, {}, fixed);
  Eigen::VectorXd x = x_m.reshaped();
  const Eigen::VectorXd no_load = Eigen::VectorXd::Zero(x.size());
  for (int iteration = 0; iteration < 12; ++iteration) {
    ASSERT_TRUE(linearisation.Update(x, {}, no_load, /*allow_shift=*/true).ok());
    Eigen::MatrixXd step = linearisation.residual_N();
    linearisation.Solve(step);
    linearisation.matrix().AddExpanded(step.col(0), 1.0, x);
  }
  EXPECT_LT((x - expected_m.reshaped()).cwiseAbs().maxCoeff(), 1e-15);
}

TEST_P(ElementLaw, TangentIsDerivativeOfForces) {
  const TetMesh mesh = MakeMesh(GetParam());
  ElasticBody body = MakeBody(GetParam(), mesh);
  const Eigen::VectorXd direction = Noise(mesh.NodeCount(), 2).reshaped();
  Eigen::Matrix3d F;
  F << 1.2, 0.3, -0.1, -0.2, 0.9, 0.1, 0.1, -0.2, 1.1;
  const Eigen::Matrix3Xd moved_m = F * mesh.nodes_m + 5e-4 * Noise(mesh.NodeCount(), 1);
  const Eigen::VectorXd x_m = moved_m.reshaped();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(x_m.size());
  StiffnessMatrix tangent(FixedDirections::Constant(3, mesh.NodeCount(), false),
                          body.CoupledPairs());
  body.BindTo(tangent);
  Eigen::VectorXd force_N = zero;
  ASSERT_GT(body.AddForcesAndSetTangent(x_m, force_N, tangent), 0.0);

  const auto forces_at = [&](double step_m) {
    Eigen::VectorXd force = zero;
    EXPECT_GT(body.AddForces(x_m + step_m * direction, force), 0.0);
    return force;
  };
  const double h_m = 1e-5;
  const Eigen::VectorXd near = (forces_at(h_m) - forces_at(-h_m)) / (2.0 * h_m);
  const Eigen::VectorXd far = (forces_at(2.0 * h_m) - forces_at(-2.0 * h_m)) / (4.0 * h_m);
  const Eigen::VectorXd difference = (4.0 * near - far) / 3.0;
  Eigen::VectorXd reduced(tangent.Size());
  tangent.Reduce(direction, reduced);
  Eigen::VectorXd product = zero;
  tangent.AddExpanded(tangent.Times(reduced), 1.0, product);
  EXPECT_LT((product - difference).norm(), 1e-8 * difference.norm());
}

INSTANTIATE_TEST_SUITE_P(Kinds, ElementLaw, testing::ValuesIn(Kinds(/*large_strain=*/false)),
                         NameOf);
INSTANTIATE_TEST_SUITE_P(Kinds, LargeStrainElementLaw,
                         testing::ValuesIn(Kinds(/*large_strain=*/true)), NameOf);

}  // namespace
}  // namespace palpate::fem::verification

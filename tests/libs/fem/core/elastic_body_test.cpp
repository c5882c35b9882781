// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/elastic_body.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <memory>
#include <string>
#include <vector>

#include "libs/core/error.hpp"
#include "libs/core/thread_team.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem {
namespace {

using laws::AllLaws;
using laws::CrookedBox;
using laws::DerivativeAlong;
using laws::Law;
using laws::RandomVector;
using laws::Rotation;

Material SoftMaterial(MaterialModel model, Volumetric volumetric, double youngs_modulus_Pa) {
  return {model, volumetric, youngs_modulus_Pa, 0.45, /*c20_over_c10=*/-0.1, /*c30_over_c10=*/0.2};
}

/// Cells in turn of the first and the second material.
ElasticBody TwoRegionBody(const TetMesh& mesh, const Law& law, double first_Pa, double second_Pa) {
  std::vector<int> material_of_cell(static_cast<size_t>(mesh.CellCount()));
  for (size_t cell = 0; cell < material_of_cell.size(); ++cell) {
    material_of_cell[cell] = cell % 3 == 0 ? 1 : 0;
  }
  return {mesh,
          {SoftMaterial(law.model, law.volumetric, first_Pa),
           SoftMaterial(law.model, law.volumetric, second_Pa)},
          material_of_cell};
}

Eigen::VectorXd Forces(const ElasticBody& body, const Eigen::VectorXd& x_m) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(x_m.size());
  body.AddForces(x_m, force);
  return force;
}

double Energy(const ElasticBody& body, const Eigen::VectorXd& x_m) {
  double min_J = 0.0;
  return body.Energy(x_m, &min_J);
}

Eigen::VectorXd Moved(const Eigen::Matrix3d& A, const Eigen::VectorXd& x_m,
                      const Eigen::Vector3d& by_m = Eigen::Vector3d::Zero()) {
  return ((A * x_m.reshaped(3, x_m.size() / 3)).colwise() + by_m).reshaped();
}

class ElasticBodyLaw : public ::testing::TestWithParam<Law> {
 protected:
  bool IsFrameInvariant() const { return GetParam().model != MaterialModel::kLinear; }

  TetMesh mesh_ = CrookedBox(GetParam().element, {2, 1, 1});
  ElasticBody body_ = TwoRegionBody(mesh_, GetParam(), 180e3, 60e3);
  std::mt19937 engine_{3};
  Eigen::VectorXd x_m_ =
      Moved(Eigen::Matrix3d::Identity() +
                0.1 * Eigen::Matrix3d(RandomVector(9, 1.0, &engine_).reshaped(3, 3)),
            body_.rest_m()) +
      RandomVector(body_.rest_m().size(), 3e-4, &engine_);
};

TEST_P(ElasticBodyLaw, IsStressFreeAtRest) {
  EXPECT_LE(Forces(body_, body_.rest_m()).cwiseAbs().maxCoeff(), 1e-12);
  double min_J = 0.0;
  body_.Energy(body_.rest_m(), &min_J);
  EXPECT_NEAR(min_J, 1.0, 1e-12);
}

TEST_P(ElasticBodyLaw, ARigidRotationGivesNoForce) {
  if (!IsFrameInvariant()) GTEST_SKIP() << "small strain by definition";
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1),
        Eigen::Vector3d(1, 2, -3), Eigen::Vector3d(-1, 1, 1)}) {
    const Eigen::VectorXd turned = Moved(Rotation(2.1, axis), body_.rest_m(), {0.02, -0.01, 0.03});
    EXPECT_LE(Forces(body_, turned).cwiseAbs().maxCoeff(), 1e-12) << axis.transpose();  // N
  }
}

TEST_P(ElasticBodyLaw, ForcesTurnWithTheBody) {
  if (!IsFrameInvariant()) GTEST_SKIP() << "small strain by definition";
  const Eigen::Matrix3d R = Rotation(2.1, {3.0, 1.0, -2.0});
  const Eigen::VectorXd turned = Moved(R, x_m_, {0.5, 0.0, -0.2});
  const Eigen::VectorXd force = Forces(body_, x_m_);
  EXPECT_LE((Forces(body_, turned) - Moved(R, force)).norm(), 1e-11 * force.norm());
  EXPECT_NEAR(Energy(body_, turned), Energy(body_, x_m_), 1e-11 * Energy(body_, x_m_));
}

TEST_P(ElasticBodyLaw, AssembledForceAndTangentAreDerivatives) {
  StiffnessMatrix K(Eigen::Matrix<bool, 3, Eigen::Dynamic>::Constant(3, body_.NodeCount(), false),
                    body_.CoupledPairs());
  body_.BindTo(K);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(x_m_.size());
  const double min_J = body_.AddForcesAndSetTangent(x_m_, force, K);
  EXPECT_LE((force - Forces(body_, x_m_)).norm(), 1e-13 * force.norm());
  double energy_min_J = 0.0;
  body_.Energy(x_m_, &energy_min_J);
  EXPECT_EQ(min_J, energy_min_J);
  EXPECT_GT(min_J, 0.0);
  for (int trial = 0; trial < 5; ++trial) {
    const Eigen::VectorXd d = RandomVector(x_m_.size(), 1.0, &engine_);
    const double slope =
        DerivativeAlong([&](const Eigen::VectorXd& x) { return Energy(body_, x); }, x_m_, d, 2e-6);
    EXPECT_NEAR(force.dot(d), slope, 1e-8 * force.norm() * d.norm());
    const Eigen::VectorXd expected =
        DerivativeAlong([&](const Eigen::VectorXd& x) { return Forces(body_, x); }, x_m_, d, 5e-6);
    Eigen::VectorXd reduced(K.Size());
    K.Reduce(d, reduced);
    Eigen::VectorXd product = Eigen::VectorXd::Zero(x_m_.size());
    K.AddExpanded(K.Times(reduced), 1.0, product);
    EXPECT_LE((product - expected).norm(), 1e-8 * expected.norm());
  }
}

TEST_P(ElasticBodyLaw, ForcesAddUpToNothingAndTurnNothing) {
  const Eigen::VectorXd force = Forces(body_, x_m_);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (Eigen::Index n = 0; n < force.size(); n += 3) {
    sum += force.segment<3>(n);
    moment += x_m_.segment<3>(n).cross(force.segment<3>(n));
  }
  EXPECT_LE(sum.norm(), 1e-13 * force.norm());
  if (IsFrameInvariant()) {
    EXPECT_LE(moment.norm(), 1e-13 * force.norm());
  }
}

TEST_P(ElasticBodyLaw, UniformStretchHasTheClosedFormEnergyAndStress) {
  const Material material = SoftMaterial(GetParam().model, GetParam().volumetric, 180e3);
  const ElasticBody body(mesh_, {material},
                         std::vector<int>(static_cast<size_t>(mesh_.CellCount()), 0));
  Eigen::Matrix3d uniaxial = Eigen::Vector3d(1.3, 1.0, 1.0).asDiagonal();
  Eigen::Matrix3d sheared = Eigen::Vector3d(0.9, 1.2, 1.1).asDiagonal();
  sheared(0, 1) = 0.2;
  sheared(2, 0) = -0.1;
  // The rest volume as the stiffness rule measures it (on curved tet10 not exact).
  const Material probe{MaterialModel::kLinear, Volumetric::kPointwise, 1.0, 0.0};
  const ElasticBody volume_meter(mesh_, {probe},
                                 std::vector<int>(static_cast<size_t>(mesh_.CellCount()), 0));
  const double volume_m3 =
      2.0 * Energy(volume_meter, Moved(Eigen::Vector3d(2.0, 1.0, 1.0).asDiagonal().toDenseMatrix(),
                                       body.rest_m()));
  for (const Eigen::Matrix3d& F :
       {uniaxial, Eigen::Matrix3d(1.15 * Eigen::Matrix3d::Identity()), sheared}) {
    const Eigen::VectorXd x = Moved(F, body.rest_m());
    const double expected =
        volume_m3 * (laws::EnergyDensity_Pa(material, F) -
                     laws::EnergyDensity_Pa(material, Eigen::Matrix3d::Identity()));
    const double energy = Energy(body, x) - Energy(body, body.rest_m());
    EXPECT_NEAR(energy, expected, 1e-12 * std::abs(expected));
    const Eigen::Matrix3d P = laws::Stress_Pa(material, F);
    const Eigen::VectorXd force = Forces(body, x);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {  // virtual work of dF = e_i e_j'
        const Eigen::Matrix3d dF = Eigen::Vector3d::Unit(i) * Eigen::Vector3d::Unit(j).transpose();
        EXPECT_NEAR(force.dot(Moved(dF, body.rest_m())), volume_m3 * P(i, j),
                    1e-12 * volume_m3 * P.cwiseAbs().maxCoeff());
      }
    }
  }
}

TEST_P(ElasticBodyLaw, ForcesAreLinearInEachModulus) {
  Eigen::VectorXd first = Eigen::VectorXd::Zero(x_m_.size());
  Eigen::VectorXd second = first;
  body_.AddForcesOfMaterial(0, x_m_, first);
  body_.AddForcesOfMaterial(1, x_m_, second);
  const Eigen::VectorXd total = Forces(body_, x_m_);
  EXPECT_LE((first + second - total).norm(), 1e-13 * total.norm());
  EXPECT_GT(second.norm(), 0.0);

  body_.SetYoungsModulus(1, 3.0 * 60e3);
  EXPECT_EQ(body_.materials()[1].youngs_modulus_Pa, 180e3);
  const Eigen::VectorXd stiffened = Forces(body_, x_m_);
  EXPECT_LE((stiffened - (first + 3.0 * second)).norm(), 1e-12 * stiffened.norm());
  const ElasticBody same = TwoRegionBody(mesh_, GetParam(), 180e3, 180e3);
  EXPECT_LE((stiffened - Forces(same, x_m_)).norm(), 1e-13 * stiffened.norm());
}

INSTANTIATE_TEST_SUITE_P(AllLaws, ElasticBodyLaw, ::testing::ValuesIn(AllLaws()),
                         [](const auto& law_info) { return laws::Name(law_info.param); });

/// All that a body gives at one state.
struct Assembled {
  Eigen::VectorXd force, tangent_force, force_of_material, tangent;
  double energy = 0.0, min_J = 0.0;
  bool operator==(const Assembled&) const = default;
};

Assembled Assemble(ElasticBody& body, const Eigen::VectorXd& x_m, StiffnessMatrix& K, int threads) {
  body.BindTo(K, std::make_shared<ThreadTeam>(threads));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(x_m.size());
  Assembled result{zero, zero, zero, {}};
  body.AddForces(x_m, result.force);
  body.AddForcesOfMaterial(1, x_m, result.force_of_material);
  std::fill(K.Values().begin(), K.Values().end(), 1e3);  // what was there before does not count
  body.AddForcesAndSetTangent(x_m, result.tangent_force, K);
  result.tangent = Eigen::Map<const Eigen::VectorXd>(K.Values().data(),
                                                     static_cast<Eigen::Index>(K.Values().size()));
  result.energy = body.Energy(x_m, &result.min_J);
  return result;
}

TEST_P(ElasticBodyLaw, IsTheSameToTheLastBitOnAnyNumberOfThreads) {
  const TetMesh mesh = CrookedBox(GetParam().element, {6, 3, 2});
  ElasticBody body = TwoRegionBody(mesh, GetParam(), 180e3, 60e3);
  const Eigen::VectorXd x_m = body.rest_m() + RandomVector(body.rest_m().size(), 4e-4, &engine_);
  Eigen::Matrix<bool, 3, Eigen::Dynamic> fixed =
      Eigen::Matrix<bool, 3, Eigen::Dynamic>::Constant(3, body.NodeCount(), false);
  for (int node = 0; node < body.NodeCount(); ++node) {
    if (mesh.nodes_m(0, node) < 0.012) fixed.col(node).setConstant(true);
  }
  StiffnessMatrix K(fixed, body.CoupledPairs());
  const Assembled alone = Assemble(body, x_m, K, 1);
  EXPECT_EQ(alone.force, alone.tangent_force);
  EXPECT_GT(alone.tangent.norm(), 0.0);
  for (const int threads : {2, 3, 7, 40}) {
    EXPECT_TRUE(Assemble(body, x_m, K, threads) == alone) << threads << " threads";
  }
  body.BindTo(K);
  EXPECT_EQ(Forces(body, x_m), alone.force);
}

TEST_P(ElasticBodyLaw, HeldNodesLeaveTheOtherBlocksAsTheyAre) {
  using Fixed = Eigen::Matrix<bool, 3, Eigen::Dynamic>;
  Fixed fixed = Fixed::Constant(3, body_.NodeCount(), false);
  StiffnessMatrix whole(fixed, body_.CoupledPairs());
  for (const int node : {0, 3, 8}) fixed.col(node).setConstant(true);
  StiffnessMatrix held(fixed, body_.CoupledPairs());
  Eigen::VectorXd whole_force = Eigen::VectorXd::Zero(x_m_.size());
  Eigen::VectorXd held_force = whole_force;
  body_.BindTo(whole);
  body_.AddForcesAndSetTangent(x_m_, whole_force, whole);
  body_.BindTo(held, std::make_shared<ThreadTeam>(2));
  body_.AddForcesAndSetTangent(x_m_, held_force, held);
  EXPECT_LE((held_force - whole_force).norm(), 1e-13 * whole_force.norm());

  Eigen::VectorXd d = RandomVector(x_m_.size(), 1.0, &engine_);
  for (const int node : {0, 3, 8}) d.segment<3>(3 * node).setZero();
  const auto product = [&](const StiffnessMatrix& K) {
    Eigen::VectorXd reduced(K.Size());
    K.Reduce(d, reduced);
    Eigen::VectorXd nodal = Eigen::VectorXd::Zero(x_m_.size());
    K.AddExpanded(K.Times(reduced), 1.0, nodal);
    return nodal;
  };
  Eigen::VectorXd expected = product(whole);
  for (const int node : {0, 3, 8}) expected.segment<3>(3 * node).setZero();
  EXPECT_LE((product(held) - expected).norm(), 1e-13 * expected.norm());
}

TEST(ElasticBody, YeohWithoutHigherTermsIsNeoHookeanAtConstantVolume) {
  const TetMesh mesh = CrookedBox(ElementType::kTet10, {1, 1, 1});
  const std::vector<int> first(static_cast<size_t>(mesh.CellCount()), 0);
  const Material yeoh{MaterialModel::kYeoh, Volumetric::kPointwise, 1e5, 0.45};
  const Material neo_hookean{MaterialModel::kStableNeoHookean, Volumetric::kPointwise, 1e5, 0.45};
  const ElasticBody body(mesh, {yeoh}, first);
  const ElasticBody other(mesh, {neo_hookean}, first);
  const Eigen::VectorXd x =
      Moved(Eigen::Vector3d(1.6, 1.0 / 1.28, 0.8).asDiagonal().toDenseMatrix(), body.rest_m());
  EXPECT_NEAR(Energy(body, x), Energy(other, x), 1e-13 * Energy(other, x));
}

TEST(ElasticBody, YeohHasTheStiffnessOfSmallStrains) {
  const TetMesh mesh = CrookedBox(ElementType::kTet4, {1, 1, 1});
  const std::vector<int> first(static_cast<size_t>(mesh.CellCount()), 0);
  const ElasticBody yeoh(mesh, {SoftMaterial(MaterialModel::kYeoh, Volumetric::kPointwise, 1e5)},
                         first);
  const ElasticBody linear(
      mesh, {SoftMaterial(MaterialModel::kLinear, Volumetric::kPointwise, 1e5)}, first);
  std::mt19937 engine(8);
  const Eigen::VectorXd x =
      yeoh.rest_m() + RandomVector(yeoh.rest_m().size(), 1e-9, &engine);  // strains of 1e-7
  const Eigen::VectorXd expected = Forces(linear, x);
  EXPECT_LE((Forces(yeoh, x) - expected).norm(), 1e-5 * expected.norm());
}

TEST(YeohMaterial, IsMonotoneWhereShearNeverSoftensToNothing) {
  EXPECT_TRUE(IsYeohMonotone(0.0, 0.0));
  EXPECT_TRUE(IsYeohMonotone(0.3, 0.0));
  EXPECT_TRUE(IsYeohMonotone(-0.1, 0.0034));
  EXPECT_FALSE(IsYeohMonotone(-0.1, 0.0033));
  EXPECT_FALSE(IsYeohMonotone(-0.1, 0.0));
  EXPECT_FALSE(IsYeohMonotone(0.3, -1e-9));
}

TEST(ElasticBody, MixesMaterialModels) {
  const TetMesh mesh = CrookedBox(ElementType::kTet4, {2, 1, 1});
  std::vector<int> material_of_cell(static_cast<size_t>(mesh.CellCount()), 0);
  material_of_cell[3] = material_of_cell[7] = 1;
  const Material soft = SoftMaterial(MaterialModel::kCorotational, Volumetric::kPointwise, 50e3);
  const Material stiff = SoftMaterial(MaterialModel::kNeoHookean, Volumetric::kPointwise, 90e3);
  const ElasticBody body(mesh, {soft, stiff}, material_of_cell);
  const Eigen::Matrix3d F = Eigen::Vector3d(1.1, 0.95, 1.0).asDiagonal();
  double expected = 0.0;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const Eigen::Matrix<double, 3, 4> corners = mesh.nodes_m(Eigen::all, mesh.cells.col(cell));
    const Eigen::Matrix3d edges = corners.rightCols<3>().colwise() - corners.col(0);
    const Material& material = material_of_cell[static_cast<size_t>(cell)] == 1 ? stiff : soft;
    expected += edges.determinant() / 6.0 * laws::EnergyDensity_Pa(material, F);
  }
  EXPECT_NEAR(Energy(body, Moved(F, body.rest_m())), expected, 1e-12 * expected);
}

TEST(ElasticBody, TellsThatAnElementIsInverted) {
  const TetMesh mesh = CrookedBox(ElementType::kTet4, {1, 1, 1});
  const ElasticBody body = TwoRegionBody(
      mesh, {MaterialModel::kStableNeoHookean, Volumetric::kPointwise, ElementType::kTet4}, 1e5,
      1e5);
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  const Eigen::VectorXd x = Moved(mirror, body.rest_m());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(x.size());
  EXPECT_NEAR(body.AddForces(x, force), -1.0, 1e-12);
}

TEST(ElasticBody, RefusesAnInvertedCell) {
  TetMesh mesh = CrookedBox(ElementType::kTet4, {1, 1, 1});
  std::swap(mesh.cells(0, 4), mesh.cells(1, 4));
  try {
    TwoRegionBody(mesh, AllLaws().front(), 1e5, 1e5);
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("cell 4 is inverted"));
  }
}

TEST(ElasticBody, RefusesMeanDilatationWhereTheMaterialHasNoVolumetricEnergy) {
  const TetMesh mesh = CrookedBox(ElementType::kTet10, {1, 1, 1});
  for (const MaterialModel model :
       {MaterialModel::kCorotational, MaterialModel::kStVenantKirchhoff}) {
    const Law law{model, Volumetric::kMeanDilatation, ElementType::kTet10};
    EXPECT_THROW(TwoRegionBody(mesh, law, 1e5, 1e5), InputError);
  }
}

TEST(MaterialModel, NamesAreReadBack) {
  for (const std::string& name : MaterialModelNames()) {
    MaterialModel model = MaterialModel::kLinear;
    EXPECT_TRUE(ParseMaterialModel(name, &model));
    EXPECT_EQ(ToString(model), name);
  }
  MaterialModel model = MaterialModel::kNeoHookean;
  EXPECT_FALSE(ParseMaterialModel("rubber", &model));
}

}  // namespace
}  // namespace palpate::fem

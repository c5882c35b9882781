// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/element_derivative.hpp"

#include <gtest/gtest.h>

#include <random>

#include "libs/fem/elastic_body.hpp"
#include "libs/fem/shape_functions.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::fem {
namespace {

struct Law {
  ElementType element;
  MaterialModel model;
  Volumetric volumetric;
};

void PrintTo(const Law& law, std::ostream* out) {
  *out << ToString(law.model) << (law.element == ElementType::kTet4 ? " tet4" : " tet10")
       << (law.volumetric == Volumetric::kPointwise ? "" : " mean");
}

std::vector<Law> AllLaws() {
  std::vector<Law> laws;
  for (const std::string& name : MaterialModelNames()) {
    MaterialModel model;
    EXPECT_TRUE(ParseMaterialModel(name, &model));
    for (const ElementType element : {ElementType::kTet4, ElementType::kTet10}) {
      laws.push_back({element, model, Volumetric::kPointwise});
      if (kernels::SupportsMeanDilatation(model)) {
        laws.push_back({element, model, Volumetric::kMeanDilatation});
      }
    }
  }
  return laws;
}

/// A distorted box in two materials of one law, strained by some tenths.
class ElementDerivativeOf : public testing::TestWithParam<Law> {
 protected:
  ElementDerivativeOf() {
    const Law& law = GetParam();
    mesh_ = BoxMesh({1.0, 0.8, 0.9}, {2, 1, 1});
    if (law.element == ElementType::kTet10) mesh_ = MakeQuadratic(mesh_);
    mesh_.nodes_m.reshaped() += Random(0.02);
    materials_ = {{law.model, law.volumetric, 3.0, 0.4, 0.2, 0.1},
                  {law.model, law.volumetric, 2.0, 0.3, -0.05, 0.3}};
    for (int cell = 0; cell < mesh_.CellCount(); ++cell) material_of_cell_.push_back(cell % 2);
    x_m_ = mesh_.nodes_m.reshaped();
    for (Eigen::Index k = 0; k < x_m_.size(); k += 3) {
      const double x = x_m_[k];
      x_m_[k] = x * 1.1 + 0.2 * x_m_[k + 2];
      x_m_[k + 1] += 0.15 * x * x;
    }
    x_m_ += Random(0.02);
  }

  Eigen::VectorXd Random(double amplitude) {
    Eigen::VectorXd values(mesh_.nodes_m.size());
    for (double& value : values) {
      value = amplitude * (2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.0);
    }
    return values;
  }

  Eigen::VectorXd Forces(const TetMesh& mesh, const Eigen::VectorXd& x_m) const {
    const ElasticBody body(mesh, materials_, material_of_cell_);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(x_m.size());
    EXPECT_GT(body.AddForces(x_m, force), 0.0);
    return force;
  }

  /// Central differences of order 4 of F(p).
  static Eigen::VectorXd Difference(const std::function<Eigen::VectorXd(double)>& F) {
    const double h = 1e-3;
    return (8.0 * (F(h) - F(-h)) - (F(2.0 * h) - F(-2.0 * h))) / (12.0 * h);
  }

  std::mt19937 engine_{3};
  TetMesh mesh_;
  std::vector<Material> materials_;
  std::vector<int> material_of_cell_;
  Eigen::VectorXd x_m_;
};

TEST_P(ElementDerivativeOf, PositionsIsThatOfTheForces) {
  const ElementDerivative derivative(mesh_, material_of_cell_);
  const Eigen::VectorXd along = Random(0.1);
  Eigen::VectorXd slope = Eigen::VectorXd::Ones(x_m_.size());
  derivative.AddAlongPositions(materials_, x_m_, along, -2.0, slope);
  const Eigen::VectorXd expected =
      Difference([&](double by) { return Forces(mesh_, x_m_ + by * along); });
  EXPECT_LE((slope - Eigen::VectorXd::Ones(x_m_.size()) + 2.0 * expected).norm(),
            1e-9 * expected.norm());
}

TEST_P(ElementDerivativeOf, RestShapeIsThatOfTheForces) {
  const ElementDerivative derivative(mesh_, material_of_cell_);
  const Eigen::VectorXd along = Random(0.1);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(x_m_.size());
  derivative.AddAlongRestShape(materials_, x_m_, along, 1.0, slope);
  const Eigen::VectorXd expected = Difference([&](double by) {
    TetMesh moved = mesh_;
    moved.nodes_m.reshaped() += by * along;
    return Forces(moved, x_m_);
  });
  EXPECT_LE((slope - expected).norm(), 1e-9 * expected.norm());
}

TEST_P(ElementDerivativeOf, LameConstantsAddUpToTheForces) {
  const ElementDerivative derivative(mesh_, material_of_cell_);
  Eigen::MatrixXd per_lambda, per_mu;
  derivative.LameForces(materials_, x_m_, &per_lambda, &per_mu);
  const ElasticBody body(mesh_, materials_, material_of_cell_);
  for (int k = 0; k < 2; ++k) {
    Eigen::VectorXd expected = Eigen::VectorXd::Zero(x_m_.size());
    body.AddForcesOfMaterial(k, x_m_, expected);
    const Material& material = materials_[static_cast<size_t>(k)];
    const Eigen::VectorXd sum =
        material.LameLambda_Pa() * per_lambda.col(k) + material.LameMu_Pa() * per_mu.col(k);
    EXPECT_LE((sum - expected).norm(), 1e-12 * expected.norm());
    EXPECT_GT(per_lambda.col(k).norm(), 0.1 * per_mu.col(k).norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, ElementDerivativeOf, testing::ValuesIn(AllLaws()));

using NodalVolume = ElementDerivativeOf;

TEST_P(NodalVolume, FollowsTheRestShape) {
  const ElementDerivative derivative(mesh_, material_of_cell_);
  const Eigen::VectorXd along = Random(0.1);
  const Eigen::VectorXd density = Eigen::VectorXd::Ones(mesh_.CellCount());
  const Eigen::VectorXd expected = Difference([&](double by) {
    TetMesh moved = mesh_;
    moved.nodes_m.reshaped() += by * along;
    return ConsistentNodalMass_kg(moved, density);
  });
  EXPECT_LE((derivative.NodalVolumeAlong(along) - expected).norm(), 1e-9 * expected.norm());
  const Eigen::VectorXd parts = derivative.NodalVolume_m3(0) + derivative.NodalVolume_m3(1);
  EXPECT_LE((parts - derivative.NodalVolume_m3(-1)).norm(), 1e-14);
  EXPECT_GT(derivative.NodalVolume_m3(0).norm(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(
    Elements, NodalVolume,
    testing::Values(Law{ElementType::kTet4, MaterialModel::kLinear, Volumetric::kPointwise},
                    Law{ElementType::kTet10, MaterialModel::kLinear, Volumetric::kPointwise}));

}  // namespace
}  // namespace palpate::fem

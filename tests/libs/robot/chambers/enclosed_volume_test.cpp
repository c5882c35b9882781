// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/enclosed_volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "libs/fem/shape_functions.hpp"
#include "tests/libs/robot/chambers/hollow_bodies.hpp"

namespace palpate::robot {
namespace {

using fem::ElementType;
using fem::EnclosedVolume;

/// Of cells with nodes at `x_m`, by quadrature of det dx/dxi: of degree 3 for tet10.
double CellVolume_m3(const fem::TetMesh& mesh, const Eigen::VectorXd& x_m) {
  const fem::TetQuadrature rule = fem::FineQuadrature();
  double volume_m3 = 0.0;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Matrix3Xd nodes_m(3, mesh.cells.rows());
    for (Eigen::Index k = 0; k < nodes_m.cols(); ++k) {
      nodes_m.col(k) = x_m.segment<3>(3 * mesh.cells(k, cell));
    }
    for (Eigen::Index q = 0; q < rule.weights.size(); ++q) {
      const Eigen::Matrix3d jacobian =
          nodes_m * fem::ShapeGradients(mesh.element_type(), rule.points.col(q)).transpose();
      volume_m3 += rule.weights[q] * jacobian.determinant();
    }
  }
  return volume_m3;
}

class EnclosedVolumeLaws : public testing::TestWithParam<ElementType> {
 protected:
  EnclosedVolumeLaws()
      : shell_(FillShell(1, 3, GetParam()).shell),
        inside_(FillShell(1, 3, GetParam()).inside),
        volume_(CavityWall(shell_)),
        x_m_(Shaken(shell_, 2e-4)) {
    // Somewhere else, so that an origin would be seen.
    for (Eigen::Index k = 0; k < x_m_.size(); k += 3)
      x_m_.segment<3>(k) += Eigen::Vector3d(0.1, -0.2, 0.3);
  }

  Eigen::VectorXd Gradient(const Eigen::VectorXd& x_m) const {
    Eigen::VectorXd nodal = Eigen::VectorXd::Zero(x_m.size());
    volume_.AddGradient(x_m, 1.0, nodal);
    return nodal;
  }

  Eigen::VectorXd RandomMotion() const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Eigen::VectorXd motion(x_m_.size());
    for (double& one : motion) one = uniform(random);
    return motion;
  }

  fem::TetMesh shell_, inside_;
  EnclosedVolume volume_;
  Eigen::VectorXd x_m_;
};

TEST_P(EnclosedVolumeLaws, EqualsTheVolumeOfTheCellsInside) {
  const double cells_m3 = CellVolume_m3(inside_, x_m_);
  EXPECT_NEAR(volume_.Volume_m3(x_m_), cells_m3, 1e-12 * cells_m3);
}

TEST_P(EnclosedVolumeLaws, GradientIsTheDerivativeOfTheVolume) {
  const Eigen::VectorXd motion = RandomMotion();
  const double step_m = 1e-5;  // V is cubic: the central difference is off by its square
  const double difference =
      (volume_.Volume_m3(x_m_ + step_m * motion) - volume_.Volume_m3(x_m_ - step_m * motion)) /
      (2.0 * step_m);
  const double third_m3 = (volume_.Volume_m3(x_m_ + 2.0 * step_m * motion) -
                           volume_.Volume_m3(x_m_ - 2.0 * step_m * motion)) /
                              2.0 -
                          2.0 * step_m * difference;
  const double along = Gradient(x_m_).dot(motion);
  EXPECT_NEAR(difference - third_m3 / (6.0 * step_m), along, 1e-8 * std::abs(along));
}

TEST_P(EnclosedVolumeLaws, CurvatureIsTheDerivativeOfTheGradient) {
  const Eigen::Matrix<bool, 3, Eigen::Dynamic> free =
      Eigen::Matrix<bool, 3, Eigen::Dynamic>::Zero(3, shell_.NodeCount());
  fem::StiffnessMatrix matrix(free, volume_.CoupledPairs());
  volume_.BindTo(matrix);
  matrix.SetZero(0, shell_.NodeCount());
  volume_.AddCurvature(x_m_, 1.0, matrix);
  const Eigen::VectorXd motion = RandomMotion();
  Eigen::VectorXd reduced(matrix.Size());
  matrix.Reduce(motion, reduced);
  Eigen::VectorXd product = Eigen::VectorXd::Zero(motion.size());
  matrix.AddExpanded(matrix.Times(reduced), 1.0, product);
  const double step_m = 1e-3;  // the gradient is quadratic: its central difference is exact
  const Eigen::VectorXd difference =
      (Gradient(x_m_ + step_m * motion) - Gradient(x_m_ - step_m * motion)) / (2.0 * step_m);
  EXPECT_LE((product - difference).norm(), 1e-8 * difference.norm());
}

/// The matrix holds one triangle and is symmetric whatever is added: here both orders are asked.
TEST_P(EnclosedVolumeLaws, TangentIsSymmetric) {
  const Eigen::VectorXd a = RandomMotion();
  const Eigen::VectorXd b = a.reverse();
  const double step_m = 1e-3;
  const auto along = [&](const Eigen::VectorXd& motion) {
    return Eigen::VectorXd((Gradient(x_m_ + step_m * motion) - Gradient(x_m_ - step_m * motion)) /
                           (2.0 * step_m));
  };
  EXPECT_NEAR(b.dot(along(a)), a.dot(along(b)), 1e-10 * along(a).norm() * b.norm());
}

TEST_P(EnclosedVolumeLaws, PressureHasNeitherNetForceNorMoment) {
  const Eigen::VectorXd nodal_m2 = Gradient(x_m_);
  const Eigen::Vector3d middle_m = x_m_.reshaped(3, x_m_.size() / 3).rowwise().mean();
  Eigen::Vector3d force_m2 = Eigen::Vector3d::Zero(), moment_m3 = Eigen::Vector3d::Zero();
  double forces_m2 = 0.0, moments_m3 = 0.0;
  for (Eigen::Index k = 0; k < x_m_.size(); k += 3) {
    const Eigen::Vector3d arm_m = x_m_.segment<3>(k) - middle_m;
    force_m2 += nodal_m2.segment<3>(k);
    moment_m3 += arm_m.cross(nodal_m2.segment<3>(k));
    forces_m2 += nodal_m2.segment<3>(k).norm();
    moments_m3 += arm_m.norm() * nodal_m2.segment<3>(k).norm();
  }
  EXPECT_LE(force_m2.norm(), 1e-12 * forces_m2);
  EXPECT_LE(moment_m3.norm(), 1e-12 * moments_m3);
}

TEST_P(EnclosedVolumeLaws, TurnsWithTheBody) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  const Eigen::VectorXd turned_m = (R * x_m_.reshaped(3, x_m_.size() / 3)).reshaped();
  const Eigen::VectorXd gradient = Gradient(x_m_);
  const Eigen::VectorXd turned_gradient =
      (R * gradient.reshaped(3, gradient.size() / 3)).reshaped();
  EXPECT_NEAR(volume_.Volume_m3(turned_m), volume_.Volume_m3(x_m_),
              1e-13 * volume_.Volume_m3(x_m_));
  EXPECT_LE((Gradient(turned_m) - turned_gradient).norm(), 1e-12 * gradient.norm());
}

INSTANTIATE_TEST_SUITE_P(Elements, EnclosedVolumeLaws,
                         testing::Values(ElementType::kTet4, ElementType::kTet10),
                         [](const auto& of) {
                           return of.param == ElementType::kTet4 ? "Tet4" : "Tet10";
                         });

/// Faces through points on the sphere: chords cut some off, quadratic ones fifty times less.
TEST(EnclosedVolume, CurvedFacesComeNearTheSphere) {
  const double sphere_m3 = 4.0 / 3.0 * std::numbers::pi * std::pow(kInner_m, 3);
  const auto missing = [&](ElementType element, int divisions) {
    const fem::TetMesh shell = SphericalShell(1, divisions, element);
    return 1.0 - EnclosedVolume(CavityWall(shell)).Volume_m3(shell.nodes_m.reshaped()) / sphere_m3;
  };
  EXPECT_LT(missing(ElementType::kTet10, 4), 0.02 * missing(ElementType::kTet4, 4));
  // Halving the faces' size: orders 2 and 4.
  EXPECT_NEAR(missing(ElementType::kTet4, 4) / missing(ElementType::kTet4, 8), 4.0, 0.4);
  EXPECT_GT(missing(ElementType::kTet10, 4) / missing(ElementType::kTet10, 8), 12.0);
}

}  // namespace
}  // namespace palpate::robot

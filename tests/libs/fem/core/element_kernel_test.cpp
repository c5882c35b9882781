// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <vector>

#include "libs/core/instruction_set.hpp"
#include "libs/fem/kernels/instruction_sets.hpp"
#include "libs/fem/shape_functions.hpp"
#include "tests/libs/fem/core/laws.hpp"

namespace palpate::fem::kernels {
namespace {

using laws::AllLaws;
using laws::DerivativeAlong;
using laws::Law;
using laws::RandomVector;
using laws::Rotation;

enum class Set { kPortable, kAvx2, kAvx512 };

Kernel Select(Set set, const Law& law) {
  const int nodes = static_cast<int>(law.element);
  const bool mean = law.volumetric == Volumetric::kMeanDilatation;
#if defined(__x86_64__)
  if (set == Set::kAvx2) return SelectAvx2(nodes, law.model, mean);
  if (set == Set::kAvx512) return SelectAvx512(nodes, law.model, mean);
#endif
  return SelectPortable(nodes, law.model, mean);
}

bool HasCpu(Set set) {
#if defined(__x86_64__)
  if (set == Set::kAvx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (set == Set::kAvx512) return __builtin_cpu_supports("avx512f");
#endif
  return set == Set::kPortable;
}

/// Eight crooked elements with moduli of their own, none sharing a node; lane k's local node a is
/// node k * nodes + a.
struct LaneBlock {
  explicit LaneBlock(ElementType element) : nodes_per_element(static_cast<int>(element)) {
    std::mt19937 engine(5);
    const TetQuadrature rule = StiffnessQuadrature(element);
    const auto points = static_cast<int>(rule.weights.size());
    rest_m.resize(3 * nodes_per_element * kLanes);
    nodes.resize(static_cast<size_t>(nodes_per_element * kLanes));
    gradients.resize(static_cast<size_t>(points * nodes_per_element * 3 * kLanes));
    weights.resize(static_cast<size_t>(points * kLanes));
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::Matrix3Xd rest = RandomElement(element, &engine);
      rest_m.segment(3 * nodes_per_element * lane, 3 * nodes_per_element) = rest.reshaped();
      lambda_Pa[static_cast<size_t>(lane)] = 5e5 + 1e4 * lane;
      mu_Pa[static_cast<size_t>(lane)] = 6e4 - 3e3 * lane;
      c20_over_c10[static_cast<size_t>(lane)] = 0.2 - 0.1 * lane;
      c30_over_c10[static_cast<size_t>(lane)] = 0.3 + 0.02 * lane;
      for (int a = 0; a < nodes_per_element; ++a) {
        nodes[static_cast<size_t>(a * kLanes + lane)] = lane * nodes_per_element + a;
      }
      for (int q = 0; q < points; ++q) {
        const Eigen::Matrix3Xd dN = ShapeGradients(element, rule.points.col(q));
        const Eigen::Matrix3d jacobian = rest * dN.transpose();
        const Eigen::Matrix3Xd G = jacobian.inverse().transpose() * dN;
        for (int k = 0; k < 3 * nodes_per_element; ++k) {
          gradients[static_cast<size_t>((q * 3 * nodes_per_element + k) * kLanes + lane)] =
              G.reshaped()[k];
        }
        weights[static_cast<size_t>(q * kLanes + lane)] = jacobian.determinant() * rule.weights[q];
      }
    }
  }

  static Eigen::Matrix3Xd RandomElement(ElementType element, std::mt19937* engine) {
    Eigen::Matrix3Xd corners = Eigen::Matrix3Xd::Zero(3, 4);
    corners.rightCols<3>().setIdentity();
    corners = 0.01 * corners + Eigen::Matrix3Xd(RandomVector(12, 1e-3, engine).reshaped(3, 4));
    TetMesh mesh{corners, Eigen::Vector4i(0, 1, 2, 3), {}};
    if (element == ElementType::kTet4) return mesh.nodes_m;
    mesh = MakeQuadratic(mesh);
    const Eigen::Matrix3Xd rest = mesh.nodes_m(Eigen::all, mesh.cells.col(0));
    return rest + Eigen::Matrix3Xd(RandomVector(30, 2e-4, engine).reshaped(3, 10));
  }

  /// Every lane turned and stretched alike, and each node moved a little by itself.
  Eigen::VectorXd DeformedPositions() const {
    std::mt19937 engine(9);
    Eigen::Matrix3d F =
        Rotation(1.1, {1.0, -2.0, 0.5}) * Eigen::Vector3d(1.2, 0.9, 1.05).asDiagonal();
    const Eigen::Matrix3Xd moved = F * rest_m.reshaped(3, rest_m.size() / 3);
    return moved.reshaped() + RandomVector(rest_m.size(), 3e-4, &engine);
  }

  Block View() const {
    return {nodes.data(), gradients.data(),    weights.data(),     lambda_Pa.data(),
            mu_Pa.data(), c20_over_c10.data(), c30_over_c10.data()};
  }

  int nodes_per_element;
  Eigen::VectorXd rest_m;
  std::vector<int> nodes;
  std::vector<double> gradients, weights;
  std::array<double, kLanes> lambda_Pa{}, mu_Pa{}, c20_over_c10{}, c30_over_c10{};
};

/// What each lane gives, one column for each; the stiffness pair by pair, column by column.
struct Evaluation {
  Eigen::MatrixXd force;      // [3 nodes x lanes]
  Eigen::MatrixXd stiffness;  // [9 pairs x lanes]
  Eigen::VectorXd energy, min_J;
};

Evaluation Evaluate(Kernel kernel, const LaneBlock& block, const Eigen::VectorXd& x_m) {
  const int nodes = block.nodes_per_element;
  const int pairs = PairCount(nodes);
  Eigen::MatrixXd force_rows = Eigen::MatrixXd::Zero(4, nodes * kLanes);
  Evaluation value{{},
                   Eigen::MatrixXd::Zero(9 * pairs, kLanes),
                   Eigen::VectorXd::Zero(kLanes),
                   Eigen::VectorXd::Zero(kLanes)};
  std::vector<int> addresses;
  for (int pair = 0; pair < pairs; ++pair) {
    for (int lane = 0; lane < kLanes; ++lane) addresses.push_back(9 * (lane * pairs + pair));
  }
  kernel(block.View(), x_m.data(),
         {.force = force_rows.data(),
          .force_rows = block.nodes.data(),
          .stiffness = value.stiffness.data(),
          .addresses = addresses.data(),
          .energy = value.energy.data(),
          .min_J = value.min_J.data()});
  EXPECT_TRUE((force_rows.row(3).array() == 0.0).all());
  value.force = force_rows.topRows<3>().reshaped(3 * nodes, kLanes);
  return value;
}

/// The tangent of one lane, whole, from its lower pairs.
Eigen::MatrixXd Tangent(const Evaluation& value, int nodes, int lane) {
  Eigen::MatrixXd K(3 * nodes, 3 * nodes);
  for (int a = 0; a < nodes; ++a) {
    for (int b = 0; b <= a; ++b) {
      const Eigen::Matrix3d block =
          value.stiffness.col(lane).segment<9>(9 * PairIndex(a, b, nodes)).reshaped(3, 3);
      K.block<3, 3>(3 * b, 3 * a) = block.transpose();
      K.block<3, 3>(3 * a, 3 * b) = block;
    }
  }
  return K;
}

using Parameters = std::tuple<Law, Set>;

class ElementKernel : public ::testing::TestWithParam<Parameters> {
 protected:
  void SetUp() override {
    if (!HasCpu(std::get<Set>(GetParam()))) GTEST_SKIP() << "not on this processor";
    kernel_ = Select(std::get<Set>(GetParam()), std::get<Law>(GetParam()));
  }

  /// Moves local direction `dof` of every lane at once.
  Eigen::VectorXd Direction(int dof) const {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(block_.rest_m.size());
    for (int lane = 0; lane < kLanes; ++lane) {
      direction[3 * block_.nodes_per_element * lane + dof] = 1.0;
    }
    return direction;
  }

  Kernel kernel_ = nullptr;
  LaneBlock block_{std::get<Law>(GetParam()).element};
  Eigen::VectorXd x_m_ = block_.DeformedPositions();
};

TEST_P(ElementKernel, ForceIsTheDerivativeOfTheEnergy) {
  const Evaluation here = Evaluate(kernel_, block_, x_m_);
  const auto energy = [&](const Eigen::VectorXd& x) { return Evaluate(kernel_, block_, x).energy; };
  for (int dof = 0; dof < 3 * block_.nodes_per_element; ++dof) {
    const Eigen::VectorXd expected = DerivativeAlong(energy, x_m_, Direction(dof), 2e-6);
    EXPECT_LE((here.force.row(dof).transpose() - expected).cwiseAbs().maxCoeff(),
              1e-8 * here.force.cwiseAbs().maxCoeff());
  }
}

TEST_P(ElementKernel, TangentIsTheDerivativeOfTheForceAndSymmetric) {
  const Evaluation here = Evaluate(kernel_, block_, x_m_);
  const int dofs = 3 * block_.nodes_per_element;
  const auto force = [&](const Eigen::VectorXd& x) { return Evaluate(kernel_, block_, x).force; };
  std::array<Eigen::MatrixXd, kLanes> expected;
  expected.fill(Eigen::MatrixXd(dofs, dofs));
  for (int dof = 0; dof < dofs; ++dof) {
    const Eigen::MatrixXd column = DerivativeAlong(force, x_m_, Direction(dof), 5e-6);
    for (int lane = 0; lane < kLanes; ++lane) {
      expected[static_cast<size_t>(lane)].col(dof) = column.col(lane);
    }
  }
  for (int lane = 0; lane < kLanes; ++lane) {
    const Eigen::MatrixXd K = Tangent(here, block_.nodes_per_element, lane);
    const double scale = K.cwiseAbs().maxCoeff();
    EXPECT_LE((K - expected[static_cast<size_t>(lane)]).cwiseAbs().maxCoeff(), 1e-8 * scale);
    EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-13 * scale);
  }
}

TEST_P(ElementKernel, GivesEachResultAloneAsTogether) {
  const Evaluation together = Evaluate(kernel_, block_, x_m_);
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(4, block_.nodes_per_element * kLanes);
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(kLanes);
  kernel_(block_.View(), x_m_.data(), {.force = force.data(), .force_rows = block_.nodes.data()});
  kernel_(block_.View(), x_m_.data(), {.energy = energy.data()});
  EXPECT_EQ(force.topRows<3>().reshaped(together.force.rows(), kLanes), together.force);
  EXPECT_EQ(energy, together.energy);
}

TEST_P(ElementKernel, ALaneDoesNotDependOnTheOthers) {
  const Evaluation here = Evaluate(kernel_, block_, x_m_);
  LaneBlock turned = block_;  // every lane's element moves on by one lane
  std::rotate(turned.lambda_Pa.begin(), turned.lambda_Pa.begin() + 1, turned.lambda_Pa.end());
  std::rotate(turned.mu_Pa.begin(), turned.mu_Pa.begin() + 1, turned.mu_Pa.end());
  std::rotate(turned.c20_over_c10.begin(), turned.c20_over_c10.begin() + 1,
              turned.c20_over_c10.end());
  std::rotate(turned.c30_over_c10.begin(), turned.c30_over_c10.begin() + 1,
              turned.c30_over_c10.end());
  for (auto* packs : {&turned.gradients, &turned.weights}) {
    for (auto pack = packs->begin(); pack != packs->end(); pack += kLanes) {
      std::rotate(pack, pack + 1, pack + kLanes);
    }
  }
  Eigen::VectorXd x_m = x_m_;
  const Eigen::Index dofs = 3 * block_.nodes_per_element;
  std::rotate(x_m.begin(), x_m.begin() + dofs, x_m.end());
  // One far stretched element keeps iterations going for longer.
  x_m.segment(dofs * 3, dofs) *= 3.0;
  const Evaluation there = Evaluate(kernel_, turned, x_m);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (lane == 3) continue;
    const int before = (lane + 1) % kLanes;
    EXPECT_EQ(there.force.col(lane), here.force.col(before)) << lane;
    EXPECT_EQ(there.stiffness.col(lane), here.stiffness.col(before)) << lane;
    EXPECT_EQ(there.energy[lane], here.energy[before]) << lane;
  }
}

TEST_P(ElementKernel, AddsAndLeavesOutWhatHasNoPlace) {
  const Evaluation here = Evaluate(kernel_, block_, x_m_);
  const int pairs = PairCount(block_.nodes_per_element);
  std::vector<int> addresses(static_cast<size_t>(pairs * kLanes), -1);
  const int pair = pairs - 2;
  addresses[static_cast<size_t>(pair * kLanes + 5)] = 4;
  addresses[static_cast<size_t>(pair * kLanes + 6)] = 4;
  Eigen::VectorXd values = Eigen::VectorXd::Constant(20, 7.0);
  kernel_(block_.View(), x_m_.data(), {.stiffness = values.data(), .addresses = addresses.data()});
  const Eigen::VectorXd expected =
      here.stiffness.col(5).segment<9>(9 * pair) + here.stiffness.col(6).segment<9>(9 * pair);
  EXPECT_LE((values.segment<9>(4).array() - 7.0 - expected.array()).abs().maxCoeff(),
            1e-13 * (7.0 + expected.cwiseAbs().maxCoeff()));
  EXPECT_TRUE((values.head<4>().array() == 7.0).all());
  EXPECT_TRUE((values.tail<7>().array() == 7.0).all());
}

TEST_P(ElementKernel, AgreesWithTheOtherInstructionSets) {
  const Evaluation here = Evaluate(kernel_, block_, x_m_);
  const Evaluation portable =
      Evaluate(Select(Set::kPortable, std::get<Law>(GetParam())), block_, x_m_);
  const auto expect_equal = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LE((a - b).cwiseAbs().maxCoeff(), 1e-12 * b.cwiseAbs().maxCoeff());
  };
  expect_equal(here.force, portable.force);
  expect_equal(here.stiffness, portable.stiffness);
  expect_equal(here.energy, portable.energy);
  expect_equal(here.min_J, portable.min_J);
}

std::string ParameterName(const ::testing::TestParamInfo<Parameters>& info) {
  constexpr std::array<const char*, 3> kSets{"portable", "avx2", "avx512"};
  return laws::Name(std::get<Law>(info.param)) + "_" +
         kSets[static_cast<size_t>(std::get<Set>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(AllLaws, ElementKernel,
                         ::testing::Combine(::testing::ValuesIn(AllLaws()),
                                            ::testing::Values(Set::kPortable, Set::kAvx2,
                                                              Set::kAvx512)),
                         ParameterName);

TEST(SelectKernel, UsesTheWidestInstructionSetOfTheProcessor) {
  const Set widest = HasCpu(Set::kAvx512) ? Set::kAvx512
                     : HasCpu(Set::kAvx2) ? Set::kAvx2
                                          : Set::kPortable;
  for (const Law& law : AllLaws()) {
    EXPECT_EQ(SelectKernel(static_cast<int>(law.element), law.model, law.volumetric),
              Select(widest, law));
  }
  constexpr std::array<const char*, 3> kNames{"portable", "avx2", "avx512"};
  EXPECT_STREQ(InstructionSet(), kNames[static_cast<size_t>(widest)]);
}

}  // namespace
}  // namespace palpate::fem::kernels

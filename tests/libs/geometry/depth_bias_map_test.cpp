// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/depth_bias_map.hpp"

#include <gtest/gtest.h>

namespace palpate::geometry {
namespace {

TEST(DepthBiasBasis, HoldsAllMonomialsByDegreeThoseOfXFirst) {
  const DepthBiasBasis cubic{.order = 3, .span = 0.25};
  EXPECT_EQ(CountOf(cubic), 10);
  EXPECT_EQ(NamesOf(cubic), (std::vector<std::string>{
                                "depth_scale", "depth_bias:x", "depth_bias:y", "depth_bias:xx",
                                "depth_bias:xy", "depth_bias:yy", "depth_bias:xxx",
                                "depth_bias:xxy", "depth_bias:xyy", "depth_bias:yyy"}));
  // x / (z span) = 2, y / (z span) = 3
  Eigen::VectorXd expected(10);
  expected << 1, 2, 3, 4, 6, 9, 8, 12, 18, 27;
  EXPECT_LE((ValuesAt(cubic, {0.2, 0.3, 0.4}) - expected).norm(), 1e-12);
}

TEST(DepthBiasBasis, OfOrderZeroIsTheConstant) {
  EXPECT_EQ(ValuesAt({.order = 0}, {0.1, -0.2, 0.4}), Eigen::VectorXd::Ones(1));
}

TEST(DepthBiasMap, IsTheSumOfItsMonomials) {
  const DepthBiasMap map{.basis = {.order = 1, .span = 0.5},
                         .coefficients = Eigen::Vector3d(1e-3, 2e-3, -3e-3),
                         .covariance = {}};
  EXPECT_NEAR(map.At({0.1, 0.05, 0.4}), 1e-3 + 2e-3 * 0.5 - 3e-3 * 0.25, 1e-15);
}

}  // namespace
}  // namespace palpate::geometry

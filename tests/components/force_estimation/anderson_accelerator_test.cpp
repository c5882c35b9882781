// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/fit/anderson_accelerator.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace palpate::force_estimation {
namespace {

constexpr Eigen::Index kNodes3 = 12;

/// Steps towards a solution that are wrong along two directions, as those with the factor of
/// another shape.
class WrongSteps {
 public:
  WrongSteps() : matrix_(Eigen::MatrixXd::Identity(kNodes3, kNodes3)) {
    const double wrong[2] = {0.5, -0.4};
    for (int k = 0; k < 2; ++k) {
      Eigen::VectorXd direction(kNodes3);
      for (Eigen::Index i = 0; i < kNodes3; ++i) {
        direction[i] = std::cos(static_cast<double>((k + 1) * (i + 1)));
      }
      direction.normalize();
      matrix_ -= wrong[k] * direction * direction.transpose();
    }
  }

  /// Distance to `solution` after each of so many steps from `start`.
  std::vector<double> Run(const Eigen::VectorXd& start, const Eigen::VectorXd& solution, int steps,
                          AndersonAccelerator* memory) const {
    std::vector<double> errors;
    FitVariables at{start, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(3)};
    FitVariables step = at;
    FitVariables correction;
    if (memory != nullptr) memory->BeginFit();
    for (int k = 0; k < steps; ++k) {
      step.x_m = matrix_ * (solution - at.x_m);
      const bool improved = memory != nullptr && memory->Correct(at, step, &correction);
      at.x_m += step.x_m;
      if (improved) at.x_m += correction.x_m;
      errors.push_back((at.x_m - solution).norm());
    }
    return errors;
  }

 private:
  Eigen::MatrixXd matrix_;
};

class SecantMemoryTest : public testing::Test {
 protected:
  SecantMemoryTest() { memory_.SetUp(kNodes3, 1, 3); }

  WrongSteps steps_;
  AndersonAccelerator memory_;
  const Eigen::VectorXd start_ = Eigen::VectorXd::Zero(kNodes3);
  const Eigen::VectorXd solution_ = Eigen::VectorXd::LinSpaced(kNodes3, 1.0, 2.0);
};

TEST_F(SecantMemoryTest, AsManyStepsAsDirectionsAreWrongLeadToTheSolution) {
  EXPECT_LT(steps_.Run(start_, solution_, 5, &memory_).back(), 1e-6);
  EXPECT_GT(steps_.Run(start_, solution_, 5, nullptr).back(), 5e-3);
}

TEST_F(SecantMemoryTest, ServesFitsToOtherTargets) {
  steps_.Run(start_, solution_, 5, &memory_);
  const Eigen::VectorXd other = 1.5 * solution_.reverse();
  EXPECT_LT(steps_.Run(solution_, other, 1, &memory_).front(), 1e-5);
}

TEST_F(SecantMemoryTest, KnowsNothingOfAnotherFactor) {
  steps_.Run(start_, solution_, 5, &memory_);
  memory_.Forget();
  EXPECT_EQ(steps_.Run(start_, solution_, 1, &memory_), steps_.Run(start_, solution_, 1, nullptr));
}

TEST_F(SecantMemoryTest, DoesNotCompareStepsTowardsDifferentTargets) {
  steps_.Run(start_, solution_, 1, &memory_);
  steps_.Run(start_, 3.0 * solution_, 1, &memory_);
  EXPECT_EQ(memory_.count(), 0);
}

}  // namespace
}  // namespace palpate::force_estimation

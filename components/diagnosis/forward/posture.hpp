// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <optional>

#include "components/diagnosis/forward/simulation.hpp"
#include "libs/robot/robot_body.hpp"

namespace palpate::diagnosis {

/// How many smooth functions of posture there are. More follow finer errors, and cost a column for
/// each direction in which bodies and cables err.
struct PostureTuning {
  Eigen::Index most_shapes = 4;      ///< leading shapes of the body that make up its posture
  double least_shape = 0.02;         ///< of the largest; smaller ones are left out
  Eigen::Index most_functions = 12;  ///< of posture
  double least_function = 0.02;      ///< RMS, of the largest
};

/// Smooth functions of a body's posture: linear and quadratic in the leading shapes in which an
/// experiment bends it, orthogonal over its samples and of mean 0 there (Karhunen-Loeve). The
/// squares of their RMS add up to 1.
class PostureFunctions {
 public:
  Eigen::Index count() const { return weights_.cols(); }
  /// [count] of a body with its nodes at `x_m` [3n].
  Eigen::VectorXd At(const Eigen::VectorXd& x_m) const;

 private:
  friend std::optional<PostureFunctions> FunctionsOfPosture(const robot::RobotBody&,
                                                            const Simulation&,
                                                            const PostureTuning&);
  Eigen::VectorXd Monomials(const Eigen::VectorXd& x_m) const;

  Eigen::VectorXd mean_m_;   ///< [3n] over the samples
  Eigen::MatrixXd shapes_;   ///< [3n x shapes] such that coordinates have at most RMS 1
  Eigen::VectorXd centre_;   ///< [monomials] their mean over the samples
  Eigen::MatrixXd weights_;  ///< [monomials x functions]
};

/// Of the samples of `simulated` that did not fail; nothing where the body stays as it is.
std::optional<PostureFunctions> FunctionsOfPosture(const robot::RobotBody& body,
                                                   const Simulation& simulated,
                                                   const PostureTuning& tuning = {});

}  // namespace palpate::diagnosis

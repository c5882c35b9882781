// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>

namespace palpate::force_estimation {

/// What is moved by a fit's steps: nodes [3n], cable forces [a] and contact forces [f].
struct FitVariables {
  Eigen::VectorXd x_m;
  Eigen::VectorXd lambda_a_N;
  Eigen::VectorXd lambda_f_N;
};

/// What steps with one factor tell of how wrong that factor is: steps that change from place to
/// place otherwise than Newton's would. A fit's next step is set right by what a least-squares
/// secant makes of the last ones (Anderson, J. ACM 12 (1965) 547), also by those of earlier fits:
/// a body that bends is misjudged along a few soft modes, the same from frame to frame. After
/// SetUp nothing is allocated.
class AndersonAccelerator {
 public:
  static constexpr int kDepth = 4;

  /// Room for nodes, cables and contact forces of this size; empties the memory.
  void SetUp(Eigen::Index nodes3, Eigen::Index cables, Eigen::Index forces);
  /// The factor is another.
  void Forget() {
    count_ = next_ = 0;
    has_last_ = false;
  }
  /// The targets are others: the next step cannot be compared with the last, but those known so far
  /// still hold.
  void BeginFit() { has_last_ = false; }

  /// `step`, of the whole length, was computed at `at`. False where nothing is known to add to it.
  bool Improve(const FitVariables& at, const FitVariables& step, FitVariables* correction);

  int count() const { return count_; }

 private:
  void Learn(const FitVariables& at, const FitVariables& step);

  struct Pair {
    FitVariables moved;    ///< between two places,
    FitVariables changed;  ///< and how the step changed
  };
  std::array<Pair, kDepth> pairs_;
  Eigen::Matrix<double, kDepth, kDepth> gram_;  ///< of Pair::changed.x_m, m^2
  int count_ = 0;
  int next_ = 0;
  bool has_last_ = false;
  FitVariables last_at_, last_step_;
};

}  // namespace palpate::force_estimation

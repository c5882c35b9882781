// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>

namespace palpate::force_estimation {

/// Variables of a fit: nodes [3n], cable tensions [a] and contact forces [f].
struct FitVariables {
  Eigen::VectorXd x_m;
  Eigen::VectorXd lambda_a_N;
  Eigen::VectorXd lambda_f_N;
};

/// Anderson acceleration (J. ACM 12 (1965) 547) of Newton steps with a frozen factor: a
/// least-squares secant of the last steps corrects the next one for the factor's error. Pairs of
/// earlier fits are kept, because the factor of a bending body errs along a few soft modes, which
/// are the same from frame to frame. After SetUp nothing is allocated.
class AndersonAccelerator {
 public:
  /// Pairs that are kept. More correct more modes, at a dot product of size 3n each.
  static constexpr int kDepth = 4;

  /// Allocates for this many node coordinates, cables and contact force components; no pairs are
  /// left.
  void SetUp(Eigen::Index nodes3, Eigen::Index cables, Eigen::Index forces);
  /// To be called with a new factor.
  void Forget() {
    count_ = next_ = 0;
    has_last_ = false;
  }
  /// To be called with new targets: the next step cannot be paired with the last, but the pairs so
  /// far still hold.
  void BeginFit() { has_last_ = false; }

  /// Computes what to add to `step`, the full Newton step from `at`. False: nothing.
  bool Correct(const FitVariables& at, const FitVariables& step, FitVariables* correction);

  int count() const { return count_; }

 private:
  void AddPair(const FitVariables& at, const FitVariables& step);

  struct Pair {
    FitVariables moved;    ///< difference of two iterates
    FitVariables changed;  ///< difference of their steps
  };
  std::array<Pair, kDepth> pairs_;
  Eigen::Matrix<double, kDepth, kDepth> gram_;  ///< of Pair::changed.x_m, m^2
  int count_ = 0;
  int next_ = 0;
  bool has_last_ = false;
  FitVariables last_at_, last_step_;
};

}  // namespace palpate::force_estimation

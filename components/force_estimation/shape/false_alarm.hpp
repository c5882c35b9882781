// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>

namespace palpate::force_estimation {

/// Chance that a standard normal variable exceeds `t`.
double NormalTail(double t);

struct FalseAlarmTuning {
  Eigen::Index draws = 256;  ///< more: a more exact chance; time grows in proportion
  /// Iterations of the threshold, each a chance. Few are enough, as the number of independent tests
  /// hardly depends on it.
  int threshold_rounds = 4;
};

/// Chance that noise alone makes the largest of many one-sided tests exceed a threshold. The tests
/// are the columns of `directions` [m x c], unit vectors u_j, with the statistics u_j . y for y of
/// independent standard normal entries: correlated, so that Bonferroni's c tests count as fewer.
class FalseAlarm {
 public:
  explicit FalseAlarm(const FalseAlarmTuning& tuning = {}) : tuning_(tuning) {}

  /// P(max_j u_j . y > t), relative error about 5 % at any t. Each draw puts one test, all in turn,
  /// above t and counts how many others follow: P = c P(u_1 . y > t) E[1 / count] (Naiman and
  /// Priebe, Annals of Statistics 29 (2001) 1041-1066). The draws are always the same.
  double Chance(const Eigen::MatrixXd& directions, double t);

  /// The t whose chance is `significance`; sigmas, between those of one test and of c independent.
  double Threshold(const Eigen::MatrixXd& directions, double significance);

  /// Whether Chance < significance, computed only where the bounds leave it open.
  bool Significant(const Eigen::MatrixXd& directions, double t, double significance);

 private:
  void Draw(Eigen::Index rows);

  FalseAlarmTuning tuning_;
  Eigen::MatrixXf noise_;  ///< [rows x draws] standard normal
};

}  // namespace palpate::force_estimation

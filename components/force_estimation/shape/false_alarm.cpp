// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/false_alarm.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "libs/core/statistics.hpp"

namespace palpate::force_estimation {

namespace {

constexpr std::uint32_t kSeed = 20261121;
/// Smallest argument of NormalQuantile.
constexpr double kSmallestTail = 1e-280;

double TailQuantile(double chance) { return -NormalQuantile(std::max(chance, kSmallestTail)); }

/// The k-th of numbers in (0, 1) that fill it evenly.
double EvenlySpread(Eigen::Index k) {
  const double turns = 0.5 + (std::numbers::phi - 1.0) * static_cast<double>(k);
  return std::clamp(turns - std::floor(turns), 1e-6, 1.0 - 1e-6);
}

}  // namespace

double NormalTail(double t) { return 0.5 * std::erfc(t / std::numbers::sqrt2); }

/// Box and Muller's transform, so that the draws are the same with every standard library.
void FalseAlarm::Draw(Eigen::Index rows) {
  noise_.resize(rows, tuning_.draws);
  std::mt19937 engine(kSeed);
  const auto uniform = [&engine] { return (static_cast<double>(engine()) + 0.5) / 4294967296.0; };
  for (float& value : noise_.reshaped()) {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    value = static_cast<float>(radius * std::cos(2.0 * std::numbers::pi * uniform()));
  }
}

double FalseAlarm::Chance(const Eigen::MatrixXd& directions, double t) {
  const Eigen::Index tests = directions.cols();
  if (tests == 0) return 0.0;
  if (noise_.rows() != directions.rows()) Draw(directions.rows());
  const Eigen::MatrixXf unit = directions.cast<float>();
  const double tail = NormalTail(t);
  Eigen::MatrixXf drawn = noise_;
  for (Eigen::Index k = 0; k < tuning_.draws; ++k) {
    const auto chosen = unit.col(k * tests / tuning_.draws);
    const double value = std::max(t, TailQuantile(tail * EvenlySpread(k)));
    drawn.col(k) += (static_cast<float>(value) - chosen.dot(drawn.col(k))) * chosen;
  }
  const Eigen::MatrixXf statistic = unit.transpose() * drawn;
  const auto exceeding = (statistic.array() >= static_cast<float>(t)).cast<float>().colwise().sum();
  const double independent_share =
      static_cast<double>(exceeding.max(1.0f).inverse().mean()) * static_cast<double>(tests);
  return std::min(1.0, independent_share * tail);
}

double FalseAlarm::Threshold(const Eigen::MatrixXd& directions, double significance) {
  double t = TailQuantile(significance);
  for (int round = 0; round < tuning_.threshold_rounds && directions.cols() > 1; ++round) {
    const double tests = std::max(1.0, Chance(directions, t) / NormalTail(t));
    t = TailQuantile(significance / tests);
  }
  return t;
}

bool FalseAlarm::Significant(const Eigen::MatrixXd& directions, double t, double significance) {
  const double one = NormalTail(t);
  if (one >= significance) return false;
  if (one * static_cast<double>(directions.cols()) < significance) return true;
  return Chance(directions, t) < significance;
}

}  // namespace palpate::force_estimation

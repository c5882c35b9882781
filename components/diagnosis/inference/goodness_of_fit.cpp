// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/goodness_of_fit.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/linalg/product.hpp"
#include "libs/linalg/qr.hpp"

namespace palpate::diagnosis {

namespace {

/// More false alarms detect smaller unmodelled causes.
struct GoodnessOfFitTuning {
  double least_excess = 0.15;  ///< of the noise's chi-squared; less may be mesh error
  double false_alarms = 0.02;  ///< of right models that fail (bootstrap quantile)
  std::size_t nearest = 2;     ///< neighbours of a point in Moran's I
};
constexpr GoodnessOfFitTuning kGoodnessOfFitTuning;

/// Markers beside each other on the undeformed body: each with those nearest to it.
std::set<std::pair<Eigen::Index, Eigen::Index>> Neighbours(const Eigen::Matrix3Xd& rest_m) {
  std::set<std::pair<Eigen::Index, Eigen::Index>> neighbours;
  for (Eigen::Index m = 0; m < rest_m.cols(); ++m) {
    std::vector<std::pair<double, Eigen::Index>> others;
    for (Eigen::Index other = 0; other < rest_m.cols(); ++other) {
      if (other != m) others.emplace_back((rest_m.col(other) - rest_m.col(m)).norm(), other);
    }
    std::sort(others.begin(), others.end());
    for (std::size_t k = 0; k < std::min(kGoodnessOfFitTuning.nearest, others.size()); ++k) {
      neighbours.emplace(std::min(m, others[k].second), std::max(m, others[k].second));
    }
  }
  return neighbours;
}

/// An orthonormal basis of the columns, each less its mean; columns that do not change drop out.
Eigen::MatrixXd Directions(Eigen::MatrixXd columns) {
  constexpr double kSame = 1e-6;  // m, N or per s; and of the largest
  const Eigen::MatrixXd none(columns.rows(), 0);
  if (columns.size() == 0) return none;
  columns.rowwise() -= columns.colwise().mean().eval();
  const double largest = columns.cwiseAbs().maxCoeff();
  if (!(largest > kSame)) return none;
  return linalg::OrthonormalBasis(columns / largest, kSame);
}

/// [tests x draws] what experiments of the fitted model give, whose parameters differ from it by
/// `sigma`.
Eigen::MatrixXd DrawStatistics(const ResidualStatistics& statistics, const Eigen::VectorXd& sigma,
                               const Fit& fit, int draws, std::uint64_t seed) {
  constexpr int kAtOnce = 50;  // memory
  const LinearModel& model = fit.model;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return normal(random); };
  Eigen::MatrixXd drawn(statistics.count(), draws);
  for (int first = 0; first < draws; first += kAtOnce) {
    const int count = std::min(kAtOnce, draws - first);
    Eigen::MatrixXd z(sigma.size(), count);
    Eigen::MatrixXd noise(model.y.size(), count);
    for (int d = 0; d < count; ++d) {
      z.col(d) = Eigen::VectorXd::NullaryExpr(z.rows(), draw).cwiseProduct(sigma);
      noise.col(d) = Eigen::VectorXd::NullaryExpr(noise.rows(), draw);
    }
    // The residual of the posterior mean is linear in what is measured.
    const Eigen::MatrixXd off = linalg::Product(model.J, z) + noise;
    const Eigen::MatrixXd mean =
        linalg::Product(fit.posterior.covariance, linalg::TransposedProduct(model.J, off));
    const Eigen::MatrixXd residual = off - linalg::Product(model.J, mean);
    for (int d = 0; d < count; ++d) drawn.col(first + d) = statistics.Of(residual.col(d));
  }
  return drawn;
}

}  // namespace

ResidualStatistics::ResidualStatistics(const ObservedExperiment& observed,
                                       const Eigen::Matrix3Xd& rest_m, const LinearModel& model) {
  for (const ObservedRecording& recording : observed.recordings) {
    recordings_.push_back({.name = recording.name, .rows = {}, .in_time = {}, .on_body = {}});
  }
  PairInTime(observed, model);
  PairOnBody(rest_m, observed, model);
  CutIntoSeries(observed, model);
}

void ResidualStatistics::PairInTime(const ObservedExperiment& observed, const LinearModel& model) {
  for (Eigen::Index row = 0; row < model.y.size(); ++row) {
    const auto k = static_cast<std::size_t>(row);
    const auto sample = static_cast<std::size_t>(model.sample_of_row[k]);
    Recording& recording = recordings_[At(observed.samples[sample].recording)];
    recording.rows.push_back(row);
    const bool follows = row > 0 && model.coordinate_of_row[k] == model.coordinate_of_row[k - 1] &&
                         model.sample_of_row[k] == model.sample_of_row[k - 1] + 1;
    if (follows) recording.in_time.push_back({row, row - 1, 1.0});
  }
}

/// As many products as there are markers: with more neighbours each counts less.
void ResidualStatistics::PairOnBody(const Eigen::Matrix3Xd& rest_m,
                                    const ObservedExperiment& observed, const LinearModel& model) {
  const Eigen::Index features = observed.feature_rest_m.cols();
  if (rest_m.cols() < 2 && features < 2) return;  // nothing is beside anything
  constexpr Eigen::Index kNotSeen = -1;
  Eigen::Matrix<Eigen::Index, Eigen::Dynamic, Eigen::Dynamic> row_of(3 * rest_m.cols() + features,
                                                                     std::ssize(observed.samples));
  row_of.setConstant(kNotSeen);
  for (Eigen::Index row = 0; row < model.y.size(); ++row) {
    const auto k = static_cast<std::size_t>(row);
    row_of(model.coordinate_of_row[k], model.sample_of_row[k]) = row;
  }
  const auto pair = [&](const Eigen::Matrix3Xd& places_m, Eigen::Index first, Eigen::Index axes) {
    const auto neighbours = Neighbours(places_m);
    const double weight =
        static_cast<double>(places_m.cols()) / static_cast<double>(neighbours.size());
    for (Eigen::Index s = 0; s < row_of.cols(); ++s) {
      const int recording = observed.samples[At(s)].recording;
      for (const auto& [one, other] : neighbours) {
        for (Eigen::Index axis = 0; axis < axes; ++axis) {
          const Eigen::Index row = row_of(first + axes * one + axis, s);
          const Eigen::Index beside = row_of(first + axes * other + axis, s);
          if (row == kNotSeen || beside == kNotSeen) continue;
          recordings_[At(recording)].on_body.push_back({row, beside, weight});
        }
      }
    }
  };
  pair(rest_m, 0, 3);
  pair(observed.feature_rest_m, 3 * rest_m.cols(), 1);
}

void ResidualStatistics::CutIntoSeries(const ObservedExperiment& observed,
                                       const LinearModel& model) {
  constexpr double kMoment_s = 0.05;
  const auto sample_of = [&](Eigen::Index row) -> const Sample& {
    const int sample = model.sample_of_row[At(row)];
    return observed.samples[At(sample)];
  };
  const auto coordinate_of = [&](Eigen::Index row) { return model.coordinate_of_row[At(row)]; };
  const auto taken_in = [&](double t_s) -> Eigen::VectorXd {
    if (observed.timeline.actuators.empty()) return {};
    const Eigen::VectorXd command = observed.timeline.CommandAt(t_s);
    return command.array().isNaN().select(0.0, command);
  };
  const auto cables = std::ssize(observed.timeline.actuators);
  for (Eigen::Index first = 0, end = 0; first < model.y.size(); first = end) {
    const int recording = sample_of(first).recording;
    while (end < model.y.size() && sample_of(end).recording == recording &&
           coordinate_of(end) == coordinate_of(first)) {
      ++end;
    }
    Eigen::MatrixXd commands(end - first, cables);
    Eigen::MatrixXd rates(end - first, cables);
    for (Eigen::Index row = first; row < end; ++row) {
      const double t_s = sample_of(row).t_s;
      commands.row(row - first) = taken_in(t_s).transpose();
      rates.row(row - first) =
          (taken_in(t_s + kMoment_s) - taken_in(t_s - kMoment_s)).transpose() / (2.0 * kMoment_s);
    }
    series_.push_back({recording, first, Directions(commands), Directions(rates)});
  }
}

Eigen::VectorXd ResidualStatistics::Of(const Eigen::VectorXd& residual) const {
  Eigen::VectorXd tests = Eigen::VectorXd::Zero(count());
  tests[0] = residual.squaredNorm();
  const auto products = [&](const std::vector<Pair>& pairs) {
    double sum = 0.0;
    for (const Pair& pair : pairs) sum += pair.weight * residual[pair.one] * residual[pair.other];
    return sum;
  };
  for (Eigen::Index r = 0; r < std::ssize(recordings_); ++r) {
    const Recording& recording = recordings_[At(r)];
    tests[IndexOf(kMisfit, r)] = residual(recording.rows).squaredNorm();
    tests[IndexOf(kRuns, r)] = products(recording.in_time);
    tests[IndexOf(kNeighbours, r)] = products(recording.on_body);
  }
  for (const Series& series : series_) {
    const auto own = residual.segment(series.first_row, series.commands.rows());
    tests[IndexOf(kCommands, series.recording)] +=
        (series.commands.transpose() * own).squaredNorm();
    tests[IndexOf(kRates, series.recording)] += (series.rates.transpose() * own).squaredNorm();
  }
  return tests;
}

std::string ResidualStatistics::NameOf(Eigen::Index test) const {
  if (test == 0) return "misfit of all recordings";
  const char* const kinds[] = {"misfit of", "runs in", "pattern over the body in",
                               "residual along with the commands in",
                               "residual along with how fast the commands change in"};
  const auto recordings = std::ssize(recordings_);
  return std::string(kinds[(test - 1) / recordings]) + " recording " +
         recordings_[At((test - 1) % recordings)].name;
}

Eigen::Index ResidualStatistics::MisfitBeside(Eigen::Index test) const {
  return test == 0 ? 0 : IndexOf(kMisfit, (test - 1) % std::ssize(recordings_));
}

GoodnessOfFit TestGoodnessOfFit(const ObservedExperiment& observed,
                                const Eigen::Matrix3Xd& marker_rest_m,
                                const HypothesisSet& hypotheses, const Fit& fit, int draws,
                                std::uint64_t seed) {
  const LinearModel& model = fit.model;
  const ResidualStatistics residual_statistics(observed, marker_rest_m, model);
  Eigen::VectorXd sigma = hypotheses.PriorWith(fit.faults, fit.posterior.scale).sigma;
  sigma(hypotheses.ParametersOf(fit.faults)).setZero();
  const Eigen::MatrixXd drawn = DrawStatistics(residual_statistics, sigma, fit, draws, seed);
  const Eigen::VectorXd mean = drawn.rowwise().mean();
  const Eigen::VectorXd deviation =
      ((drawn.colwise() - mean).rowwise().squaredNorm() / (draws - 1)).cwiseSqrt().cwiseMax(1e-9);
  const auto standardised = [&](const Eigen::VectorXd& tests) -> Eigen::VectorXd {
    return (tests - mean).cwiseQuotient(deviation);
  };
  std::vector<double> worst_of_draws;
  for (int d = 0; d < draws; ++d) {
    worst_of_draws.push_back(standardised(drawn.col(d)).maxCoeff());
  }
  std::sort(worst_of_draws.begin(), worst_of_draws.end());
  const auto rank =
      static_cast<std::size_t>((1.0 - kGoodnessOfFitTuning.false_alarms) * (draws - 1));
  const Eigen::VectorXd tests = residual_statistics.Of(model.y - model.J * fit.posterior.mean);
  GoodnessOfFit result;
  Eigen::Index worst = 0;
  result.surprise = standardised(tests).maxCoeff(&worst);
  result.worst = residual_statistics.NameOf(worst);
  const double expected = mean[residual_statistics.MisfitBeside(worst)];
  result.excess = (tests[worst] - mean[worst]) / expected;
  result.surprise_limit = worst_of_draws[rank];
  result.passed =
      result.surprise <= result.surprise_limit || result.excess < kGoodnessOfFitTuning.least_excess;
  return result;
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/inference/fitter.hpp"
#include "components/diagnosis/inference/linear_model.hpp"

namespace palpate::diagnosis {

/// Test statistics of whitened residuals: quadratic forms in units of the noise's chi-squared, so
/// that they compare with a misfit.
/// - the misfit of all recordings;
/// and of each recording
/// - its misfit;
/// - how neighbouring samples hang together (runs);
/// - how neighbouring markers do, and neighbouring features of the surface (the products of Moran's
/// I);
/// - what correlates with the commands, and with how fast they change, beyond a constant.
class ResidualStatistics {
 public:
  /// `rest_m` [3 x markers]: of the undeformed body.
  ResidualStatistics(const ObservedExperiment& observed, const Eigen::Matrix3Xd& rest_m,
                     const LinearModel& model);

  Eigen::Index count() const { return 1 + kKinds * std::ssize(recordings_); }
  /// [count] of a residual [rows].
  Eigen::VectorXd Of(const Eigen::VectorXd& residual) const;
  /// "misfit of recording RH_hold", "runs in recording RB_repeat", ...
  std::string NameOf(Eigen::Index test) const;
  /// The misfit of the same recording.
  Eigen::Index MisfitBeside(Eigen::Index test) const;

 private:
  enum Kind { kMisfit, kRuns, kNeighbours, kCommands, kRates, kKinds };

  struct Pair {
    Eigen::Index one, other;  ///< rows
    double weight;
  };
  struct Recording {
    std::string name;
    std::vector<Eigen::Index> rows;
    std::vector<Pair> in_time, on_body;
  };
  /// Rows of one recording and coordinate, and what correlates with them, orthonormal.
  struct Series {
    Eigen::Index recording, first_row;
    Eigen::MatrixXd commands, rates;  ///< [rows x directions]
  };

  Eigen::Index IndexOf(Kind kind, Eigen::Index recording) const {
    return 1 + kind * std::ssize(recordings_) + recording;
  }
  void PairInTime(const ObservedExperiment& observed, const LinearModel& model);
  void PairOnBody(const Eigen::Matrix3Xd& rest_m, const ObservedExperiment& observed,
                  const LinearModel& model);
  void CutIntoSeries(const ObservedExperiment& observed, const LinearModel& model);

  std::vector<Recording> recordings_;
  std::vector<Series> series_;
};

/// Posterior predictive check: whether the residual of a fit is noise.
struct GoodnessOfFit {
  bool passed = false;
  double surprise = 0.0;  ///< the worst test, in standard deviations of what a right model leaves
  std::string worst;      ///< "misfit of recording RH_hold", "runs in recording RB_repeat", ...
  double surprise_limit = 0.0;  ///< up to which it may be noise
  double excess = 0.0;  ///< how far the worst test is off, as a share of its recording's noise
};

/// ResidualStatistics of the residual, compared with what `draws` experiments of the fitted model
/// leave (parametric bootstrap, seeded), the worst of all tests with the worst of each draw.
/// `marker_rest_m` [3 x markers]: of the undeformed body.
GoodnessOfFit TestGoodnessOfFit(const ObservedExperiment& observed,
                                const Eigen::Matrix3Xd& marker_rest_m,
                                const HypothesisSet& hypotheses, const Fit& fit, int draws = 200,
                                std::uint64_t seed = 1);

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/diagnosis/inference/fitter.hpp"

namespace palpate::diagnosis {

/// Parameters without a robot.
class ToyFault final : public FaultModel {
 public:
  ToyFault(const std::string& id, std::vector<FaultParameter> parameters)
      : FaultModel({id, {"body"}}, id, std::move(parameters)) {}
  void Apply(const Eigen::VectorXd& /*z*/, ModelHypothesis* /*hypothesis*/) const override {}
};

/// Two faults of which a nominal robot has a little, and two faults; the last has two parameters.
inline HypothesisSet ToyBook() {
  std::vector<FaultModelPtr> causes;
  const auto add = [&](const std::string& id, std::vector<FaultParameter> parameters) {
    causes.push_back(std::make_unique<ToyFault>(id, std::move(parameters)));
  };
  add("small", {{.name = "a", .tolerance = 0.5, .fault = 20.0}});
  add("known", {{.name = "b", .tolerance = 0.4, .fault = 0.4}});
  add("fault", {{.name = "c", .fault = 15.0, .least = 0.0, .most = 40.0}});
  add("swap", {{.name = "d", .fault = 5.0, .fault_at = 3.0},
               {.name = "e", .tolerance = 0.1, .fault = 5.0}});
  return {std::move(causes), {}};
}

/// Three recordings of 12 samples and one marker, whitened: y - J z is noise of unit variance.
class ToyData {
 public:
  explicit ToyData(const HypothesisSet& hypotheses, unsigned seed) : random_(seed) {
    constexpr int kRecordings = 3;
    constexpr int kSamples = 12;
    for (int r = 0; r < kRecordings; ++r) {
      observed.recordings.push_back({.name = "r" + std::to_string(r), .kind = "free"});
      for (int s = 0; s < kSamples; ++s) observed.samples.emplace_back().recording = r;
      for (int coordinate = 0; coordinate < 3; ++coordinate) {
        for (int s = 0; s < kSamples; ++s) {
          model_.sample_of_row.push_back(r * kSamples + s);
          model_.coordinate_of_row.push_back(coordinate);
        }
      }
    }
    const auto rows = std::ssize(model_.sample_of_row);
    model_.J = Normal(rows, hypotheses.parameter_count());
  }

  Eigen::Index rows() const { return model_.J.rows(); }
  const Eigen::MatrixXd& J() const { return model_.J; }
  void SetColumn(Eigen::Index parameter, const Eigen::VectorXd& effect) {
    model_.J.col(parameter) = effect;
  }
  Eigen::MatrixXd Normal(Eigen::Index rows, Eigen::Index cols) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random_); });
  }
  /// A robot out of a prior, measured.
  Eigen::VectorXd Draw(const GaussianPrior& prior) {
    const Eigen::VectorXd z =
        prior.mean + prior.sigma.cwiseProduct(Eigen::VectorXd(Normal(prior.sigma.size(), 1)));
    return model_.J * z + Normal(rows(), 1);
  }

  /// What is fitted to `y`.
  Fit FitTo(const HypothesisSet& hypotheses, const Eigen::VectorXd& y,
            const std::vector<int>& faults) const {
    Fit fit;
    fit.status = Status::Ok();
    fit.faults = faults;
    fit.z = Eigen::VectorXd::Zero(hypotheses.parameter_count());
    fit.model = model_;
    fit.model.y = y;
    const Eigen::Index each = rows() / std::ssize(observed.recordings);
    fit.model.rows_of_recording.assign(observed.recordings.size(), each);
    fit.model.Sum(fit.z);
    fit.posterior = hypotheses.InferWithin(fit.model.All(), faults);
    return fit;
  }

  ObservedExperiment observed;

 private:
  std::mt19937 random_;
  LinearModel model_;
};

}  // namespace palpate::diagnosis

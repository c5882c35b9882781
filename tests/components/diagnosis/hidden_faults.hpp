// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "components/diagnosis/faults/catalogue.hpp"
#include "components/diagnosis/inference/fitter.hpp"
#include "tests/components/diagnosis/small_robot.hpp"

namespace palpate::diagnosis {

/// A robot with faults hidden in it, measured with 0.1 mm. SmallExperiment pulls all cables
/// together, where the gain of one looks like what their ends yield by: that is left out there.
class HiddenFaults : public testing::Test {
 protected:
  /// z of a parameter of the fault of this id at this place.
  struct Hidden {
    std::string id;
    std::string where;
    double z;
    int parameter = 0;
  };

  HiddenFaults() : HiddenFaults(SmallRobot(), SmallExperiment(SmallRobot())) {}
  HiddenFaults(robot::RobotBody body, const experiment::Experiment& experiment)
      : body_(std::move(body)),
        observed_(Observe(experiment, body_, {.most_samples = 40})),
        hypotheses_(Causes(), {}) {
    observed_.sigma_m.setConstant(kSigma_m);
  }

  std::vector<FaultModelPtr> Causes(const std::vector<std::string>& without = {}) const {
    std::vector<FaultModelPtr> causes =
        MakeFaultModels({.body = body_, .observed = observed_}, without);
    std::erase_if(causes, [](const FaultModelPtr& one) { return one->name().id == "cable_ends"; });
    return causes;
  }

  int Number(const std::string& id, const std::string& where) const {
    for (int k = 0; k < hypotheses_.size(); ++k) {
      if (hypotheses_.model(k).name() == CauseName{id, {where}}) return k;
    }
    ADD_FAILURE() << "no " << id << " of " << where;
    return -1;
  }
  /// Of the fault's first parameter.
  Eigen::Index ColumnOf(const std::string& id, const std::string& where) const {
    return hypotheses_.first(Number(id, where));
  }

  void Measure(const std::vector<Hidden>& hidden) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(hypotheses_.parameter_count());
    for (const Hidden& one : hidden) z[ColumnOf(one.id, one.where) + one.parameter] = one.z;
    const Simulation truth =
        Simulator(observed_, 1)
            .Run(HypothesisWith(NominalHypothesis(body_, observed_), hypotheses_.All(), z));
    ASSERT_TRUE(truth.status.ok());
    std::mt19937 random(kSeed);
    std::normal_distribution<double> normal;
    for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
      Sample& sample = observed_.samples[s];
      sample.position_m = truth.samples[s].markers_m();
      for (Eigen::Index k = 0; k < sample.position_m.size(); ++k) {
        sample.position_m.reshaped()[k] +=
            kSigma_m / std::sqrt(sample.count[k / 3]) * normal(random);
      }
    }
  }

  static constexpr double kSigma_m = 1e-4;
  static constexpr unsigned kSeed = 3;
  robot::RobotBody body_;
  ObservedExperiment observed_;
  HypothesisSet hypotheses_;
};

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/actuator_chain.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

/// How far apart the postures of samples are, from what their actuators and their gravity say.
class DriveDistance {
 public:
  /// `parts` [samples], of each at least one.
  DriveDistance(const ObservedExperiment& observed,
                const std::vector<std::vector<SamplePart>>& parts);

  /// From the middle of the sample `from` to where `to` begins: 1 where one actuator is at the
  /// other end of its range in the experiment, or the base is tilted by some 40 degrees more.
  double ToBegin(std::size_t from, std::size_t to) const {
    return (middle_.col(ToIndex(from)) - begin_.col(ToIndex(to))).norm();
  }
  /// From where nothing is driven, and nothing bent, to where `to` begins.
  double FromUndeformed(std::size_t to) const {
    return begin_.col(ToIndex(to)).head(actuators_).norm();
  }
  /// From middle to middle.
  double Between(std::size_t a, std::size_t b) const {
    return (middle_.col(ToIndex(a)) - middle_.col(ToIndex(b))).norm();
  }
  /// The samples in another order: after the one that is driven least always the one that is
  /// nearest to any before it (Prim's algorithm for the minimum spanning tree).
  std::vector<std::size_t> FromNearToFar(const std::vector<std::size_t>& samples) const;

 private:
  Eigen::Index actuators_ = 0;
  Eigen::MatrixXd begin_;   ///< [actuators and a rotation x samples]
  Eigen::MatrixXd middle_;  ///< as begin_
};

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/forward/model_hypothesis.hpp"

namespace palpate::diagnosis {

/// The body's surface about each marker.
class MarkerNormals {
 public:
  explicit MarkerNormals(const ModelHypothesis& hypothesis);

  /// Mean over that surface with the nodes at `x_m` [3n]; unit, outward, robot frame.
  Eigen::Vector3d Normal(std::size_t marker, const Eigen::VectorXd& x_m) const;

 private:
  std::vector<Eigen::Matrix3Xi> faces_;  ///< [markers] corners of each face
};

}  // namespace palpate::diagnosis

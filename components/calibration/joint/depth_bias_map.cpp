// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/depth_bias_map.hpp"

#include <cmath>

namespace palpate::calibration {

int CountOf(const DepthBiasBelief& belief) { return (belief.order + 1) * (belief.order + 2) / 2; }

std::vector<std::string> NamesOf(const DepthBiasBelief& belief) {
  std::vector<std::string> names = {"depth_scale"};
  for (int degree = 1; degree <= belief.order; ++degree) {
    for (int of_y = 0; of_y <= degree; ++of_y) {
      names.push_back("depth_bias:" + std::string(static_cast<std::size_t>(degree - of_y), 'x') +
                      std::string(static_cast<std::size_t>(of_y), 'y'));
    }
  }
  return names;
}

Eigen::VectorXd DepthBiasBasis(const DepthBiasBelief& belief, const Eigen::Vector3d& p_camera_m) {
  const double x = p_camera_m.x() / (p_camera_m.z() * belief.span);
  const double y = p_camera_m.y() / (p_camera_m.z() * belief.span);
  Eigen::VectorXd basis(CountOf(belief));
  Eigen::Index next = 0;
  for (int degree = 0; degree <= belief.order; ++degree) {
    for (int of_y = 0; of_y <= degree; ++of_y) {
      basis[next++] = std::pow(x, degree - of_y) * std::pow(y, of_y);
    }
  }
  return basis;
}

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/geometry/depth_bias_map.hpp"

namespace palpate::geometry {

int CountOf(const DepthBiasBasis& basis) { return (basis.order + 1) * (basis.order + 2) / 2; }

std::vector<std::string> NamesOf(const DepthBiasBasis& basis) {
  std::vector<std::string> names = {"depth_scale"};
  for (int degree = 1; degree <= basis.order; ++degree) {
    for (int of_y = 0; of_y <= degree; ++of_y) {
      names.push_back("depth_bias:" + std::string(static_cast<std::size_t>(degree - of_y), 'x') +
                      std::string(static_cast<std::size_t>(of_y), 'y'));
    }
  }
  return names;
}

Eigen::VectorXd ValuesAt(const DepthBiasBasis& basis, const Eigen::Vector3d& p_camera_m) {
  const double x = p_camera_m.x() / (p_camera_m.z() * basis.span);
  const double y = p_camera_m.y() / (p_camera_m.z() * basis.span);
  Eigen::VectorXd values(CountOf(basis));
  values[0] = 1.0;
  Eigen::Index last = 0;  // the first of the degree below
  for (int degree = 1; degree <= basis.order; ++degree) {
    const Eigen::Index first = last + degree;
    for (int k = 0; k < degree; ++k) values[first + k] = x * values[last + k];
    values[first + degree] = y * values[first - 1];
    last = first;
  }
  return values;
}

Eigen::Matrix3Xd SlopesAt(const DepthBiasBasis& basis, const Eigen::Vector3d& p_camera_m) {
  const double z_m = p_camera_m.z();
  const double x = p_camera_m.x() / (z_m * basis.span);
  const double y = p_camera_m.y() / (z_m * basis.span);
  const Eigen::VectorXd values = ValuesAt(basis, p_camera_m);
  const Eigen::Vector3d of_x(1.0 / (z_m * basis.span), 0.0, -x / z_m);
  const Eigen::Vector3d of_y(0.0, 1.0 / (z_m * basis.span), -y / z_m);
  Eigen::Matrix3Xd slopes = Eigen::Matrix3Xd::Zero(3, values.size());
  Eigen::Index last = 0;
  for (int degree = 1; degree <= basis.order; ++degree) {
    const Eigen::Index first = last + degree;
    for (int k = 0; k < degree; ++k) {
      slopes.col(first + k) = values[last + k] * of_x + x * slopes.col(last + k);
    }
    slopes.col(first + degree) = values[first - 1] * of_y + y * slopes.col(first - 1);
    last = first;
  }
  return slopes;
}

}  // namespace palpate::geometry

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/chamber.hpp"

#include <cmath>
#include <utility>

#include "libs/core/check.hpp"

namespace palpate::robot {

double PistonArea_m2(double volume_m3) {
  PALPATE_CHECK(volume_m3 > 0.0, volume_m3);
  const double edge_m = std::cbrt(volume_m3);
  return edge_m * edge_m;
}

Chamber::Chamber(fem::MovingSurface wall, const Eigen::VectorXd& rest_x_m)
    : volume_(std::move(wall)) {
  area_m2_ = PistonArea_m2(Volume_m3(rest_x_m));
  SetRestValue(Value(rest_x_m));
}

double Chamber::Value(const Eigen::VectorXd& x_m) const { return -Volume_m3(x_m) / area_m2_; }

void Chamber::AddGradient(const Eigen::VectorXd& x_m, double factor, Eigen::VectorXd& nodal) const {
  volume_.AddGradient(x_m, -factor / area_m2_, nodal);
}

void Chamber::AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                           fem::StiffnessMatrix& stiffness) const {
  volume_.AddCurvature(x_m, -multiplier / area_m2_, stiffness);
}

}  // namespace palpate::robot

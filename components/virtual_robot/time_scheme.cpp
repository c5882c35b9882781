// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/time_scheme.hpp"

namespace palpate::virtual_robot {

TimeScheme TimeScheme::QuasiStatic(double h_s) {
  TimeScheme scheme;
  scheme.h_s = h_s;
  return scheme;
}

TimeScheme TimeScheme::GeneralisedAlpha(double h_s, double spectral_radius) {
  TimeScheme scheme;
  scheme.dynamic = true;
  scheme.h_s = h_s;
  scheme.alpha_m = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
  scheme.alpha_f = spectral_radius / (spectral_radius + 1.0);
  const double difference = scheme.alpha_f - scheme.alpha_m;
  scheme.gamma = 0.5 + difference;
  scheme.beta = 0.25 * (1.0 + difference) * (1.0 + difference);
  return scheme;
}

void TimeScheme::SetRates(const MotionState& from, MotionState* to) const {
  if (!dynamic) {
    to->v_m_s = (to->x_m - from.x_m) / h_s;
    to->a_m_s2.setZero(to->x_m.size());
    return;
  }
  to->a_m_s2 = (to->x_m - from.x_m - h_s * from.v_m_s) / (beta * h_s * h_s) -
               (0.5 / beta - 1.0) * from.a_m_s2;
  to->v_m_s = from.v_m_s + h_s * ((1.0 - gamma) * from.a_m_s2 + gamma * to->a_m_s2);
}

void TimeScheme::Predict(const MotionState& from, Eigen::VectorXd* x_m) const {
  *x_m = from.x_m + h_s * from.v_m_s;
  if (dynamic) *x_m += 0.5 * h_s * h_s * from.a_m_s2;
}

}  // namespace palpate::virtual_robot

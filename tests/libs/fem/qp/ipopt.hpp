// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <memory>
#include <optional>

#include "libs/fem/bounded_qp.hpp"

namespace palpate::fem::qp {

/// 1/2 x' H x + c' x
double Objective(const BoundedQp& qp, const QpVector& x);

/// Ipopt, set up once: its start costs more than one of our problems.
class Ipopt {
 public:
  Ipopt();
  ~Ipopt();
  Ipopt(const Ipopt&) = delete;
  Ipopt& operator=(const Ipopt&) = delete;

  /// A minimiser within the bounds to about 1e-10 in the optimality conditions; nothing where Ipopt
  /// says anything but "solved".
  std::optional<QpVector> Solve(const BoundedQp& qp);

 private:
  struct Application;
  std::unique_ptr<Application> application_;
};

}  // namespace palpate::fem::qp

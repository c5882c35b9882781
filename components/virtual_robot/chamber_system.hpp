// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/virtual_robot/bench_body.hpp"
#include "libs/fem/enclosed_volume.hpp"

namespace palpate::virtual_robot {

/// The chambers of the body, each under the pressure that its supply gives it
/// (pressure_supply.hpp).
class ChamberSystem {
 public:
  explicit ChamberSystem(const BenchBody& body);

  int ChamberCount() const { return static_cast<int>(chambers_.size()); }
  fem::NodePairs CoupledPairs() const;
  void BindTo(const fem::StiffnessMatrix& stiffness);

  /// Above ambient, Pa [chambers]; NaN: open to the air.
  void SetPressures(const Eigen::VectorXd& pressure_Pa);
  const Eigen::VectorXd& pressure_Pa() const { return pressure_Pa_; }
  /// Change of volume from the body as it was assembled, m3.
  double Change_m3(int chamber, const Eigen::VectorXd& x_m) const;

  void AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& nodal) const;
  void AddCurvature(const Eigen::VectorXd& x_m, fem::StiffnessMatrix& stiffness) const;

 private:
  std::vector<fem::EnclosedVolume> chambers_;
  Eigen::VectorXd rest_m3_;      ///< [chambers]
  Eigen::VectorXd pressure_Pa_;  ///< [chambers]
};

}  // namespace palpate::virtual_robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/chamber_system.hpp"

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::virtual_robot {

ChamberSystem::ChamberSystem(const BenchBody& body)
    : rest_m3_(std::ssize(body.chambers)),
      pressure_Pa_(Eigen::VectorXd::Zero(std::ssize(body.chambers))) {
  for (const robot::BodyChamber& chamber : body.chambers) {
    chambers_.emplace_back(chamber.wall);
    rest_m3_[ToIndex(chambers_.size()) - 1] = chambers_.back().Volume_m3(body.assembled_m);
  }
}

fem::NodePairs ChamberSystem::CoupledPairs() const {
  fem::NodePairs pairs;
  for (const fem::EnclosedVolume& chamber : chambers_) {
    const fem::NodePairs own = chamber.CoupledPairs();
    pairs.insert(pairs.end(), own.begin(), own.end());
  }
  return pairs;
}

void ChamberSystem::BindTo(const fem::StiffnessMatrix& stiffness) {
  for (fem::EnclosedVolume& chamber : chambers_) chamber.BindTo(stiffness);
}

void ChamberSystem::SetPressures(const Eigen::VectorXd& pressure_Pa) {
  PALPATE_CHECK(pressure_Pa.size() == rest_m3_.size(), pressure_Pa.size());
  pressure_Pa_ = pressure_Pa.array().isNaN().select(0.0, pressure_Pa);
}

double ChamberSystem::Change_m3(int chamber, const Eigen::VectorXd& x_m) const {
  return chambers_[At(chamber)].Volume_m3(x_m) - rest_m3_[chamber];
}

void ChamberSystem::AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& nodal) const {
  for (std::size_t c = 0; c < chambers_.size(); ++c) {
    const double pressure_Pa = pressure_Pa_[ToIndex(c)];
    if (pressure_Pa != 0.0) chambers_[c].AddGradient(x_m, pressure_Pa, nodal);
  }
}

void ChamberSystem::AddCurvature(const Eigen::VectorXd& x_m,
                                 fem::StiffnessMatrix& stiffness) const {
  for (std::size_t c = 0; c < chambers_.size(); ++c) {
    const double pressure_Pa = pressure_Pa_[ToIndex(c)];
    if (pressure_Pa != 0.0) chambers_[c].AddCurvature(x_m, -pressure_Pa, stiffness);
  }
}

}  // namespace palpate::virtual_robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/check.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

class RestShape : public Parameter {
 public:
  RestShape(CableZero zero, MassRule mass) : zero_(zero), mass_(mass) {}

 protected:
  /// Everything that X + p mode changes.
  void Change(const EquilibriumPoint& at, const Eigen::VectorXd& mode_m,
              ParameterColumn* column) const {
    PALPATE_CHECK(mode_m.size() == at.x_m().size(), mode_m.size());
    at.elements().AddAlongRestShape(at.materials(), at.x_m(), mode_m, -1.0,
                                    column->distributed_force_N());
    at.model().elastic_body().fibres().AddAlongRestShape(at.x_m(), mode_m, -1.0,
                                                         column->distributed_force_N());
    for (Eigen::Index node = 0; node < mode_m.size() / 3; ++node) {
      at.MoveHeldNode(node, mode_m.segment<3>(3 * node), column);
    }
    if (mass_ != MassRule::kNodalKept) ChangeMass(at, mode_m, column);
    if (zero_ == CableZero::kKept) return;
    for (int c = 0; c < at.model().ActuatorCount(); ++c) {
      column->commanded_length_m[c] += at.RestLengthAlong(c, mode_m);
    }
  }

 private:
  void ChangeMass(const EquilibriumPoint& at, const Eigen::VectorXd& mode_m,
                  ParameterColumn* column) const {
    const double total_kg = at.model().body().node_mass_kg.sum();
    const Eigen::VectorXd& volume_m3 = at.nodal_volume_m3();
    const Eigen::VectorXd& change_m3 = at.NodalVolumeAlong(mode_m);
    const double whole_m3 = volume_m3.sum();
    Eigen::VectorXd mass_kg = total_kg / whole_m3 * change_m3;
    if (mass_ == MassRule::kTotalKept) {
      mass_kg -= total_kg * change_m3.sum() / (whole_m3 * whole_m3) * volume_m3;
    }
    for (Eigen::Index node = 0; node < mass_kg.size(); ++node) {
      column->distributed_force_N().segment<3>(3 * node) +=
          mass_kg[node] * at.model().gravity_m_s2();
    }
  }

  CableZero zero_;
  MassRule mass_;
};

class Mode final : public RestShape {
 public:
  Mode(Eigen::VectorXd mode_m, CableZero zero, MassRule mass)
      : RestShape(zero, mass), mode_m_(std::move(mode_m)) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    Change(at, mode_m_, column);
  }

 private:
  Eigen::VectorXd mode_m_;
};

class Scale final : public RestShape {
 public:
  Scale(const Eigen::Vector3d& centre_m, CableZero zero, MassRule mass)
      : RestShape(zero, mass), centre_m_(centre_m) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    Eigen::VectorXd mode_m = at.model().elastic_body().rest_m();
    for (Eigen::Index node = 0; node < mode_m.size() / 3; ++node) {
      mode_m.segment<3>(3 * node) -= centre_m_;
    }
    Change(at, mode_m, column);
  }

 private:
  Eigen::Vector3d centre_m_;
};

}  // namespace

ParameterPtr RestShapeMode(Eigen::VectorXd mode_m, CableZero zero, MassRule mass) {
  return std::make_unique<Mode>(std::move(mode_m), zero, mass);
}

ParameterPtr GeometryScale(const Eigen::Vector3d& centre_m, CableZero zero, MassRule mass) {
  return std::make_unique<Scale>(centre_m, zero, mass);
}

}  // namespace palpate::robot

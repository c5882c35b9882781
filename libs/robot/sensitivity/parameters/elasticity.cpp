// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <iterator>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/equilibrium_point.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::robot {

namespace {

/// Both elastic constants act through the Lame constants, in which the forces are linear.
class ElasticConstant final : public Parameter {
 public:
  enum class Kind { kYoungsModulus, kPoissonsRatio };
  ElasticConstant(Kind kind, int material) : kind_(kind), material_(material) {}

  void Describe(const EquilibriumPoint& at, ParameterColumn* column) const override {
    PALPATE_CHECK(material_ >= 0 && material_ < std::ssize(at.materials()), material_);
    const fem::Material& material = at.materials()[At(material_)];
    const double E = material.youngs_modulus_Pa;
    const double nu = material.poissons_ratio;
    double lambda_along = material.LameLambda_Pa() / E;
    double mu_along = material.LameMu_Pa() / E;
    if (kind_ == Kind::kPoissonsRatio) {
      const double denominator = (1.0 + nu) * (1.0 - 2.0 * nu);
      lambda_along = E * (1.0 + 2.0 * nu * nu) / (denominator * denominator);
      mu_along = -0.5 * E / ((1.0 + nu) * (1.0 + nu));
    }
    column->distributed_force_N() -= lambda_along * at.forces_per_lambda_m2().col(material_) +
                                     mu_along * at.forces_per_mu_m2().col(material_);
  }

 private:
  Kind kind_;
  int material_;
};

}  // namespace

ParameterPtr YoungsModulus(int material) {
  return std::make_unique<ElasticConstant>(ElasticConstant::Kind::kYoungsModulus, material);
}

ParameterPtr PoissonsRatio(int material) {
  return std::make_unique<ElasticConstant>(ElasticConstant::Kind::kPoissonsRatio, material);
}

}  // namespace palpate::robot

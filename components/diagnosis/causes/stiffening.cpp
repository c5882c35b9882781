// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <mutex>
#include <utility>

#include "components/diagnosis/causes/makers.hpp"
#include "libs/core/error.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

std::vector<fem::Material> AsYeoh(std::vector<fem::Material> materials, double c20_over_c10) {
  for (fem::Material& material : materials) {
    if (material.model != fem::MaterialModel::kYeoh) material.c30_over_c10 = 0.0;
    material.model = fem::MaterialModel::kYeoh;
    material.c20_over_c10 = c20_over_c10;
  }
  return materials;
}

/// The material stiffens with strain as Yeoh's with C20 = C2_over_C1 C10 does. With the cause a
/// material of another kind becomes Yeoh's of the same modulus, which the derivative leaves out.
class Stiffening final : public FaultModel {
 public:
  explicit Stiffening(const robot::RobotBody& body)
      : FaultModel({"stiffening", {"body"}}, "stiffening of the material with strain",
                   {{.name = "C2_over_C1", .fault = 1.5, .least = 0.0}}),
        without_(body.mesh, AsYeoh(body.materials, 0.0), body.material_of_cell),
        with_(body.mesh, AsYeoh(body.materials, 1.0), body.material_of_cell) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.materials = AsYeoh(hypothesis->body.materials, std::max(0.0, z[0]));
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              std::vector<robot::CalibratedDrive>* /*drives*/) const override {
    robot->material.model = fem::MaterialModel::kYeoh;
    robot->material.c20_over_c10 = z[0];
    robot->material.c30_over_c10 = 0.0;
    return true;
  }

  /// The forces are linear in C20.
  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const Eigen::VectorXd& x_m = at.shape.state.x_m;
    Eigen::VectorXd without_N = Eigen::VectorXd::Zero(x_m.size());
    Eigen::VectorXd with_N = Eigen::VectorXd::Zero(x_m.size());
    const auto& materials = at.model.elastic_body().materials();
    const std::scoped_lock lock(mutex_);
    for (int k = 0; k < static_cast<int>(materials.size()); ++k) {
      const fem::Material& now = materials[static_cast<std::size_t>(k)];
      for (fem::ElasticBody* body : {&without_, &with_}) {
        body->SetYoungsModulus(k, now.youngs_modulus_Pa);
        body->SetPoissonsRatio(k, now.poissons_ratio);
      }
    }
    without_.AddForces(x_m, without_N);
    with_.AddForces(x_m, with_N);
    return robot::NodalForce(without_N - with_N);
  }

 private:
  mutable std::mutex mutex_;          ///< bodies keep the sums of their threads
  mutable fem::ElasticBody without_;  ///< of the moment's moduli
  mutable fem::ElasticBody with_;
};

}  // namespace

/// Nearly incompressible tet10 averages its dilatation, which Yeoh's material does not do here.
void MakeStiffening(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  for (const fem::Material& material : world.body.materials) {
    if (material.volumetric != fem::Volumetric::kPointwise) return;
  }
  causes->push_back(std::make_unique<Stiffening>(world.body));
}

}  // namespace palpate::diagnosis

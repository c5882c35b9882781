// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <mutex>
#include <utility>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/robot/robot_description.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

class YoungsModulusFault final : public FaultModel {
 public:
  YoungsModulusFault()
      : FaultModel({"youngs_modulus", {"body"}}, "Young's modulus of the body",
                   {{.name = "factor",
                     .nominal = 1.0,
                     .tolerance = 0.03,
                     .fault = 0.5,
                     .scale = FaultParameter::Scale::kFactor}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    for (fem::Material& material : hypothesis->body.materials) {
      material.youngs_modulus_Pa *= std::exp(z[0]);
    }
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot->material.youngs_modulus_Pa *= std::exp(z[0]);
    for (robot::RegionSettings& region : robot->regions) {
      if (region.youngs_modulus_Pa) *region.youngs_modulus_Pa *= std::exp(z[0]);
    }
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    auto sum = std::make_unique<SumOfParameters>();
    const auto& materials = at.model.elastic_body().materials();
    for (std::size_t k = 0; k < materials.size(); ++k) {
      sum->Add(materials[k].youngs_modulus_Pa, robot::YoungsModulus(static_cast<int>(k)));
    }
    return sum;
  }
};

}  // namespace

void MakeYoungsModulus(const CatalogueInputs& /*inputs*/, std::vector<FaultModelPtr>* faults) {
  faults->push_back(std::make_unique<YoungsModulusFault>());
}

namespace {

class RegionalStiffness final : public FaultModel {
 public:
  RegionalStiffness(const std::string& region, int material)
      : FaultModel({"regional_stiffness", {"region:" + region}}, "stiffness of region " + region,
                   {{.name = "factor",
                     .nominal = 1.0,
                     .tolerance = 0.03,
                     .fault = 0.4,
                     .scale = FaultParameter::Scale::kFactor}}),
        material_(material) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.materials[At(material_)].youngs_modulus_Pa *= std::exp(z[0]);
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot::RegionSettings& region = robot->regions[static_cast<std::size_t>(material_) - 1];
    region.youngs_modulus_Pa =
        region.youngs_modulus_Pa.value_or(robot->material.youngs_modulus_Pa) * std::exp(z[0]);
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const auto& materials = at.model.elastic_body().materials();
    return Scaled(materials[At(material_)].youngs_modulus_Pa, robot::YoungsModulus(material_));
  }

 private:
  int material_;
};

}  // namespace

void MakeRegionalStiffness(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const std::vector<std::string>& regions = inputs.body.region_names;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    faults->push_back(std::make_unique<RegionalStiffness>(regions[k], static_cast<int>(k) + 1));
  }
}

namespace {

/// nu of the whole body, Young's modulus as it is.
class PoissonsRatioFault final : public FaultModel {
 public:
  explicit PoissonsRatioFault(double nominal)
      : FaultModel({"poissons_ratio", {"body"}}, "Poisson's ratio of the body",
                   {{.name = "nu",
                     .nominal = nominal,
                     .tolerance = 0.005,
                     .fault = 0.04,
                     .least = -nominal,
                     .most = robot::kLargestPoissonsRatio - nominal}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const FaultParameter& nu = parameters().front();
    for (fem::Material& material : hypothesis->body.materials) {
      material.poissons_ratio += std::clamp(z[0], nu.least, nu.most);
    }
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot->material.poissons_ratio += z[0];
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    auto sum = std::make_unique<SumOfParameters>();
    for (std::size_t k = 0; k < at.model.elastic_body().materials().size(); ++k) {
      sum->Add(1.0, robot::PoissonsRatio(static_cast<int>(k)));
    }
    return sum;
  }
};

}  // namespace

void MakePoissonsRatio(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  faults->push_back(std::make_unique<PoissonsRatioFault>(inputs.body.nominal_poissons_ratio));
}

namespace {

std::vector<fem::Material> AsYeoh(std::vector<fem::Material> materials, double c20_over_c10) {
  for (fem::Material& material : materials) {
    if (material.model != fem::MaterialModel::kYeoh) material.c30_over_c10 = 0.0;
    material.model = fem::MaterialModel::kYeoh;
    material.c20_over_c10 = c20_over_c10;
  }
  return materials;
}

/// The material stiffens with strain as Yeoh's with C20 = C2_over_C1 C10 does. With the fault a
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
              robot::CalibrationFile* /*calibration*/) const override {
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
      const fem::Material& now = materials[At(k)];
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
  mutable fem::ElasticBody without_;  ///< of the sample's moduli
  mutable fem::ElasticBody with_;
};

}  // namespace

/// Nearly incompressible tet10 averages its dilatation, which Yeoh's material does not do here.
void MakeStiffening(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (const fem::Material& material : inputs.body.materials) {
    if (material.volumetric != fem::Volumetric::kPointwise) return;
  }
  faults->push_back(std::make_unique<Stiffening>(inputs.body));
}

namespace {

class Temperature final : public FaultModel {
 public:
  Temperature()
      : FaultModel({"temperature", {"body"}}, "modulus that changes with time (temperature)",
                   {{.name = "relative_E_change_at_end", .fault = 0.15, .least = -0.9}}) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->modulus_change_at_end += z[0];
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const Timeline& timeline = at.observed.timeline;
    const double begin_s = timeline.begin_s.front();
    const double share = (at.seen().t_s - begin_s) / (timeline.end_s.back() - begin_s);
    const double now = 1.0 + at.hypothesis.modulus_change_at_end * share;
    auto sum = std::make_unique<SumOfParameters>();
    const auto& materials = at.model.elastic_body().materials();
    for (std::size_t k = 0; k < materials.size(); ++k) {
      sum->Add(share / now * materials[k].youngs_modulus_Pa,
               robot::YoungsModulus(static_cast<int>(k)));
    }
    return sum;
  }
};

}  // namespace

void MakeTemperature(const CatalogueInputs& /*inputs*/, std::vector<FaultModelPtr>* faults) {
  faults->push_back(std::make_unique<Temperature>());
}

namespace {

/// Also what its gravity is larger by: weight is all that shows of both.
class Density final : public FaultModel {
 public:
  Density()
      : FaultModel({"density", {"body"}}, "density of the body",
                   {{.name = "factor",
                     .nominal = 1.0,
                     .tolerance = 0.01,
                     .fault = 0.15,
                     .scale = FaultParameter::Scale::kFactor,
                     .plausible = 0.5}}) {}  // silicones differ by less

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.node_mass_kg *= std::exp(z[0]);
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    if (robot->mass.density_kg_m3) *robot->mass.density_kg_m3 *= std::exp(z[0]);
    if (robot->mass.total_kg) *robot->mass.total_kg *= std::exp(z[0]);
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::MassFactor();
  }
};

}  // namespace

void MakeDensity(const CatalogueInputs& /*inputs*/, std::vector<FaultModelPtr>* faults) {
  faults->push_back(std::make_unique<Density>());
}

}  // namespace palpate::diagnosis

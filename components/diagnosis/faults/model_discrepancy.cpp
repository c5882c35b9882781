// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "components/diagnosis/faults/makers.hpp"
#include "components/diagnosis/forward/posture.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// What no parameter of the simulation says: any body and its cables differ from any mesh and
/// material law, smoothly over posture (M. C. Kennedy and A. O'Hagan, Bayesian calibration of
/// computer models, J. R. Stat. Soc. B 63, 2001). It is added to what is simulated, and acts as if
/// one input of the simulation changed with posture (K. Sargsyan, H. N. Najm and R. Ghanem, On the
/// statistical calibration of physical models, Int. J. Chem. Kinet. 47, 2015).
class Discrepancy : public FaultModel {
 public:
  Discrepancy(std::vector<std::string> where, std::string words,
              std::shared_ptr<const PostureFunctions> functions, DiscrepancyGroup group)
      : FaultModel({"model_discrepancy", std::move(where)}, std::move(words),
                   Coefficients(*functions, group)),
        functions_(std::move(functions)) {}

  bool AddsToPrediction() const override { return true; }
  void Apply(const Eigen::VectorXd& /*z*/, ModelHypothesis* /*hypothesis*/) const override {}

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    return Scaled(functions_->At(at.shape.state.x_m)[parameter], Direction(at));
  }

 private:
  /// What changes by one.
  virtual robot::ParameterPtr Direction(const FaultContext& at) const = 0;

  static std::vector<FaultParameter> Coefficients(const PostureFunctions& functions,
                                                  DiscrepancyGroup group) {
    return std::vector<FaultParameter>(
        static_cast<std::size_t>(functions.count()),
        {.name = "share", .tolerance = 1.0, .fault = 1.0, .group = group});
  }

  std::shared_ptr<const PostureFunctions> functions_;
};

/// An actuator takes in, or pulls or presses with, so many times the experiment's largest command
/// more.
class ActuatorDiscrepancy final : public Discrepancy {
 public:
  ActuatorDiscrepancy(const robot::ActuatorTraits& actuator, Eigen::VectorXd change,
                      std::shared_ptr<const PostureFunctions> functions)
      : Discrepancy({(actuator.IsChamber() ? "chamber:" : "cable:") + actuator.name},
                    "how far " + actuator.Title() + " bends the body", std::move(functions),
                    DiscrepancyGroup::kCables),
        change_(std::move(change)) {}

 private:
  robot::ParameterPtr Direction(const FaultContext& /*at*/) const override {
    return CommandChange(change_);
  }

  Eigen::VectorXd change_;  ///< [actuators]
};

/// A material is stiffer by such a share.
class StiffnessDiscrepancy final : public Discrepancy {
 public:
  StiffnessDiscrepancy(const std::string& where, int material,
                       std::shared_ptr<const PostureFunctions> functions)
      : Discrepancy({where}, "how stiff the " + where + " is in its postures", std::move(functions),
                    DiscrepancyGroup::kStiffness),
        material_(material) {}

 private:
  robot::ParameterPtr Direction(const FaultContext& at) const override {
    const fem::Material& material = at.model.elastic_body().materials()[At(material_)];
    return Scaled(material.youngs_modulus_Pa, robot::YoungsModulus(material_));
  }

  int material_;
};

/// Of all commands of the kind that this actuator has; 0: there are none.
double LargestCommand(const ObservedExperiment& observed, std::size_t actuator) {
  double largest = 0.0;
  for (const Sample& sample : observed.samples) {
    const Eigen::VectorXd command = observed.timeline.CommandAt(sample.t_s);
    for (std::size_t c = 0; c < observed.timeline.by_tension.size(); ++c) {
      if (observed.timeline.by_tension[c] != observed.timeline.by_tension[actuator]) continue;
      const double value = std::abs(command[ToIndex(c)]);
      if (std::isfinite(value)) largest = std::max(largest, value);
    }
  }
  return largest;
}

}  // namespace

void MakeModelDiscrepancy(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  if (inputs.as_built == nullptr) return;
  const auto of_posture = FunctionsOfPosture(inputs.body, *inputs.as_built);
  if (!of_posture) return;
  const auto functions = std::make_shared<const PostureFunctions>(*of_posture);
  const std::vector<robot::ActuatorTraits>& actuators = inputs.observed.timeline.actuators;
  for (Eigen::Index c = 0; c < std::ssize(actuators); ++c) {
    const double largest = LargestCommand(inputs.observed, static_cast<std::size_t>(c));
    if (largest == 0.0) continue;
    faults->push_back(std::make_unique<ActuatorDiscrepancy>(
        actuators[At(c)], largest * Eigen::VectorXd::Unit(std::ssize(actuators), c), functions));
  }
  for (std::size_t k = 0; k < inputs.body.materials.size(); ++k) {
    const std::string where = k == 0 ? "body" : "region:" + inputs.body.region_names[k - 1];
    faults->push_back(
        std::make_unique<StiffnessDiscrepancy>(where, static_cast<int>(k), functions));
  }
}

}  // namespace palpate::diagnosis

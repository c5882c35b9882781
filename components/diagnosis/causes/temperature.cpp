// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

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

void MakeTemperature(const CauseWorld& /*world*/, std::vector<FaultModelPtr>* causes) {
  causes->push_back(std::make_unique<Temperature>());
}

}  // namespace palpate::diagnosis

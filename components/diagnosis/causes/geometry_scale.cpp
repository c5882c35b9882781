// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// The body is larger about the middle of its base; the points that cables are pulled from stay on
/// the ground, and the drives are zeroed on it as it is.
class GeometryScale final : public FaultModel {
 public:
  explicit GeometryScale(const Eigen::Vector3d& middle_m)
      : FaultModel({"geometry_scale", {"body"}}, "size of the body",
                   {{.name = "factor",
                     .nominal = 1.0,
                     .tolerance = 0.005,
                     .fault = 0.03,
                     .scale = FaultParameter::Scale::kFactor,
                     .plausible = 0.1}}),  // shrinkage is some per cent
        middle_m_(middle_m) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const double factor = std::exp(z[0]);
    Eigen::Matrix3Xd& nodes_m = hypothesis->body.mesh.nodes_m;
    const Eigen::Matrix3Xd larger_m = (factor - 1.0) * (nodes_m.colwise() - middle_m_);
    nodes_m += larger_m;
    hypothesis->assembled_m += larger_m.reshaped();
    hypothesis->body.node_mass_kg *= factor * factor * factor;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::GeometryScale(middle_m_, robot::CableZero::kOfChangedShape,
                                robot::MassRule::kDensityKept);
  }

 private:
  Eigen::Vector3d middle_m_;
};

}  // namespace

void MakeGeometryScale(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  causes->push_back(std::make_unique<GeometryScale>(MiddleOfBase(world.body)));
}

}  // namespace palpate::diagnosis

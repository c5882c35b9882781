// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// What a healthy robot's simulation has of it, m/N, beside what all cables have (CableEnds): a
/// cable ends in a point, at which every mesh gives way by something else. Two meshes of four_leg
/// of like fineness differ by 0.03 to 0.09 mm/N.
constexpr double kOfMesh_m_N = 5e-5;

/// z is the compliance, m/N.
class CableElasticity final : public FaultModel {
 public:
  CableElasticity(const std::string& cable, int index)
      : FaultModel({"cable_elasticity", {"cable:" + cable}}, "stretch of cable " + cable,
                   {{.name = "k_N_m",
                     .tolerance = kOfMesh_m_N,
                     .fault = 1e-3,
                     .least = 0.0,
                     .scale = FaultParameter::Scale::kInverse}}),
        index_(index) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->cable_compliance_m_N[index_] += std::max(0.0, z[0]);
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::CableCompliance(index_);
  }

  /// What the mesh gives way by is in what was fitted, and nobody knows how much it is.
  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& undeformed_m) const override {
    return FaultModel::Report(z, covariance.array() + kOfMesh_m_N * kOfMesh_m_N, undeformed_m);
  }

 private:
  int index_;
};

}  // namespace

void MakeCableElasticity(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  for (std::size_t c = 0; c < world.body.cables.size(); ++c) {
    if (world.observed.timeline.by_tension[c]) continue;
    causes->push_back(
        std::make_unique<CableElasticity>(world.body.cables[c].name, static_cast<int>(c)));
  }
}

}  // namespace palpate::diagnosis

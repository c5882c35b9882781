// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <utility>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// Capstan friction in the eyelets that a cable runs through (forward/sticking.hpp); one with a
/// knot only has none.
class CableFrictionFault final : public FaultModel {
 public:
  CableFrictionFault(const std::string& cable, int index)
      : FaultModel({"cable_friction", {"cable:" + cable}}, "friction of cable " + cable,
                   {{.name = "mu", .tolerance = 0.02, .fault = 0.3, .least = 0.0}}),
        index_(index) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.cables[At(index_)].friction_coefficient += std::max(0.0, z[0]);
  }

  /// More of it sticks for longer, which OnBody leaves out.
  bool NeedsSimulation(const Eigen::VectorXd& z) const override { return z[0] > 0.05; }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot->cables[At(index_)].friction_coefficient += z[0];
    return true;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::CableFrictionCoefficient(index_);
  }

 private:
  int index_;
};

}  // namespace

void MakeCableFriction(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (std::size_t c = 0; c < inputs.body.cables.size(); ++c) {
    if (inputs.body.cables[c].eyelets.size() < 2) continue;
    faults->push_back(
        std::make_unique<CableFrictionFault>(inputs.body.cables[c].name, static_cast<int>(c)));
  }
}

namespace {

/// What a nominal robot's simulation has of it, m/N, beside what all cables have
/// (AnchorCompliance): a cable ends in a point, at which every mesh yields by something else. Two
/// meshes of four_leg of like fineness differ by 0.03 to 0.09 mm/N.
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

  /// The fitted compliance contains the mesh's, which is unknown.
  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& undeformed_m) const override {
    return FaultModel::Report(z, covariance.array() + kOfMesh_m_N * kOfMesh_m_N, undeformed_m);
  }

 private:
  int index_;
};

}  // namespace

void MakeCableElasticity(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (std::size_t c = 0; c < inputs.body.cables.size(); ++c) {
    if (inputs.observed.timeline.by_tension[c]) continue;
    faults->push_back(
        std::make_unique<CableElasticity>(inputs.body.cables[c].name, static_cast<int>(c)));
  }
}

namespace {

/// Implausible error of the place of the fixed eyelet.
constexpr double kFarthestEyelet_m = 0.02;

/// The point that the cable is pulled from sits elsewhere; the actuator is zeroed with it there.
class CableRouting final : public FaultModel {
 public:
  CableRouting(const std::string& cable, int index)
      : FaultModel(
            {"cable_routing", {"cable:" + cable}}, "place of the fixed eyelet of cable " + cable,
            {{.name = "dx_m", .tolerance = 3e-4, .fault = 4e-3, .plausible = kFarthestEyelet_m},
             {.name = "dy_m", .tolerance = 3e-4, .fault = 4e-3, .plausible = kFarthestEyelet_m},
             {.name = "dz_m", .tolerance = 3e-4, .fault = 4e-3, .plausible = kFarthestEyelet_m}}),
        index_(index) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.cables[At(index_)].pull_point_m += z;
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot->cables[At(index_)].path_m.col(0) += z;
    return true;
  }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(parameter);
    auto sum = std::make_unique<SumOfParameters>();
    sum->Add(1.0, robot::PullPointMove(index_, direction, robot::CableZero::kKept));
    if (at.observed.timeline.by_tension[At(index_)]) return sum;
    // Zeroed in the shape of that time, which a bent body no longer has.
    const robot::BodyCable& cable = at.hypothesis.body.cables[At(index_)];
    const Eigen::Vector3d last_m =
        cable.pull_point_m - cable.eyelets.front().weights.Position(at.hypothesis.assembled_m);
    Eigen::VectorXd change_m = Eigen::VectorXd::Zero(std::ssize(at.hypothesis.body.cables));
    change_m[index_] = -last_m.normalized().dot(direction);
    sum->Add(1.0, CommandChange(std::move(change_m)));
    return sum;
  }

 private:
  int index_;
};

}  // namespace

void MakeCableRouting(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (std::size_t c = 0; c < inputs.body.cables.size(); ++c) {
    faults->push_back(
        std::make_unique<CableRouting>(inputs.body.cables[c].name, static_cast<int>(c)));
  }
  MakeCableGuides(inputs, faults);
}

namespace {

/// z = 1: each of two actuators pulls the other's cable; 0: its own. Nothing between is possible.
class SwappedCables final : public FaultModel {
 public:
  SwappedCables(const CatalogueInputs& inputs, int a, int b)
      : FaultModel(
            {"swapped_cables", {"cable:" + NameOf(inputs, a), "cable:" + NameOf(inputs, b)}},
            "cables " + NameOf(inputs, a) + " and " + NameOf(inputs, b) + " swapped",
            {{.name = "swapped", .fault = 0.02, .fault_at = 1.0, .least = 0.0, .most = 1.0}}),
        a_(a),
        b_(b) {}

  bool OnActuators() const override { return true; }

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    Eigen::MatrixXd& mixing = hypothesis->actuators.mixing;
    const Eigen::RowVectorXd row_a = mixing.row(a_);
    const Eigen::RowVectorXd row_b = mixing.row(b_);
    mixing.row(a_) += z[0] * (row_b - row_a);
    mixing.row(b_) += z[0] * (row_a - row_b);
  }

  /// Each actuator keeps its name and its limits, and pulls what the other one pulled.
  bool Extend(const Eigen::VectorXd& /*z*/, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    robot::CableSettings& a = robot->cables[At(a_)];
    robot::CableSettings& b = robot->cables[At(b_)];
    std::swap(a.path_m, b.path_m);
    std::swap(a.guide_radius_m, b.guide_radius_m);
    std::swap(a.friction_coefficient, b.friction_coefficient);
    return true;
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& /*z*/,
                                      const Eigen::MatrixXd& /*covariance*/,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    return {};
  }

 private:
  static const std::string& NameOf(const CatalogueInputs& inputs, int cable) {
    return inputs.body.cables[At(cable)].name;
  }

  Eigen::Index a_;
  Eigen::Index b_;
};

}  // namespace

void MakeSwappedCables(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const auto cables = static_cast<int>(inputs.body.cables.size());
  for (int a = 0; a < cables; ++a) {
    for (int b = a + 1; b < cables; ++b) {
      faults->push_back(std::make_unique<SwappedCables>(inputs, a, b));
    }
  }
}

}  // namespace palpate::diagnosis

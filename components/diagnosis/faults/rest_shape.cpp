// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/Geometry>
#include <cmath>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/linalg/qr.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// The body is larger about the middle of its base; the points that cables are pulled from stay on
/// the ground, and the actuators are zeroed on it as it is.
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

void MakeGeometryScale(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  faults->push_back(std::make_unique<GeometryScale>(MiddleOfBase(inputs.body)));
}

namespace {

constexpr double kFault_rad = 0.1;  ///< of the far end

/// The body was cast twisted about the way from the middle of its base to its own.
class RestTwist final : public FaultModel {
 public:
  RestTwist(const Eigen::Vector3d& middle_m, const Eigen::Vector3d& axis, double length_m)
      : FaultModel({"rest_twist", {"body"}}, "twist of the undeformed body",
                   {{.name = "rate_rad_m", .fault = kFault_rad / length_m}}),
        middle_m_(middle_m),
        axis_(axis) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    Eigen::Matrix3Xd& nodes_m = hypothesis->body.mesh.nodes_m;
    for (Eigen::Index node = 0; node < nodes_m.cols(); ++node) {
      if (hypothesis->body.fixed.col(node).all()) continue;
      const Eigen::Vector3d arm_m = nodes_m.col(node) - middle_m_;
      const Eigen::AngleAxisd turn(z[0] * arm_m.dot(axis_), axis_);
      const Eigen::Vector3d motion_m = turn * arm_m - arm_m;
      nodes_m.col(node) += motion_m;
      hypothesis->assembled_m.segment<3>(3 * node) += motion_m;
    }
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& at) const override {
    const Eigen::Matrix3Xd& nodes_m = at.hypothesis.body.mesh.nodes_m;
    Eigen::VectorXd mode_m = Eigen::VectorXd::Zero(nodes_m.size());
    for (Eigen::Index node = 0; node < nodes_m.cols(); ++node) {
      if (at.hypothesis.body.fixed.col(node).all()) continue;
      const Eigen::Vector3d arm_m = nodes_m.col(node) - middle_m_;
      mode_m.segment<3>(3 * node) = arm_m.dot(axis_) * axis_.cross(arm_m);
    }
    return robot::RestShapeMode(std::move(mode_m), robot::CableZero::kOfChangedShape,
                                robot::MassRule::kNodalKept);
  }

 private:
  Eigen::Vector3d middle_m_;
  Eigen::Vector3d axis_;
};

}  // namespace

void MakeRestTwist(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const Eigen::Vector3d middle_m = MiddleOfBase(inputs.body);
  const Eigen::Vector3d along_m = inputs.body.mesh.nodes_m.rowwise().mean() - middle_m;
  if (along_m.norm() == 0.0) return;
  const Eigen::Vector3d axis = along_m.normalized();
  const double length_m =
      (axis.transpose() * (inputs.body.mesh.nodes_m.colwise() - middle_m)).maxCoeff();
  faults->push_back(std::make_unique<RestTwist>(middle_m, axis, length_m));
}

namespace {

constexpr Eigen::Index kModes = 5;

/// What a body is easily bent to, the softest first.
struct SoftShapes {
  Eigen::MatrixXd nodal;       ///< [3n x kModes] at rest, largest displacement 1
  Eigen::VectorXd compliance;  ///< [kModes] in proportion to the softest one's
};

/// By subspace iteration on the inverse of the stiffness at rest. Empty where it has none.
SoftShapes SoftestShapes(const robot::RobotBody& body) {
  constexpr int kIterations = 25;
  fem::ElasticBody elastic(body.mesh, body.materials, body.material_of_cell,
                           robot::EmbeddedFibres(body.fibres));
  fem::Linearisation linearisation(elastic, {}, body.fixed);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(elastic.rest_m().size());
  if (!linearisation.Update(elastic.rest_m(), {}, none).ok()) return {};
  Eigen::MatrixXd shapes(linearisation.Size(), kModes);
  for (Eigen::Index k = 0; k < kModes; ++k) {
    // Of any symmetry: no mode is left out.
    shapes.col(k) =
        Eigen::VectorXd::LinSpaced(shapes.rows(), 0.0, 7.0 + 3.0 * static_cast<double>(k))
            .array()
            .sin();
  }
  SoftShapes soft;
  for (int i = 0; i < kIterations; ++i) {
    linearisation.Solve(shapes);
    const linalg::ThinQr qr = linalg::DecomposeQr(shapes);
    soft.compliance = qr.R_diagonal.cwiseAbs();
    shapes = qr.Q;
  }
  soft.compliance /= soft.compliance.maxCoeff();
  soft.nodal = Eigen::MatrixXd::Zero(none.size(), kModes);
  for (Eigen::Index k = 0; k < kModes; ++k) {
    linearisation.matrix().AddExpanded(shapes.col(k), 1.0, soft.nodal.col(k));
    soft.nodal.col(k) /= soft.nodal.col(k).reshaped(3, none.size() / 3).colwise().norm().maxCoeff();
  }
  return soft;
}

/// What bent a body for good bent it by its compliance, so that it is in its softest shapes that it
/// stays bent the most. What it was built with may be any of them.
std::vector<FaultParameter> PartsOfShapes(const Eigen::VectorXd& compliance) {
  constexpr double kTolerance_m = 1e-4;
  constexpr double kSoftest_m = 3e-3;
  std::vector<FaultParameter> parts;
  for (const double softness : compliance) {
    const double fault_m = std::hypot(kTolerance_m, kSoftest_m * softness);
    parts.push_back(
        {.name = "tip_m", .tolerance = kTolerance_m, .fault = fault_m, .component = true});
  }
  return parts;
}

/// The body was bent for good after the actuators were zeroed, in a mixture of its softest shapes.
class PlasticSet final : public FaultModel {
 public:
  explicit PlasticSet(SoftShapes soft)
      : FaultModel({"plastic_set", {"body"}}, "bent rest shape of the body",
                   PartsOfShapes(soft.compliance)),
        shapes_(std::move(soft.nodal)) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->body.mesh.nodes_m += (shapes_ * z).reshaped(3, hypothesis->body.mesh.NodeCount());
  }

  robot::ParameterPtr OnBody(int parameter, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::RestShapeMode(shapes_.col(parameter), robot::CableZero::kKept,
                                robot::MassRule::kNodalKept);
  }

  /// The largest displacement.
  std::vector<FittedParameter> Report(const Eigen::VectorXd& z, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    const Eigen::Index nodes = shapes_.rows() / 3;
    Eigen::Index most = 0;
    (shapes_ * z).reshaped(3, nodes).colwise().norm().maxCoeff(&most);
    const Eigen::MatrixXd there = shapes_.middleRows(3 * most, 3);
    return {SizeOf("tip_m", there * z, there * covariance * there.transpose())};
  }

 private:
  Eigen::MatrixXd shapes_;  ///< [3n x modes] m per z
};

}  // namespace

void MakePlasticSet(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  SoftShapes soft = SoftestShapes(inputs.body);
  if (soft.nodal.size() == 0) return;
  faults->push_back(std::make_unique<PlasticSet>(std::move(soft)));
}

}  // namespace palpate::diagnosis

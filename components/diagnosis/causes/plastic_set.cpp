// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>

#include "components/diagnosis/causes/makers.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/fem/linearisation.hpp"
#include "libs/linalg/qr.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

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
  fem::ElasticBody elastic(body.mesh, body.materials, body.material_of_cell);
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

/// The body was bent for good after the drives were zeroed, in a mixture of its softest shapes.
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

void MakePlasticSet(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  SoftShapes soft = SoftestShapes(world.body);
  if (soft.nodal.size() == 0) return;
  causes->push_back(std::make_unique<PlasticSet>(std::move(soft)));
}

}  // namespace palpate::diagnosis

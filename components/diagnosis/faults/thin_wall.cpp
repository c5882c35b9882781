// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <utility>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/shape_functions.hpp"
#include "libs/robot/sensitivity/parameters.hpp"
#include "libs/robot/wall_thinning.hpp"

namespace palpate::diagnosis {

namespace {

/// A core of the mould that is too thick: the chamber is larger, its outside as drawn.
class ThinWall final : public FaultModel {
 public:
  ThinWall(const std::string& chamber, Eigen::VectorXd mode_m, Eigen::VectorXd mass_kg)
      : FaultModel({"thin_wall", {"chamber:" + chamber}},
                   "wall of chamber " + chamber + " thinner than drawn",
                   {{.name = "thinner_m", .tolerance = 1e-4, .fault = 5e-4, .plausible = 3e-3}}),
        mode_m_(std::move(mode_m)),
        mass_kg_(std::move(mass_kg)) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    Eigen::Matrix3Xd& nodes_m = hypothesis->body.mesh.nodes_m;
    nodes_m += z[0] * mode_m_.reshaped(3, nodes_m.cols());
    hypothesis->assembled_m += z[0] * mode_m_;
    hypothesis->body.node_mass_kg += z[0] * mass_kg_;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::RestShapeMode(mode_m_, robot::CableZero::kOfChangedShape,
                                robot::MassRule::kDensityKept);
  }

 private:
  Eigen::VectorXd mode_m_;   ///< [3n] per m
  Eigen::VectorXd mass_kg_;  ///< [n] change of the nodes' masses per m
};

/// [n] of nodes that `mode_m` moves, by the volume of their cells.
Eigen::VectorXd MassChange_kg(const robot::RobotBody& body, const Eigen::VectorXd& mode_m) {
  constexpr double kStep_m = 1e-6;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(body.mesh.CellCount());
  const Eigen::VectorXd volume_m3 = fem::ConsistentNodalMass_kg(body.mesh, ones);
  fem::TetMesh thinner = body.mesh;
  thinner.nodes_m += kStep_m * mode_m.reshaped(3, body.mesh.NodeCount());
  const Eigen::VectorXd change_m3 = fem::ConsistentNodalMass_kg(thinner, ones) - volume_m3;
  return body.node_mass_kg.sum() / volume_m3.sum() / kStep_m * change_m3;
}

}  // namespace

void MakeThinWall(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const robot::RobotBody& body = inputs.body;
  for (const robot::BodyChamber& chamber : body.chambers) {
    Eigen::VectorXd mode_m = robot::WallThinning(body.mesh, body.boundary, chamber.wall);
    Eigen::VectorXd mass_kg = MassChange_kg(body, mode_m);
    faults->push_back(
        std::make_unique<ThinWall>(chamber.name, std::move(mode_m), std::move(mass_kg)));
  }
}

}  // namespace palpate::diagnosis

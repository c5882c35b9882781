// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <Eigen/LU>
#include <algorithm>
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
  /// `most_m`: farther either way the mesh cannot go.
  ThinWall(const std::string& chamber, double most_m, Eigen::VectorXd mode_m,
           Eigen::VectorXd mass_kg)
      : FaultModel({"thin_wall", {"chamber:" + chamber}},
                   "wall of chamber " + chamber + " thinner than drawn",
                   {{.name = "thinner_m",
                     .tolerance = 1e-4,
                     .fault = 5e-4,
                     .least = -most_m,
                     .most = most_m}}),
        most_m_(most_m),
        mode_m_(std::move(mode_m)),
        mass_kg_(std::move(mass_kg)) {}

  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    const double thinner_m = std::clamp(z[0], -most_m_, most_m_);
    Eigen::Matrix3Xd& nodes_m = hypothesis->body.mesh.nodes_m;
    nodes_m += thinner_m * mode_m_.reshaped(3, nodes_m.cols());
    hypothesis->assembled_m += thinner_m * mode_m_;
    hypothesis->body.node_mass_kg += thinner_m * mass_kg_;
  }

  robot::ParameterPtr OnBody(int /*parameter*/, const Eigen::VectorXd& /*z*/,
                             const FaultContext& /*at*/) const override {
    return robot::RestShapeMode(mode_m_, robot::CableZero::kOfChangedShape,
                                robot::MassRule::kDensityKept);
  }

 private:
  double most_m_;
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

/// [cells] six times the volume between the corners, m3.
Eigen::VectorXd CornerVolumes_m3(const fem::TetMesh& mesh, const Eigen::Matrix3Xd& nodes_m) {
  Eigen::VectorXd volumes_m3(mesh.CellCount());
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Matrix3d edges_m;
    for (int k = 0; k < 3; ++k) {
      edges_m.col(k) = nodes_m.col(mesh.cells(k + 1, cell)) - nodes_m.col(mesh.cells(0, cell));
    }
    volumes_m3[cell] = edges_m.determinant();
  }
  return volumes_m3;
}

/// How far the wall can go, either way, until a cell has lost most of its volume.
double MostMotion_m(const fem::TetMesh& mesh, const Eigen::VectorXd& mode_m) {
  constexpr double kFarthest_m = 3e-3;
  constexpr double kSmaller = 0.8;
  constexpr double kLeastVolume = 0.2;
  const Eigen::VectorXd drawn_m3 = CornerVolumes_m3(mesh, mesh.nodes_m);
  const auto is_possible = [&](double motion_m) {
    const Eigen::Matrix3Xd nodes_m = mesh.nodes_m + motion_m * mode_m.reshaped(3, mesh.NodeCount());
    const Eigen::VectorXd volumes_m3 = CornerVolumes_m3(mesh, nodes_m);
    return (volumes_m3.array() > kLeastVolume * drawn_m3.array()).all();
  };
  double most_m = kFarthest_m;
  while (most_m > 1e-6 && !(is_possible(most_m) && is_possible(-most_m))) most_m *= kSmaller;
  return most_m;
}

}  // namespace

void MakeThinWall(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const robot::RobotBody& body = inputs.body;
  for (const robot::BodyChamber& chamber : body.chambers) {
    Eigen::VectorXd mode_m = robot::WallThinning(body.mesh, body.boundary, chamber.wall);
    Eigen::VectorXd mass_kg = MassChange_kg(body, mode_m);
    const double most_m = MostMotion_m(body.mesh, mode_m);
    faults->push_back(
        std::make_unique<ThinWall>(chamber.name, most_m, std::move(mode_m), std::move(mass_kg)));
  }
}

}  // namespace palpate::diagnosis

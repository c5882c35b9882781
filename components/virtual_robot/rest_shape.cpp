// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/rest_shape.hpp"

#include <Eigen/Geometry>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/elastic_body.hpp"
#include "libs/fem/node_matrix.hpp"
#include "libs/robot/wall_thinning.hpp"

namespace palpate::virtual_robot {

namespace {

/// Shape of the lowest mode of vibration [3 x n] about rest, largest displacement 1, by inverse
/// iteration from a push that favours no axis of a symmetric robot; of modes of equal frequency
/// the mixture that this push excites. The largest displacement points along that push.
Eigen::Matrix3Xd LowestMode(const BenchBody& body) {
  constexpr int kIterations = 30;
  const Eigen::Vector3d kPush(1.0, 0.5, 0.2);
  fem::ElasticBody elastic(body.mesh, body.materials, body.material_of_cell,
                           robot::EmbeddedFibres(body.fibres));
  fem::Linearisation linearisation(elastic, {}, body.fixed);
  fem::NodeMatrix mass(body.mesh);
  fem::AddConsistentMass(
      body.mesh, Eigen::VectorXd::Constant(body.mesh.CellCount(), body.density_kg_m3), &mass);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(elastic.rest_m().size());
  const Status factorised = linearisation.Update(elastic.rest_m(), {}, none);
  if (!factorised.ok()) throw InputError("plastic_set: the body at rest has no stiffness");
  Eigen::VectorXd mode = kPush.replicate(body.mesh.NodeCount(), 1);
  Eigen::MatrixXd load(linearisation.Size(), 1);
  for (int k = 0; k < kIterations; ++k) {
    Eigen::VectorXd inertia = Eigen::VectorXd::Zero(mode.size());
    mass.AddProduct(mode, 1.0, inertia);
    linearisation.matrix().Reduce(inertia, load.col(0));
    linearisation.Solve(load);
    mode.setZero();
    linearisation.matrix().AddExpanded(load.col(0), 1.0, mode);
    mode /= mode.norm();
  }
  Eigen::Matrix3Xd shape = mode.reshaped(3, body.mesh.NodeCount());
  Eigen::Index tip = 0;
  const double largest = shape.colwise().norm().maxCoeff(&tip);
  return shape / (shape.col(tip).dot(kPush) < 0.0 ? -largest : largest);
}

void Scale(const scenario::ActiveEffect& effect, BenchBody* body) {
  const double factor = PositiveValue(effect, "factor");
  const Eigen::Vector3d origin_m = FindBodyAxis(body->nominal, body->fixed).origin_m;
  body->mesh.nodes_m += (factor - 1.0) * (body->mesh.nodes_m.colwise() - origin_m);
}

void Twist(const scenario::ActiveEffect& effect, BenchBody* body) {
  const double rate_rad_m = Value(effect, "rate_rad_m");
  const BodyAxis axis = FindBodyAxis(body->nominal, body->fixed);
  for (int node = 0; node < body->mesh.NodeCount(); ++node) {
    if (body->fixed.col(node).all()) continue;
    const Eigen::Vector3d from_clamp_m = body->mesh.nodes_m.col(node) - axis.origin_m;
    const double angle_rad = rate_rad_m * from_clamp_m.dot(axis.direction);
    body->mesh.nodes_m.col(node) =
        axis.origin_m + Eigen::AngleAxisd(angle_rad, axis.direction) * from_clamp_m;
  }
}

void Thin(const scenario::ActiveEffect& effect, BenchBody* body) {
  std::vector<std::string> names;
  for (const robot::BodyChamber& chamber : body->chambers) names.push_back(chamber.name);
  const robot::BodyChamber& chamber = body->chambers[At(PlaceOf(effect, "chamber", names))];
  const Eigen::VectorXd mode_m = robot::WallThinning(body->nominal, body->boundary, chamber.wall);
  body->mesh.nodes_m += Value(effect, "thinner_m") * mode_m.reshaped(3, body->mesh.NodeCount());
}

void Set(const scenario::ActiveEffect& effect, BenchBody* body) {
  const double tip_m = Value(effect, "tip_m");
  if (tip_m != 0.0) body->mesh.nodes_m += tip_m * LowestMode(*body);
}

}  // namespace

BodyAxis FindBodyAxis(const fem::TetMesh& mesh, const fem::FixedDirections& fixed) {
  BodyAxis axis;
  int held = 0;
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    if (!fixed.col(node).all()) continue;
    axis.origin_m += mesh.nodes_m.col(node);
    ++held;
  }
  axis.origin_m /= held;
  const Eigen::Vector3d along_m = mesh.nodes_m.rowwise().mean() - axis.origin_m;
  if (along_m.norm() > 0.0) axis.direction = along_m.normalized();
  return axis;
}

void ApplyRestShapeEffects(const Effects& effects, BenchBody* body) {
  for (const auto* effect : OfKind(effects, "thin_wall")) Thin(*effect, body);
  for (const auto* effect : OfKind(effects, "geometry_scale")) Scale(*effect, body);
  for (const auto* effect : OfKind(effects, "rest_twist")) Twist(*effect, body);
  body->assembled_m = body->rest_m();
  for (const auto* effect : OfKind(effects, "plastic_set")) Set(*effect, body);
}

}  // namespace palpate::virtual_robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/view/robot/known_robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/core/names.hpp"
#include "libs/core/statistics.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/linalg/qr.hpp"
#include "libs/robot/compliance.hpp"

namespace palpate::view {

namespace {

/// [rows] motion of the rows for a newton, while taut cables keep their lengths.
Eigen::VectorXd MotionPerNewton(const robot::Compliance& compliance,
                                const Eigen::VectorXd& tension_N) {
  std::vector<Eigen::Index> taut;
  for (Eigen::Index cable = 0; cable < tension_N.size(); ++cable) {
    if (!(tension_N[cable] <= 0.0)) taut.push_back(cable);
  }
  Eigen::VectorXd motion_m_N = compliance.W_ef().col(0);
  if (taut.empty()) return motion_m_N;
  const Eigen::MatrixXd W_aa_m_N = compliance.W_aa()(taut, taut);
  const Eigen::VectorXd W_af_m_N = compliance.W_af()(taut, 0);
  // Cables along one path are dependent.
  const Eigen::VectorXd pull = linalg::LeastSquares(W_aa_m_N, W_af_m_N);
  motion_m_N -= compliance.W_ea()(Eigen::all, taut) * pull;
  return motion_m_N;
}

}  // namespace

/// Shapes are looked at: a thousandth of a pixel is enough, and a tangent serves several frames.
KnownRobot::KnownRobot(robot::RobotBody body)
    : model_(std::move(body), {.relative_tolerance = 1e-7, .keep_tangent_below = 0.3}) {}

std::map<std::string, Eigen::Matrix3Xf> KnownRobot::CablePaths(const Eigen::VectorXd& x_m) const {
  PALPATE_CHECK(x_m.size() == 3 * NodeCount());
  std::map<std::string, Eigen::Matrix3Xf> paths_m;
  for (int cable = 0; cable < model_.CableCount(); ++cable) {
    paths_m[model_.traits(cable).name] = model_.cable(cable).Path_m(x_m).cast<float>();
  }
  return paths_m;
}

Eigen::Matrix3Xf KnownRobot::FixedSurfaceNodes_m() const {
  const Eigen::Matrix3Xi triangles = body().boundary.DrawnTriangles();
  std::set<int> fixed;
  for (const int node : triangles.reshaped()) {
    if (body().fixed.col(node).all()) fixed.insert(node);
  }
  const std::vector<int> nodes(fixed.begin(), fixed.end());
  return body().mesh.nodes_m(Eigen::all, nodes).cast<float>();
}

bool KnownRobot::SetYoungsModulus(const std::string& part, double youngs_modulus_Pa) {
  const auto region = IndexOf(part, body().region_names);
  if (!region && part != "body") return false;
  const int material = region ? static_cast<int>(*region) + 1 : 0;
  if (body().materials[At(material)].youngs_modulus_Pa == youngs_modulus_Pa) return false;
  model_.SetYoungsModulus(material, youngs_modulus_Pa);
  return true;
}

std::vector<float> KnownRobot::Stiffness_Pa(const PageSurface& surface) const {
  if (surface.hash != body().mesh_hash || surface.node_count != NodeCount()) return {};
  Eigen::VectorXd sum_Pa = Eigen::VectorXd::Zero(NodeCount());
  Eigen::VectorXd cells = Eigen::VectorXd::Zero(NodeCount());
  for (Eigen::Index cell = 0; cell < body().mesh.cells.cols(); ++cell) {
    const int material = body().material_of_cell[At(cell)];
    for (const int node : body().mesh.cells.col(cell)) {
      sum_Pa[node] += body().materials[At(material)].youngs_modulus_Pa;
      cells[node] += 1.0;
    }
  }
  std::vector<float> stiffness_Pa;
  for (const Eigen::Index node : surface.nodes) {
    stiffness_Pa.push_back(static_cast<float>(sum_Pa[node] / cells[node]));
  }
  return stiffness_Pa;
}

Eigen::Matrix3Xd KnownRobot::MarkersAt(const std::vector<std::string>& names,
                                       const Eigen::VectorXd& x_m) const {
  Eigen::Matrix3Xd markers_m = Eigen::Matrix3Xd::Constant(3, ToIndex(names.size()),
                                                          std::numeric_limits<double>::quiet_NaN());
  const std::vector<std::string> known = model_.MarkerNames();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto marker = IndexOf(names[k], known);
    if (marker) markers_m.col(ToIndex(k)) = body().markers[*marker].point.weights.Position(x_m);
  }
  return markers_m;
}

fem::InterpolationWeights KnownRobot::PlaceNear(const Eigen::Vector3d& position_m,
                                                const Eigen::VectorXd& x_m) const {
  const geometry::SurfaceIndex surface(
      {x_m.reshaped(3, NodeCount()), body().boundary.CornerTriangles()});
  const geometry::SurfacePoint nearest = surface.Closest(position_m);
  const Eigen::Vector3i corners = surface.surface().triangles.col(nearest.triangle);
  std::map<int, double> weight_of_node;  // in rising order
  for (Eigen::Index k = 0; k < 3; ++k) weight_of_node[corners[k]] = nearest.barycentric[k];
  fem::InterpolationWeights place;
  for (const auto& [node, weight] : weight_of_node) {
    place.nodes.push_back(node);
    place.weights.push_back(weight);
  }
  return place;
}

Status KnownRobot::SmallestForce(const ProbedPlace& place, const Eigen::VectorXd& x_m,
                                 const Eigen::VectorXd& tension_N, const MeasuredRows& measured,
                                 double significance, double* force_N) {
  PALPATE_CHECK(x_m.size() == 3 * NodeCount());
  PALPATE_CHECK(tension_N.size() == model_.ActuatorCount());
  PALPATE_CHECK(measured.rows.size() == measured.sigma_m.size());
  if (measured.rows.empty()) {
    return {StatusCode::kNoRobotSeen, "nothing of the robot is measured now"};
  }
  Eigen::VectorXd pull_N = tension_N.array().isNaN().select(0.0, tension_N);
  for (int a = 0; a < model_.ActuatorCount(); ++a) {
    pull_N[a] = std::max(pull_N[a], model_.traits(a).least_force_N);
  }
  fem::Linearisation& linearisation = model_.linearisation();
  const Eigen::VectorXd no_force_N = Eigen::VectorXd::Zero(x_m.size());
  if (!linearisation.Update(x_m, pull_N, no_force_N).ok()) {
    return {StatusCode::kNotPositiveDefinite,
            "the model has no stable stiffness at this shape of the robot"};
  }
  const fem::SurfacePatch patch = model_.Patch(place.rest_m, place.radius_m);
  robot::Compliance compliance(linearisation, measured.rows);
  compliance.SetForces({robot::ForceDirection{patch.weights, -patch.normal}});
  compliance.Compute(x_m, model_.actuator_rest_m(), pull_N, Eigen::VectorXd::Zero(1));
  const Eigen::VectorXd motion_m_N = MotionPerNewton(compliance, tension_N);
  const Eigen::Map<const Eigen::VectorXd> sigma_m(measured.sigma_m.data(),
                                                  ToIndex(measured.sigma_m.size()));
  const double information_1_N2 = (motion_m_N.array() / sigma_m.array()).square().sum();
  const double smallest_N = NormalQuantile(1.0 - significance) / std::sqrt(information_1_N2);
  if (!std::isfinite(smallest_N)) {
    return {StatusCode::kUnobservable, "a force here moves nothing that is measured"};
  }
  *force_N = smallest_N;
  return Status::Ok();
}

}  // namespace palpate::view

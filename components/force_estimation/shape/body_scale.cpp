// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/body_scale.hpp"

#include <vector>

#include "components/force_estimation/shape/observation_jacobian.hpp"
#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/geometry/box.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

BodyScale ScaleOf(const robot::RobotBody& body) {
  std::vector<robot::ObservationRow> rows;
  for (std::size_t f = 0; f < body.feature_points.size(); ++f) {
    rows.push_back(
        robot::RowOfPoint(body.feature_points[f].weights, body.feature_normals.col(ToIndex(f))));
  }
  // A model of its own: a factor that another one keeps would change what is solved with it next.
  robot::RobotModel model(body);
  const fem::StaticState rest = model.RestState();
  const Eigen::VectorXd& x_m = rest.x_m;
  const std::vector<robot::ActuatorCommand> loose(
      At(model.ActuatorCount()), {.kind = robot::ActuatorCommand::Kind::kTension, .value = 0.0});
  Status status = model.linearisation().Update(x_m, rest.multipliers_N,
                                               Eigen::VectorXd::Zero(x_m.size()), true);
  ObservationJacobian responses;
  if (status.ok())
    status = responses.Add(model, rows, x_m, loose, Eigen::VectorXd::Zero(model.ActuatorCount()));
  PALPATE_CHECK(status.ok(), status.message());
  std::vector<double> compliances_m_N;
  for (std::size_t f = 0; f < rows.size(); ++f) {
    const Eigen::MatrixX3d to_point = responses.To(body.feature_points[f].weights);
    const double compliance_m_N = to_point.row(ToIndex(f)) * body.feature_normals.col(ToIndex(f));
    if (compliance_m_N > 0.0) compliances_m_N.push_back(compliance_m_N);
  }
  if (compliances_m_N.empty()) {
    throw InputError("feature_points: none is on a part of the body that can move");
  }
  const double length_m = geometry::BoundingBox(body.mesh.nodes_m).Diagonal_m();
  return {.length_m = length_m, .force_N = length_m / Median(compliances_m_N)};
}

}  // namespace palpate::force_estimation

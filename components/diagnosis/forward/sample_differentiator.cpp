// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/sample_differentiator.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "components/diagnosis/forward/simulator.hpp"
#include "components/diagnosis/forward/sum_of_parameters.hpp"
#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

/// Derivatives of markers are computed only if a sample has some.
bool SeesMarkers(const ObservedExperiment& observed) {
  return !observed.HasSurface() ||
         std::any_of(observed.samples.begin(), observed.samples.end(),
                     [](const Sample& sample) { return (sample.count.array() > 0).any(); });
}

}  // namespace

std::vector<Eigen::MatrixXd> ActuatorChanges(const ActuatorChain& train,
                                             const ModelHypothesis& nominal,
                                             const FaultModelList& models, const Eigen::VectorXd& z,
                                             const std::vector<bool>& wanted,
                                             const ActuatorSettings& drives) {
  constexpr double kStep = 1e-4;  // of the parameter's fault sigma
  const Eigen::MatrixXd taken_in = train.At(drives);
  std::vector<Eigen::MatrixXd> changes;
  Eigen::Index column = 0;
  for (std::size_t k = 0; k < models.size(); ++k) {
    for (const FaultParameter& parameter : models[k]->parameters()) {
      changes.emplace_back();
      const double forward = kStep * parameter.fault;
      // Beyond what can be, nothing changes any more.
      const double step = z[column] + forward > parameter.most ? -forward : forward;
      Eigen::VectorXd beside = z;
      beside[column++] += step;
      if (!wanted[k] || !models[k]->OnActuators()) continue;
      changes.back() =
          (train.At(HypothesisWith(nominal, models, beside).actuators) - taken_in) / step;
    }
  }
  return changes;
}

std::vector<SampleDifferentiator::WantedParameter> SampleDifferentiator::Wanted(
    const FaultModelList& models, const Eigen::VectorXd& z, const std::vector<bool>& wanted) {
  std::vector<WantedParameter> parameters;
  Eigen::Index column = 0;
  for (std::size_t k = 0; k < models.size(); ++k) {
    const auto count = std::ssize(models[k]->parameters());
    const Eigen::VectorXd own = z.segment(column, count);
    for (int p = 0; p < count; ++p, ++column) {
      if (wanted[k]) parameters.push_back({models[k], p, column, own});
    }
  }
  return parameters;
}

SampleDifferentiator::SampleDifferentiator(const ModelHypothesis& hypothesis,
                                           const FaultModelList& models, const Eigen::VectorXd& z,
                                           const std::vector<bool>& wanted,
                                           const std::vector<Eigen::MatrixXd>& actuator_change,
                                           const ObservedExperiment& observed, SampleSolver* solver)
    : hypothesis_(hypothesis),
      parameters_(Wanted(models, z, wanted)),
      parameter_count_(z.size()),
      actuator_change_(actuator_change),
      solver_(*solver),
      markers_seen_(SeesMarkers(observed)),
      marker_rows_(robot::RowsOfPoints(solver->markers())),
      of_rows_(solver->model(), std::vector<robot::ObservationRow>()),
      of_body_(solver->model()) {}

void SampleDifferentiator::Collect(const FaultContext& at) {
  acting_.clear();
  column_of_.clear();
  for (const WantedParameter& one : parameters_) {
    const Eigen::MatrixXd& change = actuator_change_[palpate::At(one.column)];
    auto sum = std::make_unique<SumOfParameters>();
    if (change.size() > 0 && !change.col(at.sample).isZero(0.0)) {
      sum->Add(1.0, CommandChange(
                        change.col(at.sample).array().isNaN().select(0.0, change.col(at.sample))));
    }
    if (robot::ParameterPtr body = one.fault->OnBody(one.number, one.z, at)) {
      sum->Add(1.0, std::move(body));
    }
    if (sum->empty()) continue;
    acting_.push_back(std::move(sum));
    column_of_.push_back(one.column);
  }
}

/// What stands in the body's way, in the robot frame, after all else.
Status SampleDifferentiator::AddPushes(const FaultContext& at, Eigen::MatrixXd* jacobian_m) {
  std::vector<Push> pushes;
  std::vector<Eigen::Index> first_of;
  std::vector<robot::ParameterPtr> forces;
  for (const WantedParameter& one : parameters_) {
    if (one.number > 0) continue;  // the fault was asked
    std::optional<Push> push = one.fault->PushOf(one.z, at);
    if (!push) continue;
    forces.push_back(robot::NodalForce(push->force_N));
    pushes.push_back(std::move(*push));
    first_of.push_back(one.column);
  }
  if (pushes.empty()) return Status::Ok();
  fem::StaticState let_go = at.shape.state;
  if (hypothesis_.obstacle) let_go.multipliers_N.tail<1>().setZero();
  const Status known =
      of_body_.Compute(at.shape.commands, let_go, forces,
                       hypothesis_.obstacle ? robot::Factor::kRenew : robot::Factor::kPresent);
  if (!known.ok()) return known;
  Eigen::VectorXd nodal_m;
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    of_body_.NodalMotion(static_cast<int>(k), &nodal_m);
    const double gives_way_m = pushes[k].force_N.dot(nodal_m);
    if (!(gives_way_m > 0.0)) continue;  // it acts where the body is held
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const double motion_m = rows_[r].Value(nodal_m);
      for (Eigen::Index p = 0; p < pushes[k].times.size(); ++p) {
        (*jacobian_m)(coordinate_of_[r], first_of[k] + p) +=
            (pushes[k].times[p] + pushes[k].displacement_m[p] / gives_way_m) * motion_m;
      }
    }
  }
  return Status::Ok();
}

/// Rows of a shape are solved once, unless they are of a surface, which each sample has others of,
/// or an obstacle's are solved between them.
Status SampleDifferentiator::ComputeRows(const FaultContext& at) {
  TangentState here = solver_.TangentStateAt(at.shape.state);
  if (rows_at_ && here.IsSame(*rows_at_))
    return of_rows_.ComputeAgain(at.shape.commands, at.shape.state, acting_);
  rows_at_.reset();
  Observe(at);
  const Status status = of_rows_.Compute(at.shape.commands, at.shape.state, acting_);
  if (status.ok() && !at.observed.HasSurface() && !hypothesis_.obstacle) rows_at_ = std::move(here);
  return status;
}

Eigen::MatrixXd SampleDifferentiator::At(const FaultContext& at) {
  Eigen::MatrixXd jacobian_m =
      Eigen::MatrixXd::Zero(at.observed.CoordinateCount(), parameter_count_);
  Collect(at);
  const bool known = at.simulated().status.ok() && ComputeRows(at).ok();
  if (!known) return jacobian_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < column_of_.size(); ++k) {
    jacobian_m(coordinate_of_, column_of_[k]) = of_rows_.motion_m().col(ToIndex(k));
  }
  if (!AddPushes(at, &jacobian_m).ok()) {
    return jacobian_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  if (markers_seen_) ShowTo(at, &jacobian_m);
  ShowSurfaceTo(at, &jacobian_m);
  return jacobian_m;
}

/// Rows of what is measured at this sample: markers where they are on the body, the surface as its
/// camera measures it.
void SampleDifferentiator::Observe(const FaultContext& at) {
  rows_.clear();
  coordinate_of_.clear();
  if (markers_seen_) rows_ = marker_rows_;
  for (std::size_t k = 0; k < rows_.size(); ++k) coordinate_of_.push_back(ToIndex(k));
  const std::vector<SurfaceMeasurement>& surface = at.seen().surface;
  const MeasuredPoints measured_points = solver_.SurfacePointsOf(at.seen(), at.shape.state.x_m);
  const auto recording = static_cast<std::size_t>(at.seen().recording);
  for (std::size_t f = 0; f < surface.size(); ++f) {
    if (surface[f].count == 0) continue;
    const auto feature = ToIndex(f);
    const Eigen::Matrix3d R_camera_robot =
        (*at.recording().T_camera_robot * hypothesis_.T_surface_seen[recording]).linear();
    rows_.push_back(robot::RowOfPoint(
        surface[f].point,
        R_camera_robot.transpose() *
            measured_points.camera->Slope(measured_points.point(feature)).transpose() *
            surface[f].normal));
    coordinate_of_.push_back(std::ssize(marker_rows_) + feature);
  }
  of_rows_.SetRows(rows_);
}

/// From how the markers move on the body to how what is measured of them does. What the body's
/// surface turns by is left out where it is measured askew.
void SampleDifferentiator::ShowTo(const FaultContext& of, Eigen::MatrixXd* jacobian_m) const {
  const auto markers = std::ssize(solver_.markers());
  FaultContext at = of;
  at.target = Target::kMarkers;
  at.measured_points = solver_.MeasuredPointsOf(at.seen(), at.shape.state.x_m);
  std::vector<Eigen::Matrix3d> slopes;  // [markers]
  for (const SeenPoint& point : at.measured_points.points) {
    if (at.measured_points.camera) slopes.push_back(at.measured_points.camera->Slope(point));
  }
  const auto recording = static_cast<std::size_t>(at.seen().recording);
  const Eigen::Matrix3d R_seen = hypothesis_.T_seen[recording].linear();
  const Eigen::Matrix3d R_measurement =
      at.observed.recordings[recording].T_measurement_robot.linear();
  Eigen::Matrix3Xd seen_m(3, markers);
  for (const WantedParameter& one : parameters_) {
    auto column = jacobian_m->col(one.column).head(3 * markers);
    seen_m = R_seen * column.reshaped(3, markers);
    one.fault->OnView(one.number, one.z, at, &seen_m);
    seen_m = R_measurement * seen_m.eval();
    for (Eigen::Index m = 0; m < std::ssize(slopes); ++m) {
      seen_m.col(m) = slopes[palpate::At(m)] * seen_m.col(m).eval();
    }
    if (at.measured_points.camera) one.fault->OnMeasurement(one.number, one.z, at, &seen_m);
    column = seen_m.reshaped();
  }
}

/// Adds what faults do to how the surface is seen where it is; how it moves with the body is there.
void SampleDifferentiator::ShowSurfaceTo(const FaultContext& of,
                                         Eigen::MatrixXd* jacobian_m) const {
  FaultContext at = of;
  at.target = Target::kSurface;
  at.measured_points = solver_.SurfacePointsOf(at.seen(), at.shape.state.x_m);
  if (!at.measured_points.camera) return;
  const std::vector<SurfaceMeasurement>& surface = at.seen().surface;
  const Eigen::Matrix3d R_camera = at.recording().T_camera_robot->linear();
  Eigen::Matrix3Xd seen_m(3, std::ssize(surface));
  for (const WantedParameter& one : parameters_) {
    seen_m.setZero();
    one.fault->OnView(one.number, one.z, at, &seen_m);
    seen_m = R_camera * seen_m.eval();
    for (std::size_t f = 0; f < surface.size(); ++f) {
      if (surface[f].count == 0) continue;
      const auto feature = ToIndex(f);
      seen_m.col(feature) = at.measured_points.camera->Slope(at.measured_points.point(feature)) *
                            seen_m.col(feature).eval();
    }
    one.fault->OnMeasurement(one.number, one.z, at, &seen_m);
    for (std::size_t f = 0; f < surface.size(); ++f) {
      if (surface[f].count == 0) continue;
      const auto feature = ToIndex(f);
      (*jacobian_m)(std::ssize(marker_rows_) + feature, one.column) +=
          surface[f].normal.dot(seen_m.col(feature));
    }
  }
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/sample_solver.hpp"

#include <cmath>
#include <limits>

#include "components/diagnosis/forward/history.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/mullins.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/robot/sensitivity/eyelet_gradient.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::diagnosis {

namespace {

using Kind = robot::ActuatorCommand::Kind;

/// Of loops between equilibrium and what yields under it.
constexpr int kMostRounds = 12;
constexpr double kSettled_rad = 1e-8;
/// By which an obstacle may stand in the undeformed body: what file and mesh may be off.
constexpr double kDeepest_m = 1e-3;

std::vector<fem::InterpolationWeights> MarkerPoints(const ModelHypothesis& hypothesis) {
  std::vector<fem::InterpolationWeights> points;
  for (std::size_t m = 0; m < hypothesis.body.markers.size(); ++m) {
    const fem::BodyPoint& point = hypothesis.body.markers[m].point;
    const Eigen::Vector3d offset_m = hypothesis.marker_offset_m.col(ToIndex(m));
    if (offset_m.isZero()) {
      points.push_back(point.weights);
      continue;
    }
    const fem::InterpolationWeights along =
        robot::EyeletWeightsAlong(*hypothesis.places, point.rest_m, 0.0, offset_m.normalized());
    points.push_back(fem::Combine({point.weights, along}, {1.0, offset_m.norm()}));
  }
  return points;
}

/// A base that does not converge soon has an unphysical compliance.
fem::StaticSettings Settings() {
  return {.relative_tolerance = 1e-9,
          .max_newton_iterations = 20,
          .keep_tangent_below = 0.2,
          .max_load_steps = 12,
          .smallest_load_step = 0.02};
}

std::vector<fem::ScalarConstraint*> AsConstraints(KeptStress* kept, ObstacleContact* obstacle) {
  if (obstacle == nullptr) return {kept};
  return {kept, obstacle};
}

}  // namespace

SampleSolver::SampleSolver(const ModelHypothesis& hypothesis, const ObservedExperiment& observed)
    : hypothesis_(hypothesis),
      observed_(observed),
      points_(hypothesis.body.mesh, hypothesis.body.material_of_cell),
      kept_(hypothesis.body.mesh),
      obstacle_(hypothesis.obstacle ? std::make_unique<ObstacleContact>(*hypothesis.obstacle)
                                    : nullptr),
      model_(hypothesis.body, Settings(), {}, AsConstraints(&kept_, obstacle_.get())),
      eyelets_(robot::RubbingEyelets(hypothesis.body)),
      at_obstacle_(obstacle_ ? std::make_unique<ObstacleBalance>(obstacle_->obstacle(), &model_)
                             : nullptr),
      sensitivity_(model_),
      markers_(MarkerPoints(hypothesis)),
      skin_(hypothesis),
      cell_volume_m3_(fem::CellVolumes_m3(hypothesis.body.mesh)),
      zero_shift_m_(Eigen::VectorXd::Zero(model_.ActuatorCount())),
      base_middle_m_(MiddleOfBase(hypothesis.body)) {
  for (int c = 0; c < model_.CableCount(); ++c) {
    zero_shift_m_[c] =
        model_.cable(c).rest_length_m() - model_.cable(c).Value(hypothesis.assembled_m);
    model_.SetCableCompliance(c, hypothesis.cable_compliance_m_N[c]);
  }
}

std::vector<robot::ActuatorCommand> SampleSolver::Commands(const Eigen::VectorXd& taken_in) const {
  std::vector<robot::ActuatorCommand> commands(static_cast<std::size_t>(taken_in.size()));
  for (Eigen::Index c = 0; c < taken_in.size(); ++c) {
    const auto cable = static_cast<std::size_t>(c);
    if (std::isnan(taken_in[c])) continue;
    if (!observed_.timeline.by_tension[cable]) {
      commands[cable] = {Kind::kDisplacement, taken_in[c] + zero_shift_m_[c]};
      continue;
    }
    double force_N = taken_in[c];
    // A chamber of another size has another piston at the same pressure.
    if (const int chamber = static_cast<int>(c) - model_.CableCount(); chamber >= 0) {
      force_N *= model_.chamber(chamber).area_m2() / observed_.timeline.actuators[cable].area_m2;
    }
    const double least_N = model_.traits(static_cast<int>(c)).least_force_N;
    commands[cable] = {Kind::kTension, std::max(least_N, force_N)};
  }
  return commands;
}

/// Weights that hang along what gravity was assumed to be hang along what it is.
std::vector<robot::DeadLoad> SampleSolver::LoadsAt(const Sample& sample) const {
  const auto& recording = observed_.recordings[At(sample.recording)];
  const Eigen::Matrix3d& R_tilt = recording.base_rotation;
  const Eigen::Vector3d believed =
      (R_tilt.transpose() * hypothesis_.body.gravity_m_s2).normalized();
  std::vector<robot::DeadLoad> loads;
  for (const experiment::KnownLoad& load : sample.loads) {
    const bool hangs = load.force_N.normalized().dot(believed) > kHangs;
    const Eigen::Vector3d force_N =
        hangs ? Eigen::Vector3d((R_tilt * hypothesis_.R_tilt_error).transpose() * R_tilt *
                                load.force_N)
              : load.force_N;
    loads.push_back(
        {fem::MakeSurfacePatch(*hypothesis_.places, load.position_m, load.patch_radius_m).weights,
         force_N});
  }
  const Eigen::Vector3d gravity_m_s2 = GravityIn(hypothesis_, recording);
  for (const CarriedMass& mass : hypothesis_.masses) {
    loads.push_back({mass.weights, mass.mass_kg * gravity_m_s2});
  }
  for (const WorldForce& force : hypothesis_.forces) {
    loads.push_back({force.weights, R_tilt.transpose() * force.force_N});
  }
  return loads;
}

void SampleSolver::Prepare(const Sample& sample, const HistoryVariables& history_variables) {
  const Timeline& timeline = observed_.timeline;
  const double begin_s = timeline.begin_s.front();
  const double share = (sample.t_s - begin_s) / (timeline.end_s.back() - begin_s);
  const double factor =
      (1.0 + hypothesis_.modulus_change_at_end * share) * (1.0 + history_variables.scale);
  for (std::size_t k = 0; k < hypothesis_.body.materials.size(); ++k) {
    model_.SetYoungsModulus(static_cast<int>(k),
                            factor * hypothesis_.body.materials[k].youngs_modulus_Pa);
  }
  if (hypothesis_.mullins) {
    model_.elastic_body().SetCellFactors(history_variables.cell_factor.size() > 0
                                             ? history_variables.cell_factor
                                             : Eigen::VectorXd::Ones(cell_volume_m3_.size()));
  }
  kept_.Set(points_, history_variables.stress_Pa);
  prepared_.modulus_change = hypothesis_.modulus_change_at_end * share;
  prepared_.history_variables = history_variables;
  model_.SetGravity(GravityIn(hypothesis_, observed_.recordings[At(sample.recording)]));
}

void SampleSolver::SetSliding(const Eigen::VectorXd& sliding) {
  prepared_.friction = FrictionOfEyelets();
  if (sliding.size() > 0) prepared_.friction.array() *= sliding.array();
  std::vector<robot::CableFriction> friction;  // [cables]
  for (const robot::BodyCable& cable : hypothesis_.body.cables) {
    friction.push_back({cable.friction_coefficient, {}});
    if (sliding.size() > 0) friction.back().sliding.resize(cable.eyelets.size());
  }
  for (std::size_t k = 0; k < eyelets_.size() && sliding.size() > 0; ++k) {
    friction[At(eyelets_[k].cable)].sliding[At(eyelets_[k].eyelet)] = sliding[ToIndex(k)];
  }
  for (int c = 0; c < model_.CableCount(); ++c) {
    model_.SetCableFriction(c, friction[At(c)]);
  }
}

robot::EyeletSlides SampleSolver::SlidesAboutShape(const HeldShape& shape) {
  if (eyelets_.empty()) return {};
  const TangentState here = TangentStateAt(shape.state);
  if (!here.IsSame(known_slides_.at) || shape.commands != known_slides_.commands) {
    known_slides_ = {
        here, shape.commands,
        robot::SlidesAbout(eyelets_, shape.commands, shape.state, model_, &sensitivity_)};
  }
  return known_slides_.slides;
}

TangentState SampleSolver::TangentStateAt(const fem::StaticState& state) const {
  TangentState here = prepared_;
  here.state = state;
  return here;
}

Status SampleSolver::Balance(const fem::LoadState& loads, HeldShape* shape) {
  if (at_obstacle_)
    return at_obstacle_->Solve(shape->commands, loads, &shape->state, &shape->obstacle_force_N);
  shape->obstacle_force_N.resize(0);
  return model_.static_solver().Solve(loads, &shape->state).status;
}

/// Everything that loads the body at a sample, the base as it stands undeformed.
fem::LoadState SampleSolver::LoadsOf(const Sample& sample,
                                     const std::vector<robot::ActuatorCommand>& commands) const {
  fem::LoadState loads = model_.Loads(commands, LoadsAt(sample));
  loads.commands[At(model_.ActuatorCount())] = kept_.Command();
  if (obstacle_) {
    loads.commands.back() = {.mode = fem::ConstraintCommand::Mode::kMultiplier,
                             .value = ObstacleContact::kThere_N};
  }
  return loads;
}

void SampleSolver::HoldBase(fem::LoadState* loads) const {
  if (base_turn_rad_.isZero()) return;
  const double angle_rad = base_turn_rad_.norm();
  const Eigen::AngleAxisd turn(angle_rad, base_turn_rad_ / angle_rad);
  const Eigen::VectorXd& rest_m = model_.body().mesh.nodes_m.reshaped();
  for (Eigen::Index node = 0; node < rest_m.size() / 3; ++node) {
    loads->fixed_position_m.segment<3>(3 * node) =
        base_middle_m_ + turn * (rest_m.segment<3>(3 * node) - base_middle_m_);
  }
}

/// A step towards the turn that goes with the sample on the base. Sets `moved` where it is not
/// there yet.
Status SampleSolver::TurnBase(const fem::LoadState& loads, const fem::StaticState& state,
                              bool* moved) {
  if (hypothesis_.base_compliance_rad_Nm == 0.0) return Status::Ok();
  fem::Linearisation& linearisation = model_.linearisation();
  const Status known =
      linearisation.UpdateResidual(state.x_m, state.multipliers_N, loads.external_force_N);
  if (!known.ok()) return known;
  Eigen::Vector3d moment_Nm = Eigen::Vector3d::Zero();
  for (Eigen::Index node = 0; node < state.x_m.size() / 3; ++node) {
    if (!model_.body().fixed.col(node).all()) continue;
    const Eigen::Vector3d force_N = linearisation.nodal_residual_N().segment<3>(3 * node);
    moment_Nm += (state.x_m.segment<3>(3 * node) - base_middle_m_).cross(force_N);
  }
  constexpr double kShare = 0.7;  // stiff bodies on soft bases swing otherwise
  const Eigen::Vector3d step_rad = hypothesis_.base_compliance_rad_Nm * moment_Nm - base_turn_rad_;
  base_turn_rad_ += kShare * step_rad;
  if (step_rad.norm() > kSettled_rad) *moved = true;
  return Status::Ok();
}

Status SampleSolver::BalanceOnBase(fem::LoadState loads, HeldShape* shape) {
  base_turn_rad_.setZero();
  for (int round = 0; round < kMostRounds; ++round) {
    bool moved = false;
    HoldBase(&loads);
    Status status = Balance(loads, shape);
    if (status.ok()) status = TurnBase(loads, shape->state, &moved);
    if (!status.ok() || !moved) return status;
  }
  return {StatusCode::kNotConverged, "the base rotation diverges: base compliance too large"};
}

/// [shapes of the mesh's error] so much of each is added to what is seen.
Eigen::VectorXd SampleSolver::MeshErrorAt(const Eigen::VectorXd& x_m) const {
  return hypothesis_.mesh_error_share *
         hypothesis_.mesh_error->BendIn(x_m - hypothesis_.body.mesh.nodes_m.reshaped());
}

Eigen::VectorXd SampleSolver::OnFinerMesh(const Eigen::VectorXd& x_m) const {
  if (hypothesis_.mesh_error_share == 0.0) return x_m;
  return x_m + hypothesis_.mesh_error->of_nodes * MeshErrorAt(x_m);
}

MeasuredPoints SampleSolver::MeasuredPointsOf(const Sample& sample,
                                              const Eigen::VectorXd& x_m) const {
  const auto recording = static_cast<std::size_t>(sample.recording);
  const Eigen::Matrix3Xd& counts_from_m = observed_.recordings[recording].counts_from_m;
  const Eigen::Isometry3d& T_given = observed_.recordings[recording].T_measurement_robot;
  const Eigen::Isometry3d T_measurement_robot = T_given * hypothesis_.T_seen[recording];
  MeasuredPoints measured_points{
      .points = {}, .camera = ViewOf(hypothesis_.camera, observed_, sample, Target::kMarkers)};
  Eigen::VectorXd farther_m = Eigen::VectorXd::Zero(3 * std::ssize(markers_));
  if (hypothesis_.mesh_error_share != 0.0)
    farther_m = hypothesis_.mesh_error->of_markers * MeshErrorAt(x_m);
  for (std::size_t m = 0; m < markers_.size(); ++m) {
    const Eigen::Vector3d at_m = markers_[m].Position(x_m) + farther_m.segment<3>(3 * ToIndex(m));
    Eigen::Vector3d seen_m = T_measurement_robot * at_m;
    if (counts_from_m.size() > 0) {
      const Eigen::Vector3d from_m = counts_from_m.col(ToIndex(m));
      seen_m = T_given * from_m + T_measurement_robot.linear() * (at_m - from_m);
    }
    measured_points.points.push_back({seen_m, T_measurement_robot.linear() * skin_.Normal(m, x_m)});
  }
  return measured_points;
}

MeasuredPoints SampleSolver::SurfacePointsOf(const Sample& sample,
                                             const Eigen::VectorXd& solved_x_m) const {
  const Eigen::VectorXd x_m = OnFinerMesh(solved_x_m);
  const auto recording = static_cast<std::size_t>(sample.recording);
  MeasuredPoints measured_points{
      .points = {}, .camera = ViewOf(hypothesis_.camera, observed_, sample, Target::kSurface)};
  if (!measured_points.camera) return measured_points;
  const Eigen::Isometry3d T_camera_robot =
      *observed_.recordings[recording].T_camera_robot * hypothesis_.T_surface_seen[recording];
  for (const SurfaceMeasurement& feature : sample.surface) {
    SeenPoint& point = measured_points.points.emplace_back();
    if (feature.count == 0) continue;
    point = {T_camera_robot * feature.point.Position(x_m), feature.normal.normalized()};
  }
  return measured_points;
}

void SampleSolver::See(const Sample& sample, SimulatedSample* solved) const {
  const Eigen::VectorXd& x_m = solved->middle.state.x_m;
  const MeasuredPoints measured_points = MeasuredPointsOf(sample, x_m);
  for (Eigen::Index m = 0; m < solved->markers; ++m)
    solved->seen_m.segment<3>(3 * m) = measured_points.Measured(m);
  if (sample.surface.empty()) return;
  const MeasuredPoints surface = SurfacePointsOf(sample, x_m);
  for (std::size_t f = 0; f < sample.surface.size(); ++f) {
    const auto feature = ToIndex(f);
    if (sample.surface[f].count == 0) continue;
    solved->seen_m[3 * solved->markers + feature] =
        sample.surface[f].normal.dot(surface.Measured(feature)) +
        sample.surface[f].normal.norm() * hypothesis_.surface_offset_m[feature] +
        sample.surface[f].ripple_m_px.dot(hypothesis_.camera.ripple_px);
  }
}

void SampleSolver::Solve(const Sample& sample, const Eigen::VectorXd& taken_in,
                         const HistoryVariables& history_variables, SimulatedSample* solved) {
  solved->markers = std::ssize(markers_);
  solved->seen_m = Eigen::VectorXd::Constant(observed_.CoordinateCount(),
                                             std::numeric_limits<double>::quiet_NaN());
  if (obstacle_ &&
      ObstacleClearance_m(obstacle_->obstacle(), hypothesis_.assembled_m) < -kDeepest_m) {
    solved->status = {StatusCode::kInvalidInput, "the obstacle intersects the undeformed body"};
    return;
  }
  Prepare(sample, history_variables);
  fem::StaticState& state = solved->middle.state;
  if (state.x_m.size() == 0) state = model_.RestState();
  // It may come from a robot without the obstacle, or with one.
  state.multipliers_N.conservativeResizeLike(
      Eigen::VectorXd::Zero(ToIndex(model_.linearisation().constraints().size())));
  solved->middle.commands = Commands(taken_in);
  solved->status = BalanceOnBase(LoadsOf(sample, solved->middle.commands), &solved->middle);
  if (solved->status.ok()) See(sample, solved);
}

bool SampleSolver::IsNearObstacle(const fem::StaticState& state) const {
  constexpr double kNear_m = 1e-3;
  return obstacle_ && ObstacleClearance_m(obstacle_->obstacle(), state.x_m) < kNear_m;
}

HistoryInput SampleSolver::HistoryInputAt(const HistoryVariables& history_variables,
                                          const SimulatedSample& solved) {
  const Eigen::VectorXd& x_m = solved.middle.state.x_m;
  if (!solved.status.ok()) {
    return {PointStresses::Zero(6, points_.PointCount()),
            Eigen::VectorXf::Zero(cell_volume_m3_.size())};
  }
  const fem::ElasticBody& body = model_.elastic_body();
  const bool softened = history_variables.cell_factor.size() > 0;
  const Eigen::VectorXd undamaged = Eigen::VectorXd::Ones(cell_volume_m3_.size());
  Eigen::Matrix<double, 6, Eigen::Dynamic> elastic_Pa;
  points_.Evaluate(body.materials(), softened ? history_variables.cell_factor : undamaged, x_m,
                   &elastic_Pa);
  Eigen::VectorXd energy_J;
  body.CellEnergies(x_m, &energy_J);
  energy_J = energy_J.cwiseQuotient(cell_volume_m3_) / (1.0 + history_variables.scale);
  if (softened) energy_J = energy_J.cwiseQuotient(history_variables.cell_factor);
  return {(elastic_Pa / (1.0 + history_variables.scale)).cast<float>(), energy_J.cast<float>()};
}

HistoryInput SampleSolver::Rest(HeldShape* shape) {
  Sample nothing;
  nothing.t_s = observed_.timeline.begin_s.front();
  // Of the actuators that are driven at all.
  const double off = std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd zero = Eigen::VectorXd::Constant(model_.ActuatorCount(), off);
  for (const Eigen::VectorXd& command : observed_.timeline.command) {
    zero = command.array().isNaN().select(zero, 0.0);
  }
  SimulatedSample rest;
  rest.middle = *shape;
  Solve(nothing, zero, {}, &rest);
  if (!rest.status.ok() && shape->state.x_m.size() > 0) {
    rest = {};
    Solve(nothing, zero, {}, &rest);
  }
  *shape = rest.status.ok() ? rest.middle : HeldShape{};
  return HistoryInputAt({}, rest);
}

}  // namespace palpate::diagnosis

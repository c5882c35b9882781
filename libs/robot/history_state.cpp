// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/history_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/mullins.hpp"
#include "libs/fem/viscosity.hpp"
#include "libs/robot/play_operator.hpp"
#include "libs/robot/sensitivity/eyelet_slides.hpp"
#include "libs/robot/sticking.hpp"

namespace palpate::robot {

namespace {

using Kind = ActuatorCommand::Kind;

bool HasPlay(const RobotBody& body) {
  return std::any_of(body.cables.begin(), body.cables.end(),
                     [](const BodyCable& cable) { return cable.play_m > 0.0; });
}

bool HasFriction(const RobotBody& body) {
  const Eigen::VectorXd coefficient = FrictionAt(RubbingEyelets(body), body);
  return coefficient.size() > 0 && coefficient.maxCoeff() > 0.0;
}

/// [actuators] by how much they take in more, m, or pull harder, N; 0 where one is commanded
/// otherwise than before.
Eigen::VectorXd StepOf(const std::vector<ActuatorCommand>& from,
                       const std::vector<ActuatorCommand>& to) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(std::ssize(to));
  for (std::size_t c = 0; c < to.size(); ++c) {
    if (to[c].kind == from[c].kind && to[c].kind != Kind::kNone)
      step[ToIndex(c)] = to[c].value - from[c].value;
  }
  return step;
}

}  // namespace

/// Where cables stick and slide. What they slide by is predicted from the commands before a frame,
/// and taken from its shape afterwards, which contacts have a part in.
class HistoryState::Eyelets {
 public:
  Eyelets(RobotModel& model, const HistoryTuning& tuning)
      : model_(model),
        tuning_(tuning),
        eyelets_(RubbingEyelets(model.body())),
        coefficient_(FrictionAt(eyelets_, model.body())),
        sensitivity_(model) {
    Restart();
  }

  void Restart() {
    sliding_.setZero(coefficient_.size());
    assumed_ = sliding_;
    slides_ = {};
    known_ = false;
    SetFriction(sliding_);
  }

  void Prepare(const std::vector<ActuatorCommand>& commands) {
    if (!known_) return;
    RenewSlides(commands);
    if (slides_.IsKnown()) {
      assumed_ =
          StickOrSlide(sliding_, slides_.by_command * StepOf(commands_, commands), BySliding_m());
    }
    SetFriction(assumed_);
  }

  /// The largest change, of 1: what friction can be.
  double Correct(const Eigen::VectorXd& x_m) {
    const Eigen::VectorXd sliding = SlidingAt(LengthsBeyond_m(x_m));
    const double change = (sliding - assumed_).cwiseAbs().maxCoeff();
    assumed_ = sliding;
    SetFriction(assumed_);
    return change;
  }

  void Commit(const std::vector<ActuatorCommand>& commands, const Eigen::VectorXd& x_m,
              const Eigen::VectorXd& tension_N) {
    const Eigen::VectorXd lengths_m = LengthsBeyond_m(x_m);
    sliding_ = SlidingAt(lengths_m);
    lengths_m_ = lengths_m;
    commands_ = commands;
    state_.x_m = x_m;
    state_.multipliers_N = tension_N;
    state_.loads = model_.Loads(commands, {});  // contacts change no derivative
    known_ = true;
  }

 private:
  /// [eyelets] at a shape of the frame that was prepared, where cables are so long beyond them.
  Eigen::VectorXd SlidingAt(const Eigen::VectorXd& lengths_m) const {
    if (!known_ || !slides_.IsKnown()) return assumed_;
    const Eigen::MatrixXd by_sliding_m = BySliding_m();
    const Eigen::VectorXd freely_m = lengths_m - lengths_m_ - by_sliding_m * (assumed_ - sliding_);
    return StickOrSlide(sliding_, freely_m, by_sliding_m);
  }

  /// About the last shape, where the commands have gone far since, or other cables are taut.
  void RenewSlides(const std::vector<ActuatorCommand>& commands) {
    if (slides_.IsKnown()) {
      if (StepOf(commands_, commands).isZero(0.0)) return;
      if (AreNear(slides_at_, commands) && Taut() == taut_) return;
    }
    SetFriction(sliding_);
    EyeletSlides slides = SlidesAbout(eyelets_, commands_, state_, model_, &sensitivity_);
    if (!slides.IsKnown()) return;
    slides_ = std::move(slides);
    slides_at_ = commands_;
    taut_ = Taut();
  }

  bool AreNear(const std::vector<ActuatorCommand>& one,
               const std::vector<ActuatorCommand>& other) const {
    const Eigen::VectorXd step = StepOf(one, other);
    for (std::size_t c = 0; c < one.size(); ++c) {
      const bool by_tension = one[c].kind == Kind::kTension;
      const double most = by_tension ? tuning_.renew_slides_N : tuning_.renew_slides_m;
      if (std::abs(step[ToIndex(c)]) >= most) return false;
    }
    return true;
  }

  std::vector<bool> Taut() const {
    std::vector<bool> taut;
    for (Eigen::Index c = 0; c < model_.ActuatorCount(); ++c)
      taut.push_back(state_.multipliers_N[c] > 0.0);
    return taut;
  }

  /// [eyelets x eyelets] m that cables slide farther per what each eyelet's sliding changes by.
  Eigen::MatrixXd BySliding_m() const { return slides_.by_friction * coefficient_.asDiagonal(); }

  /// [eyelets] of each cable from there to its end.
  Eigen::VectorXd LengthsBeyond_m(const Eigen::VectorXd& x_m) const {
    Eigen::VectorXd lengths_m(coefficient_.size());
    for (std::size_t k = 0; k < eyelets_.size(); ++k) {
      const Eigen::Matrix3Xd path_m = model_.cable(eyelets_[k].cable).Path_m(x_m);
      double length_m = 0.0;
      for (Eigen::Index p = eyelets_[k].eyelet + 2; p < path_m.cols(); ++p)
        length_m += (path_m.col(p) - path_m.col(p - 1)).norm();
      lengths_m[ToIndex(k)] = length_m;
    }
    return lengths_m;
  }

  void SetFriction(const Eigen::VectorXd& sliding) {
    std::vector<CableFriction> friction;  // [cables]
    for (const BodyCable& cable : model_.body().cables) {
      friction.push_back({cable.friction_coefficient, std::vector<double>(cable.eyelets.size())});
    }
    for (std::size_t k = 0; k < eyelets_.size(); ++k) {
      friction[At(eyelets_[k].cable)].sliding[At(eyelets_[k].eyelet)] = sliding[ToIndex(k)];
    }
    for (int c = 0; c < model_.CableCount(); ++c) model_.SetCableFriction(c, friction[At(c)]);
  }

  RobotModel& model_;
  HistoryTuning tuning_;
  std::vector<RubbingEyelet> eyelets_;
  Eigen::VectorXd coefficient_;  ///< [eyelets]
  SensitivitySolver sensitivity_;
  EyeletSlides slides_;
  std::vector<ActuatorCommand> slides_at_;  ///< of which they are
  std::vector<bool> taut_;                  ///< [cables] there
  bool known_ = false;                      ///< what follows
  Eigen::VectorXd sliding_;                 ///< [eyelets] at the last shape
  Eigen::VectorXd assumed_;                 ///< [eyelets] in the frame that was prepared
  Eigen::VectorXd lengths_m_;               ///< [eyelets] at the last shape
  std::vector<ActuatorCommand> commands_;   ///< of the last shape
  fem::StaticState state_;                  ///< the last shape
};

/// Creep and softening. What creep has left of the past is a stress that stays with the material.
/// Its force is a dead load of the frame, and what creep adds at once is part of the cell factors.
class HistoryState::Material {
 public:
  explicit Material(RobotModel& model)
      : model_(model),
        creep_(model.body().mesh, model.body().material_of_cell, model.body().creep, 0.0),
        softening_(model.body().softening),
        volume_m3_(fem::CellVolumes_m3(model.body().mesh)) {
    Restart();
  }

  void Restart() {
    began_ = false;
    damage_.setOnes(volume_m3_.size());
    presses_ = false;
    scale_ = 1.0;
    model_.SetHistoryForce({});
    model_.elastic_body().SetCellFactors(damage_);
  }

  void Prepare(double t_s) {
    if (!began_) {
      BeginSoftened(t_s);
      return;
    }
    const double step_s = t_s - t_s_;
    if (creep_.active() && step_s > 0.0) {
      creep_.Prepare(step_s);
      scale_ = creep_.scale();
      presses_ = true;
      SetForce(x_m_);
    }
    model_.elastic_body().SetCellFactors(scale_ * damage_);
  }

  /// The largest change, of the internal forces or of the moduli.
  double Correct(const Eigen::VectorXd& x_m) {
    double change = 0.0;
    if (presses_) {
      Eigen::VectorXd elastic_N = Eigen::VectorXd::Zero(x_m.size());
      model_.elastic_body().AddForces(x_m, elastic_N);
      const Eigen::VectorXd before_N = force_N_;
      SetForce(x_m);
      const double least_N = std::numeric_limits<double>::min();
      change = (force_N_ - before_N).norm() / std::max(least_N, elastic_N.norm());
    }
    if (softening_) {
      Eigen::VectorXd largest_J_m3 = model_.strain_history().largest_J_m3;
      change = std::max(change, StepDamage(x_m, &largest_J_m3));
      model_.elastic_body().SetCellFactors(scale_ * damage_);
    }
    return change;
  }

  void Commit(double t_s, const Eigen::VectorXd& x_m) {
    const std::vector<fem::Material>& materials = model_.body().materials;
    if (!began_) {
      creep_.Reset(materials, damage_, x_m);
    } else if (t_s > t_s_) {
      creep_.Advance(materials, damage_, x_m, t_s - t_s_);
    }
    if (softening_) {
      StepDamage(x_m, &model_.strain_history().largest_J_m3);
      model_.strain_history().t_s = t_s;
    }
    began_ = true;
    t_s_ = t_s;
    x_m_ = x_m;
  }

 private:
  /// At rest, as far as the sequences before have softened it: those of an earlier time.
  void BeginSoftened(double t_s) {
    if (!softening_) return;
    StrainHistory& strained = model_.strain_history();
    const Eigen::Index cells = volume_m3_.size();
    if (t_s < strained.t_s || strained.largest_J_m3.size() != cells) {
      strained = {.largest_J_m3 = Eigen::VectorXd::Zero(cells)};
    }
    damage_ = strained.largest_J_m3.unaryExpr(
        [&](double largest_J_m3) { return fem::Damage(*softening_, largest_J_m3); });
    model_.elastic_body().SetCellFactors(damage_);
  }

  /// What creep has left, at the shape `x_m`.
  void SetForce(const Eigen::VectorXd& x_m) {
    force_N_.setZero(x_m.size());
    creep_.history().AddProduct(x_m, -1.0, force_N_);
    model_.SetHistoryForce(force_N_);
  }

  double StepDamage(const Eigen::VectorXd& x_m, Eigen::VectorXd* largest_J_m3) {
    Eigen::VectorXd energy_J;
    model_.elastic_body().CellEnergies(x_m, &energy_J);
    const Eigen::VectorXd undamaged_m3 = scale_ * damage_.cwiseProduct(volume_m3_);
    return fem::StepDamage(*softening_, energy_J.cwiseQuotient(undamaged_m3), largest_J_m3,
                           &damage_);
  }

  RobotModel& model_;
  fem::Viscosity creep_;
  std::optional<fem::MullinsLaw> softening_;
  Eigen::VectorXd volume_m3_;  ///< [elements]
  Eigen::VectorXd damage_;     ///< [elements] eta
  double scale_ = 1.0;         ///< by creep, of the frame that was prepared
  bool presses_ = false;       ///< creep has left a stress, with this nodal force
  Eigen::VectorXd force_N_;    ///< [3n]
  bool began_ = false;
  double t_s_ = 0.0;     ///< of the last shape
  Eigen::VectorXd x_m_;  ///< [3n] the last shape
};

HistoryState::HistoryState(RobotModel& model, const HistoryTuning& tuning)
    : model_(model),
      tuning_(tuning),
      active_(HasPlay(model.body()) || HasFriction(model.body()) || !model.body().creep.empty() ||
              model.body().softening.has_value()) {
  if (HasFriction(model.body())) eyelets_ = std::make_unique<Eyelets>(model, tuning);
  if (!model.body().creep.empty() || model.body().softening)
    material_ = std::make_unique<Material>(model);
}

HistoryState::~HistoryState() = default;

void HistoryState::Restart() {
  began_ = false;
  if (eyelets_) eyelets_->Restart();
  if (material_) material_->Restart();
}

const std::vector<ActuatorCommand>& HistoryState::Prepare(
    double t_s, const std::vector<ActuatorCommand>& commands) {
  PALPATE_CHECK(static_cast<int>(commands.size()) == model_.ActuatorCount(), commands.size());
  if (began_ && t_s < t_s_) Restart();
  if (!began_) commands_ = commands;
  for (std::size_t c = 0; c < commands.size(); ++c) {
    const bool followed =
        commands[c].kind == Kind::kDisplacement && commands_[c].kind == Kind::kDisplacement;
    const bool is_cable = c < model_.body().cables.size();
    const double play_m = is_cable ? model_.body().cables[c].play_m : 0.0;
    const double value =
        followed ? Play(commands_[c].value, commands[c].value, play_m) : commands[c].value;
    commands_[c] = {commands[c].kind, value};
  }
  began_ = true;
  t_s_ = t_s;
  if (eyelets_) eyelets_->Prepare(commands_);
  if (material_) material_->Prepare(t_s);
  return commands_;
}

bool HistoryState::Correct(const Eigen::VectorXd& x_m) {
  PALPATE_CHECK(began_);
  double change = 0.0;
  if (eyelets_) change = eyelets_->Correct(x_m);
  if (material_) change = std::max(change, material_->Correct(x_m));
  return change > tuning_.settled;
}

void HistoryState::Commit(const Eigen::VectorXd& x_m, const Eigen::VectorXd& tension_N) {
  PALPATE_CHECK(began_);
  if (eyelets_) eyelets_->Commit(commands_, x_m, tension_N);
  if (material_) material_->Commit(t_s_, x_m);
}

}  // namespace palpate::robot

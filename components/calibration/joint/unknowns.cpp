// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/unknowns.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::calibration {

using Kind = robot::ActuatorCommand::Kind;

Status Unknown::ApplyToModel(double, robot::RobotModel*) const { return Status::Ok(); }

void Unknown::ApplyToFrame(double, int, FrameInputs*) const {}

namespace {

constexpr const char* kAnotherSetting =
    "a recording with markers on the part that this cable moves, at another of its settings";
constexpr const char* kKnownForce =
    "a recording with a known load, or with cables whose tension is measured";

robot::ActuatorCommand& CommandOf(int cable, FrameInputs* inputs) {
  return inputs->cables.at(At(cable));
}

/// Influence of `per_value` times a cable's command.
std::vector<Influence> OfCommand(int cable, const FrameInputs& inputs, double per_value) {
  const double s = inputs.scale;
  switch (inputs.cables.at(At(cable)).kind) {
    case Kind::kDisplacement: return Influence::One(robot::CableOffset(cable), per_value / s);
    case Kind::kTension: return Influence::One(robot::TensionOffset(cable), per_value / (s * s));
    case Kind::kNone: break;
  }
  return {};
}

std::vector<Influence> OfDisplacement(int cable, const FrameInputs& inputs, double per_value) {
  const bool acts = inputs.cables.at(At(cable)).kind == Kind::kDisplacement;
  return acts ? OfCommand(cable, inputs, per_value) : std::vector<Influence>();
}

class InputOfFrame final : public Unknown {
 public:
  InputOfFrame(int frame, int cable, Kind kind, std::string name, const GaussianPrior& prior)
      : Unknown(std::move(name), kind == Kind::kTension ? "N" : "m", prior, kAnotherSetting),
        frame_(frame),
        cable_(cable),
        kind_(kind) {}

  void ApplyToFrame(double value, int frame, FrameInputs* inputs) const override {
    if (frame == frame_) CommandOf(cable_, inputs) = {kind_, value};
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int frame,
                                      const FrameInputs& inputs) const override {
    return frame == frame_ ? OfCommand(cable_, inputs, 1.0) : std::vector<Influence>();
  }

 private:
  int frame_;
  int cable_;
  Kind kind_;
};

class OffsetOfCommand final : public Unknown {
 public:
  OffsetOfCommand(int cable, std::string name, const GaussianPrior& prior)
      : Unknown(std::move(name), "m", prior, kAnotherSetting), cable_(cable) {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    robot::ActuatorCommand& command = CommandOf(cable_, inputs);
    if (command.kind == Kind::kDisplacement) command.value += value;
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int,
                                      const FrameInputs& inputs) const override {
    return OfDisplacement(cable_, inputs, 1.0);
  }

 private:
  int cable_;
};

class GainOfCommand final : public Unknown {
 public:
  GainOfCommand(int cable, std::string name, std::vector<double> measured,
                const GaussianPrior& prior)
      : Unknown(std::move(name), "", prior, kAnotherSetting),
        cable_(cable),
        measured_(std::move(measured)) {}

  void ApplyToFrame(double value, int frame, FrameInputs* inputs) const override {
    robot::ActuatorCommand& command = CommandOf(cable_, inputs);
    if (command.kind == Kind::kDisplacement) command.value += value * MeasuredIn(frame);
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int frame,
                                      const FrameInputs& inputs) const override {
    return OfDisplacement(cable_, inputs, MeasuredIn(frame));
  }

 private:
  double MeasuredIn(int frame) const { return measured_.at(At(frame)); }

  int cable_;
  std::vector<double> measured_;
};

class LogModulus final : public Unknown {
 public:
  LogModulus(int material, const std::string& part, double youngs_modulus_Pa,
             const GaussianPrior& prior)
      : Unknown("youngs_modulus:" + part, "Pa", prior, kKnownForce),
        material_(material),
        youngs_modulus_Pa_(youngs_modulus_Pa) {}

  Status ApplyToModel(double value, robot::RobotModel* model) const override {
    model->SetYoungsModulus(material_, Quantity(value));
    return Status::Ok();
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double value, int,
                                      const FrameInputs&) const override {
    return Influence::One(robot::YoungsModulus(material_), Quantity(value));
  }

  bool IsModulus() const override { return true; }
  double Quantity(double value) const override { return youngs_modulus_Pa_ * std::exp(value); }
  double QuantityPerValue(double value) const override { return Quantity(value); }

 private:
  int material_;
  double youngs_modulus_Pa_;
};

class Poisson final : public Unknown {
 public:
  Poisson(int material, const std::string& part, const GaussianPrior& prior)
      : Unknown("poissons_ratio:" + part, "", prior,
                "a recording with markers where the body bulges under large tensions"),
        material_(material) {}

  Status ApplyToModel(double value, robot::RobotModel* model) const override {
    model->SetPoissonsRatio(material_, value);
    return Status::Ok();
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int,
                                      const FrameInputs&) const override {
    return Influence::One(robot::PoissonsRatio(material_), 1.0);
  }

 private:
  int material_;
};

class MassUnknown final : public Unknown {
 public:
  explicit MassUnknown(const GaussianPrior& prior)
      : Unknown("mass_factor", "", prior,
                "a recording with the base tilted or turned over, and one with a known load") {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    inputs->mass_factor = value;
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int,
                                      const FrameInputs& inputs) const override {
    return Influence::One(robot::GravityChange(inputs.gravity_m_s2), inputs.scale);
  }
};

class TiltUnknown final : public Unknown {
 public:
  TiltUnknown(const std::string& axis_name, const Eigen::Vector3d& axis, const GaussianPrior& prior)
      : Unknown("gravity_tilt:" + axis_name, "", prior,
                "a recording with the base tilted by a known angle"),
        axis_(axis) {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    inputs->gravity_m_s2 += value * axis_.cross(inputs->nominal_gravity_m_s2);
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int,
                                      const FrameInputs& inputs) const override {
    return Influence::One(robot::GravityChange(axis_.cross(inputs.nominal_gravity_m_s2)),
                          inputs.scale * inputs.mass_factor);
  }

 private:
  Eigen::Vector3d axis_;
};

class ScaleUnknown final : public Unknown {
 public:
  explicit ScaleUnknown(const GaussianPrior& prior)
      : Unknown("geometry_scale", "", prior,
                "markers measured in metres independently of the camera's depth, or known "
                "displacements of the cables") {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    inputs->scale = value;
  }
  bool ScalesTheRobot() const override { return true; }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double s, int,
                                      const FrameInputs& inputs) const override {
    std::vector<Influence> all;
    for (std::size_t c = 0; c < inputs.cables.size(); ++c) {
      const robot::ActuatorCommand& command = inputs.cables[c];
      if (command.value == 0.0) continue;
      const double share = command.kind == Kind::kTension ? -2.0 / s : -1.0 / s;
      for (Influence& influence : OfCommand(static_cast<int>(c), inputs, share * command.value)) {
        all.push_back(std::move(influence));
      }
    }
    for (const robot::DeadLoad& load : inputs.loads) {
      all.push_back({robot::ExternalForce(load.weights, load.force_N.normalized()),
                     -2.0 * load.force_N.norm() / (s * s * s)});
    }
    for (std::size_t k = 0; k < inputs.hold_per_scale.size(); ++k) {
      const Eigen::Vector3d& force_N = inputs.loads[k].force_N;
      all.push_back({robot::ExternalForce(inputs.hold_per_scale[k], force_N.normalized()),
                     force_N.norm() / (s * s)});
    }
    all.push_back({robot::GravityChange(inputs.gravity_m_s2), inputs.mass_factor});
    return all;
  }
};

}  // namespace

FrameInputs ToModel(const FrameInputs& robot) {
  FrameInputs model = robot;
  const double s = robot.scale;
  if (s == 1.0) return model;
  for (robot::ActuatorCommand& command : model.cables) {
    command.value /= command.kind == Kind::kTension ? s * s : s;
  }
  for (robot::DeadLoad& load : model.loads) load.force_N /= s * s;
  model.mass_factor *= s;
  model.scale = 1.0;
  return model;
}

void HoldLoadsAt(const std::vector<LoadPlace>& places, const robot::RobotModel& model,
                 FrameInputs* robot) {
  // Weights change between elements: within 1e-4, some 10 um, hardly ever.
  constexpr double kStep = 1e-4;
  const auto hold = [&](const LoadPlace& place, double scale) {
    return model.Patch(place.position_m / scale, place.patch_radius_m / scale).weights;
  };
  robot->hold_per_scale.clear();
  for (std::size_t k = 0; k < places.size(); ++k) {
    robot->loads.at(k).weights = hold(places[k], robot->scale);
    fem::InterpolationWeights change = hold(places[k], robot->scale + kStep);
    const fem::InterpolationWeights before = hold(places[k], robot->scale - kStep);
    for (double& weight : change.weights) weight /= 2.0 * kStep;
    change.nodes.insert(change.nodes.end(), before.nodes.begin(), before.nodes.end());
    for (const double weight : before.weights) change.weights.push_back(-weight / (2.0 * kStep));
    robot->hold_per_scale.push_back(std::move(change));
  }
}

UnknownPtr CableInput(int frame, const std::string& frame_name, int cable,
                      const std::string& cable_name, Kind kind, const GaussianPrior& prior) {
  return std::make_unique<InputOfFrame>(frame, cable, kind,
                                        "input:" + cable_name + ":" + frame_name, prior);
}

UnknownPtr CommandOffset(int cable, const std::string& cable_name, const GaussianPrior& prior) {
  return std::make_unique<OffsetOfCommand>(cable, "cable_offset:" + cable_name, prior);
}

UnknownPtr CommandGain(int cable, const std::string& cable_name, std::vector<double> measured,
                       const GaussianPrior& prior) {
  return std::make_unique<GainOfCommand>(cable, "cable_gain:" + cable_name, std::move(measured),
                                         prior);
}

UnknownPtr LogYoungsModulus(int material, const std::string& part, double youngs_modulus_Pa,
                            const GaussianPrior& prior) {
  return std::make_unique<LogModulus>(material, part, youngs_modulus_Pa, prior);
}

UnknownPtr PoissonsRatioOf(int material, const std::string& part, const GaussianPrior& prior) {
  return std::make_unique<Poisson>(material, part, prior);
}

UnknownPtr MassFactor(const GaussianPrior& prior) { return std::make_unique<MassUnknown>(prior); }

UnknownPtr GravityTilt(const std::string& axis_name, const Eigen::Vector3d& axis,
                       const GaussianPrior& prior) {
  return std::make_unique<TiltUnknown>(axis_name, axis, prior);
}

UnknownPtr GeometryScaleOf(const GaussianPrior& prior) {
  return std::make_unique<ScaleUnknown>(prior);
}

std::array<TiltAxis, 2> TiltAxes(const Eigen::Vector3d& gravity_m_s2) {
  const Eigen::Vector3d down = gravity_m_s2.normalized();
  Eigen::Index along = 0;
  down.cwiseAbs().maxCoeff(&along);
  std::array<TiltAxis, 2> axes;
  for (Eigen::Index i = 0, k = 0; i < 3; ++i) {
    if (i == along) continue;
    axes[At(k++)] = {std::string(1, "xyz"[i]),
                     (Eigen::Vector3d::Unit(i) - down[i] * down).normalized()};
  }
  return axes;
}

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/unknowns.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::calibration {

using Kind = robot::CableCommand::Kind;

void Unknown::ApplyToModel(double, robot::RobotModel*) const {}

void Unknown::ApplyToFrame(double, int, FrameInputs*) const {}

namespace {

constexpr const char* kAnotherSetting =
    "a recording with markers on the part that this cable moves, at another of its settings";
constexpr const char* kKnownForce =
    "a recording with a known load, or with cables whose tension is measured";

robot::CableCommand& CommandOf(int cable, FrameInputs* inputs) {
  return inputs->cables.at(static_cast<size_t>(cable));
}

/// What `per_value` more of a cable's command does.
std::optional<Influence> OfCommand(int cable, const FrameInputs& inputs, double per_value) {
  switch (inputs.cables.at(static_cast<size_t>(cable)).kind) {
    case Kind::kDisplacement: return Influence{robot::CableOffset(cable), per_value};
    case Kind::kTension: return Influence{robot::TensionOffset(cable), per_value};
    case Kind::kNone: break;
  }
  return std::nullopt;
}

std::optional<Influence> OfDisplacement(int cable, const FrameInputs& inputs, double per_value) {
  const bool acts = inputs.cables.at(static_cast<size_t>(cable)).kind == Kind::kDisplacement;
  return acts ? OfCommand(cable, inputs, per_value) : std::nullopt;
}

class InputOfFrame final : public Unknown {
 public:
  InputOfFrame(int frame, int cable, Kind kind, std::string name, const Belief& belief)
      : Unknown(std::move(name), kind == Kind::kTension ? "N" : "m", belief, kAnotherSetting),
        frame_(frame),
        cable_(cable),
        kind_(kind) {}

  void ApplyToFrame(double value, int frame, FrameInputs* inputs) const override {
    if (frame == frame_) CommandOf(cable_, inputs) = {kind_, value};
  }

  std::optional<Influence> InfluenceOn(double, int frame,
                                       const FrameInputs& inputs) const override {
    return frame == frame_ ? OfCommand(cable_, inputs, 1.0) : std::nullopt;
  }

 private:
  int frame_;
  int cable_;
  Kind kind_;
};

class OffsetOfCommand final : public Unknown {
 public:
  OffsetOfCommand(int cable, std::string name, const Belief& belief)
      : Unknown(std::move(name), "m", belief, kAnotherSetting), cable_(cable) {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    robot::CableCommand& command = CommandOf(cable_, inputs);
    if (command.kind == Kind::kDisplacement) command.value += value;
  }

  std::optional<Influence> InfluenceOn(double, int, const FrameInputs& inputs) const override {
    return OfDisplacement(cable_, inputs, 1.0);
  }

 private:
  int cable_;
};

class GainOfCommand final : public Unknown {
 public:
  GainOfCommand(int cable, std::string name, std::vector<double> measured, const Belief& belief)
      : Unknown(std::move(name), "", belief, kAnotherSetting),
        cable_(cable),
        measured_(std::move(measured)) {}

  void ApplyToFrame(double value, int frame, FrameInputs* inputs) const override {
    robot::CableCommand& command = CommandOf(cable_, inputs);
    if (command.kind == Kind::kDisplacement) command.value += value * MeasuredIn(frame);
  }

  std::optional<Influence> InfluenceOn(double, int frame,
                                       const FrameInputs& inputs) const override {
    return OfDisplacement(cable_, inputs, MeasuredIn(frame));
  }

 private:
  double MeasuredIn(int frame) const { return measured_.at(static_cast<size_t>(frame)); }

  int cable_;
  std::vector<double> measured_;
};

class LogModulus final : public Unknown {
 public:
  LogModulus(int material, const std::string& part, double youngs_modulus_Pa, const Belief& belief)
      : Unknown("youngs_modulus:" + part, "Pa", belief, kKnownForce),
        material_(material),
        youngs_modulus_Pa_(youngs_modulus_Pa) {}

  void ApplyToModel(double value, robot::RobotModel* model) const override {
    model->SetYoungsModulus(material_, Quantity(value));
  }

  std::optional<Influence> InfluenceOn(double value, int, const FrameInputs&) const override {
    return Influence{robot::YoungsModulus(material_), Quantity(value)};
  }

  double Quantity(double value) const override { return youngs_modulus_Pa_ * std::exp(value); }
  double QuantityPerValue(double value) const override { return Quantity(value); }

 private:
  int material_;
  double youngs_modulus_Pa_;
};

class Poisson final : public Unknown {
 public:
  Poisson(int material, const std::string& part, const Belief& belief)
      : Unknown("poissons_ratio:" + part, "", belief,
                "a recording with markers where the body bulges under large pulls"),
        material_(material) {}

  void ApplyToModel(double value, robot::RobotModel* model) const override {
    model->SetPoissonsRatio(material_, value);
  }

  std::optional<Influence> InfluenceOn(double, int, const FrameInputs&) const override {
    return Influence{robot::PoissonsRatio(material_), 1.0};
  }

 private:
  int material_;
};

class MassUnknown final : public Unknown {
 public:
  explicit MassUnknown(const Belief& belief)
      : Unknown("mass_factor", "", belief,
                "a recording with the base tilted or turned over, beside one with a known load") {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    inputs->mass_factor = value;
  }

  std::optional<Influence> InfluenceOn(double, int, const FrameInputs& inputs) const override {
    return Influence{robot::GravityChange(inputs.gravity_m_s2), 1.0};
  }
};

class TiltUnknown final : public Unknown {
 public:
  TiltUnknown(const std::string& axis_name, const Eigen::Vector3d& axis, const Belief& belief)
      : Unknown("gravity_tilt:" + axis_name, "", belief,
                "a recording with the base tilted by a known angle"),
        axis_(axis) {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    inputs->gravity_m_s2 += value * axis_.cross(inputs->nominal_gravity_m_s2);
  }

  std::optional<Influence> InfluenceOn(double, int, const FrameInputs& inputs) const override {
    return Influence{robot::GravityChange(axis_.cross(inputs.nominal_gravity_m_s2)),
                     inputs.mass_factor};
  }

 private:
  Eigen::Vector3d axis_;
};

}  // namespace

UnknownPtr CableInput(int frame, const std::string& frame_name, int cable,
                      const std::string& cable_name, Kind kind, const Belief& belief) {
  return std::make_unique<InputOfFrame>(frame, cable, kind,
                                        "input:" + cable_name + ":" + frame_name, belief);
}

UnknownPtr CommandOffset(int cable, const std::string& cable_name, const Belief& belief) {
  return std::make_unique<OffsetOfCommand>(cable, "cable_offset:" + cable_name, belief);
}

UnknownPtr CommandGain(int cable, const std::string& cable_name, std::vector<double> measured,
                       const Belief& belief) {
  return std::make_unique<GainOfCommand>(cable, "cable_gain:" + cable_name, std::move(measured),
                                         belief);
}

UnknownPtr LogYoungsModulus(int material, const std::string& part, double youngs_modulus_Pa,
                            const Belief& belief) {
  return std::make_unique<LogModulus>(material, part, youngs_modulus_Pa, belief);
}

UnknownPtr PoissonsRatioOf(int material, const std::string& part, const Belief& belief) {
  return std::make_unique<Poisson>(material, part, belief);
}

UnknownPtr MassFactor(const Belief& belief) { return std::make_unique<MassUnknown>(belief); }

UnknownPtr GravityTilt(const std::string& axis_name, const Eigen::Vector3d& axis,
                       const Belief& belief) {
  return std::make_unique<TiltUnknown>(axis_name, axis, belief);
}

std::array<TiltAxis, 2> TiltAxes(const Eigen::Vector3d& gravity_m_s2) {
  const Eigen::Vector3d down = gravity_m_s2.normalized();
  Eigen::Index along = 0;
  down.cwiseAbs().maxCoeff(&along);
  std::array<TiltAxis, 2> axes;
  for (Eigen::Index i = 0, k = 0; i < 3; ++i) {
    if (i == along) continue;
    axes[static_cast<std::size_t>(k++)] = {
        std::string(1, "xyz"[i]), (Eigen::Vector3d::Unit(i) - down[i] * down).normalized()};
  }
  return axes;
}

}  // namespace palpate::calibration

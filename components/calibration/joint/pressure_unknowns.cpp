// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/joint/pressure_unknowns.hpp"

#include <utility>

#include "libs/core/index.hpp"
#include "libs/robot/sensitivity/parameters.hpp"

namespace palpate::calibration {

namespace {

bool IsByPressure(int actuator, const FrameInputs& inputs) {
  return inputs.cables.at(At(actuator)).kind == robot::ActuatorCommand::Kind::kTension;
}

std::vector<Influence> OfThrust(int actuator, const FrameInputs& inputs, double N_per_value) {
  if (!IsByPressure(actuator, inputs)) return {};
  return Influence::One(robot::TensionOffset(actuator), N_per_value);
}

class ZeroOfPressure final : public Unknown {
 public:
  ZeroOfPressure(int actuator, const std::string& chamber, double area_m2,
                 const GaussianPrior& prior)
      : Unknown("pressure_zero:" + chamber, "Pa", prior,
                "a recording in which the chamber is open to the air, without its column, beside "
                "one in which its sensor is read"),
        actuator_(actuator),
        area_m2_(area_m2) {}

  void ApplyToFrame(double value, int, FrameInputs* inputs) const override {
    if (IsByPressure(actuator_, *inputs))
      inputs->cables.at(At(actuator_)).value += area_m2_ * value;
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int,
                                      const FrameInputs& inputs) const override {
    return OfThrust(actuator_, inputs, area_m2_);
  }

 private:
  int actuator_;
  double area_m2_;
};

class GainOfPressure final : public Unknown {
 public:
  GainOfPressure(int actuator, const std::string& chamber, std::vector<double> read_N,
                 const GaussianPrior& prior, std::string what_would_tell)
      : Unknown("pressure_gain:" + chamber, "", prior, std::move(what_would_tell)),
        actuator_(actuator),
        read_N_(std::move(read_N)) {}

  void ApplyToFrame(double value, int frame, FrameInputs* inputs) const override {
    if (IsByPressure(actuator_, *inputs))
      inputs->cables.at(At(actuator_)).value += value * read_N_.at(At(frame));
  }

  std::vector<Influence> InfluencesOn(const robot::RobotModel&, double, int frame,
                                      const FrameInputs& inputs) const override {
    return OfThrust(actuator_, inputs, read_N_.at(At(frame)));
  }

 private:
  int actuator_;
  std::vector<double> read_N_;
};

}  // namespace

UnknownPtr PressureZero(int actuator, const std::string& chamber, double area_m2,
                        const GaussianPrior& prior) {
  return std::make_unique<ZeroOfPressure>(actuator, chamber, area_m2, prior);
}

UnknownPtr PressureGain(int actuator, const std::string& chamber, std::vector<double> read_N,
                        const GaussianPrior& prior, std::string what_would_tell) {
  return std::make_unique<GainOfPressure>(actuator, chamber, std::move(read_N), prior,
                                          std::move(what_would_tell));
}

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

/// A chamber that these data command by pressure.
struct Supplied {
  const robot::BodyChamber& chamber;
  Eigen::Index actuator;  ///< of the timeline
  double area_m2;         ///< of its piston

  CauseName Named(const std::string& id) const { return {id, {"chamber:" + chamber.name}}; }
};

std::vector<Supplied> SuppliedChambers(const CatalogueInputs& inputs) {
  const Timeline& timeline = inputs.observed.timeline;
  std::vector<Supplied> supplied;
  for (std::size_t c = 0; c < inputs.body.chambers.size(); ++c) {
    const std::size_t actuator = inputs.body.cables.size() + c;
    if (!timeline.by_tension[actuator]) continue;
    supplied.push_back(
        {inputs.body.chambers[c], ToIndex(actuator), timeline.actuators[actuator].area_m2});
  }
  return supplied;
}

/// The files have no standard errors: the verdict has them.
void AddTo(std::optional<robot::CalibratedNumber>* number, double z) {
  if (!*number) number->emplace();
  (*number)->value += z;
}

/// Data sheets have 0.25 to 1 % of the reading.
class PressureGainFault final : public FaultModel {
 public:
  explicit PressureGainFault(const Supplied& at)
      : FaultModel(
            at.Named("pressure_gain"), "gain of the pressure sensor of chamber " + at.chamber.name,
            {{.name = "g", .tolerance = 0.01, .fault = 0.25, .least = -0.9, .plausible = 0.7}}),
        actuator_(at.actuator),
        chamber_(at.chamber.name) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.gain[actuator_] += z[0];
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* /*robot*/,
              robot::CalibrationFile* calibration) const override {
    AddTo(&PressureSensorOf(chamber_, calibration).gain, z[0]);
    return true;
  }

 private:
  Eigen::Index actuator_;
  std::string chamber_;
};

class PressureZeroFault final : public FaultModel {
 public:
  /// As a fault, of the largest pressure.
  static constexpr double kFault = 0.05;

  explicit PressureZeroFault(const Supplied& at)
      : FaultModel(at.Named("pressure_zero"),
                   "zero of the pressure sensor of chamber " + at.chamber.name,
                   {{.name = "zero_Pa",
                     .tolerance = 100.0,
                     .fault = std::max(300.0, kFault * at.chamber.max_pressure_Pa)}}),
        actuator_(at.actuator),
        area_m2_(at.area_m2),
        chamber_(at.chamber.name) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.pressure_zero_N[actuator_] += z[0] * area_m2_;
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* /*robot*/,
              robot::CalibrationFile* calibration) const override {
    AddTo(&PressureSensorOf(chamber_, calibration).zero_Pa, z[0]);
    return true;
  }

 private:
  Eigen::Index actuator_;
  double area_m2_;
  std::string chamber_;
};

class SlowValve final : public FaultModel {
 public:
  explicit SlowValve(const Supplied& at)
      : FaultModel(at.Named("slow_valve"), "slow valve of chamber " + at.chamber.name,
                   {{.name = "tau_s", .tolerance = 0.01, .fault = 0.3, .least = 0.0}}),
        actuator_(at.actuator) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.valve_tau_s[actuator_] += std::max(0.0, z[0]);
  }

 private:
  Eigen::Index actuator_;
};

/// A chamber without a hole has none: no tolerance.
class Leak final : public FaultModel {
 public:
  explicit Leak(const Supplied& at)
      : FaultModel(at.Named("leak"), "leak of chamber " + at.chamber.name,
                   {{.name = "ratio", .fault = 0.5, .least = 0.0}}),
        actuator_(at.actuator) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.leak_ratio[actuator_] += std::max(0.0, z[0]);
  }

 private:
  Eigen::Index actuator_;
};

/// z = 1: from a recording on the chamber keeps its pressure; 0: it does not. Nothing between is
/// possible.
class BlockedValve final : public FaultModel {
 public:
  /// `first_alike`: blocked from there on it would do the same, as nothing was driven in between.
  BlockedValve(const Supplied& at, int recording, double from_s, int first_alike)
      : FaultModel(
            at.Named("blocked_valve"), "blocked valve of chamber " + at.chamber.name,
            {{.name = "blocked", .fault = 0.02, .fault_at = 1.0, .least = 0.0, .most = 1.0}}),
        actuator_(at.actuator),
        recording_(recording),
        from_s_(from_s),
        first_alike_(first_alike) {}

  bool OnActuators() const override { return true; }
  std::optional<int> Start() const override { return recording_; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.blocked_share[actuator_] = std::clamp(z[0], 0.0, 1.0);
    hypothesis->actuators.blocked_from_s[actuator_] = from_s_;
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& /*z*/,
                                      const Eigen::MatrixXd& /*covariance*/,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    const auto recording = static_cast<double>(recording_);
    return {{"from_recording", recording, static_cast<double>(first_alike_), recording}};
  }

 private:
  Eigen::Index actuator_;
  int recording_;
  double from_s_;
  int first_alike_;
};

/// z = 1: each of two supplies feeds the other's chamber; 0: its own. Nothing between is possible.
class SwappedTubes final : public FaultModel {
 public:
  SwappedTubes(const Supplied& a, const Supplied& b)
      : FaultModel(
            {"swapped_tubes", {"chamber:" + a.chamber.name, "chamber:" + b.chamber.name}},
            "tubes of chambers " + a.chamber.name + " and " + b.chamber.name + " swapped",
            {{.name = "swapped", .fault = 0.02, .fault_at = 1.0, .least = 0.0, .most = 1.0}}),
        a_(a.actuator),
        b_(b.actuator),
        area_of_b_(b.area_m2 / a.area_m2),
        name_a_(a.chamber.name),
        name_b_(b.chamber.name) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    Eigen::MatrixXd& mixing = hypothesis->actuators.mixing;
    mixing(a_, a_) -= z[0];
    mixing(b_, b_) -= z[0];
    mixing(a_, b_) += z[0] / area_of_b_;
    mixing(b_, a_) += z[0] * area_of_b_;
  }

  /// Each supply by the chamber that it feeds.
  bool Extend(const Eigen::VectorXd& /*z*/, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    const auto named = [&](const std::string& name) -> robot::ChamberSettings& {
      return *std::find_if(robot->chambers.begin(), robot->chambers.end(),
                           [&](const auto& chamber) { return chamber.name == name; });
    };
    robot::ChamberSettings& a = named(name_a_);
    robot::ChamberSettings& b = named(name_b_);
    std::swap(a.surface, b.surface);
    std::swap(a.max_pressure_Pa, b.max_pressure_Pa);
    return true;
  }

  std::vector<FittedParameter> Report(const Eigen::VectorXd& /*z*/,
                                      const Eigen::MatrixXd& /*covariance*/,
                                      const Eigen::VectorXd& /*undeformed_m*/) const override {
    return {};
  }

 private:
  Eigen::Index a_;
  Eigen::Index b_;
  double area_of_b_;  ///< over that of a
  std::string name_a_;
  std::string name_b_;
};

/// Whether the actuator gets more than nothing in a recording.
bool IsDriven(const Timeline& timeline, Eigen::Index actuator, std::size_t recording) {
  for (std::size_t k = 0; k < timeline.t_s.size(); ++k) {
    if (timeline.t_s[k] < timeline.begin_s[recording]) continue;
    if (timeline.t_s[k] > timeline.end_s[recording]) continue;
    const double command = timeline.command[k][actuator];
    if (!std::isnan(command) && command != 0.0) return true;
  }
  return false;
}

template <typename Fault>
void MakeOfEach(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (const Supplied& chamber : SuppliedChambers(inputs))
    faults->push_back(std::make_unique<Fault>(chamber));
}

}  // namespace

void MakePressureGain(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  MakeOfEach<PressureGainFault>(inputs, faults);
}

void MakePressureZero(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  MakeOfEach<PressureZeroFault>(inputs, faults);
}

void MakeSlowValve(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  MakeOfEach<SlowValve>(inputs, faults);
}

void MakeLeak(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  MakeOfEach<Leak>(inputs, faults);
}

void MakeBlockedValve(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const Timeline& timeline = inputs.observed.timeline;
  for (const Supplied& chamber : SuppliedChambers(inputs)) {
    int first_alike = 0;
    for (std::size_t r = 0; r < timeline.begin_s.size(); ++r) {
      if (!IsDriven(timeline, chamber.actuator, r)) continue;
      const int recording = static_cast<int>(r);
      faults->push_back(
          std::make_unique<BlockedValve>(chamber, recording, timeline.begin_s[r], first_alike));
      first_alike = recording + 1;
    }
  }
}

void MakeSwappedTubes(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const std::vector<Supplied> chambers = SuppliedChambers(inputs);
  for (std::size_t a = 0; a < chambers.size(); ++a) {
    for (std::size_t b = a + 1; b < chambers.size(); ++b) {
      faults->push_back(std::make_unique<SwappedTubes>(chambers[a], chambers[b]));
    }
  }
}

}  // namespace palpate::diagnosis

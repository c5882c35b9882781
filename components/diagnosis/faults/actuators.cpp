// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "components/diagnosis/faults/makers.hpp"
#include "libs/core/index.hpp"

namespace palpate::diagnosis {

namespace {

class CableGainFault final : public FaultModel {
 public:
  CableGainFault(const std::string& cable, int index)
      : FaultModel({"cable_gain", {"cable:" + cable}}, "gain of the actuator of cable " + cable,
                   {{.name = "g",
                     .tolerance = 0.005,
                     .fault = 0.08,
                     .least = -0.9,
                     .plausible = 0.2}}),  // a drum is not a fifth too large
        index_(index) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.gain[index_] += z[0];
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* /*robot*/,
              robot::CalibrationFile* calibration) const override {
    DriveOf(name().where.front().substr(std::string("cable:").size()), calibration).drive.gain +=
        z[0];
    return true;
  }

 private:
  Eigen::Index index_;
};

}  // namespace

void MakeCableGain(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (std::size_t c = 0; c < inputs.body.cables.size(); ++c) {
    faults->push_back(
        std::make_unique<CableGainFault>(inputs.body.cables[c].name, static_cast<int>(c)));
  }
}

namespace {

class CableOffsetFault final : public FaultModel {
 public:
  CableOffsetFault(const std::string& cable, int index)
      : FaultModel({"cable_offset", {"cable:" + cable}},
                   "zero offset of the actuator of cable " + cable,
                   {{.name = "offset_m", .tolerance = 3e-4, .fault = 4e-3}}),
        index_(index) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.offset_m[index_] += z[0];
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* /*robot*/,
              robot::CalibrationFile* calibration) const override {
    DriveOf(name().where.front().substr(std::string("cable:").size()), calibration)
        .drive.offset_m += z[0];
    return true;
  }

 private:
  Eigen::Index index_;
};

}  // namespace

void MakeCableOffset(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (std::size_t c = 0; c < inputs.body.cables.size(); ++c) {
    if (inputs.observed.timeline.by_tension[c]) continue;
    faults->push_back(
        std::make_unique<CableOffsetFault>(inputs.body.cables[c].name, static_cast<int>(c)));
  }
}

namespace {

/// The play begins in its middle; of z the size counts.

class Backlash final : public FaultModel {
 public:
  Backlash(const std::string& cable, int index)
      : FaultModel({"backlash", {"cable:" + cable}}, "backlash in the actuator of cable " + cable,
                   {{.name = "play_m", .tolerance = 1e-4, .fault = 4e-3, .least = 0.0}}),
        index_(index) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.play_m[index_] += z[0];
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* robot,
              robot::CalibrationFile* /*calibration*/) const override {
    double& play_m = robot->cables[At(index_)].play_m;
    play_m = std::max(0.0, play_m + z[0]);
    return true;
  }

 private:
  Eigen::Index index_;
};

}  // namespace

void MakeBacklash(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  for (std::size_t c = 0; c < inputs.body.cables.size(); ++c) {
    if (inputs.observed.timeline.by_tension[c]) continue;
    faults->push_back(std::make_unique<Backlash>(inputs.body.cables[c].name, static_cast<int>(c)));
  }
}

namespace {

class DriveCouplingFault final : public FaultModel {
 public:
  DriveCouplingFault(const robot::BodyCable& driven, int driven_index, const robot::BodyCable& by,
                     int by_index)
      : FaultModel({"drive_coupling", {"cable:" + driven.name, "cable:" + by.name}},
                   "cable " + driven.name + " coupled to cable " + by.name,
                   {{.name = "coupling", .tolerance = 0.005, .fault = 0.1}}),
        driven_(driven_index),
        by_(by_index) {}

  bool OnActuators() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->actuators.mixing(driven_, by_) += z[0];
  }

 private:
  Eigen::Index driven_;
  Eigen::Index by_;
};

}  // namespace

void MakeDriveCoupling(const CatalogueInputs& inputs, std::vector<FaultModelPtr>* faults) {
  const std::vector<robot::BodyCable>& cables = inputs.body.cables;
  for (std::size_t driven = 0; driven < cables.size(); ++driven) {
    for (std::size_t by = 0; by < cables.size(); ++by) {
      if (by == driven) continue;
      faults->push_back(std::make_unique<DriveCouplingFault>(
          cables[driven], static_cast<int>(driven), cables[by], static_cast<int>(by)));
    }
  }
}

}  // namespace palpate::diagnosis

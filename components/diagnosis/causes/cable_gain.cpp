// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

class CableGainCause final : public FaultModel {
 public:
  CableGainCause(const std::string& cable, int index)
      : FaultModel({"cable_gain", {"cable:" + cable}}, "gain of the drive of cable " + cable,
                   {{.name = "g",
                     .tolerance = 0.005,
                     .fault = 0.08,
                     .least = -0.9,
                     .plausible = 0.2}}),  // a drum is not a fifth too large
        index_(index) {}

  bool OnDrives() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->drives.gain[index_] += z[0];
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* /*robot*/,
              std::vector<robot::CalibratedDrive>* drives) const override {
    DriveOf(name().where.front().substr(std::string("cable:").size()), drives).drive.gain += z[0];
    return true;
  }

 private:
  Eigen::Index index_;
};

}  // namespace

void MakeCableGainCause(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  for (std::size_t c = 0; c < world.body.cables.size(); ++c) {
    causes->push_back(
        std::make_unique<CableGainCause>(world.body.cables[c].name, static_cast<int>(c)));
  }
}

}  // namespace palpate::diagnosis

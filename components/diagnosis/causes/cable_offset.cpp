// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

class CableOffsetCause final : public FaultModel {
 public:
  CableOffsetCause(const std::string& cable, int index)
      : FaultModel({"cable_offset", {"cable:" + cable}}, "zero of the drive of cable " + cable,
                   {{.name = "offset_m", .tolerance = 3e-4, .fault = 4e-3}}),
        index_(index) {}

  bool OnDrives() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->drives.offset_m[index_] += z[0];
  }

  bool Extend(const Eigen::VectorXd& z, robot::RobotDescription* /*robot*/,
              std::vector<robot::CalibratedDrive>* drives) const override {
    DriveOf(name().where.front().substr(std::string("cable:").size()), drives).drive.offset_m +=
        z[0];
    return true;
  }

 private:
  Eigen::Index index_;
};

}  // namespace

void MakeCableOffsetCause(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  for (std::size_t c = 0; c < world.body.cables.size(); ++c) {
    if (world.observed.timeline.by_tension[c]) continue;
    causes->push_back(
        std::make_unique<CableOffsetCause>(world.body.cables[c].name, static_cast<int>(c)));
  }
}

}  // namespace palpate::diagnosis

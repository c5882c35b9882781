// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

class DriveCouplingCause final : public FaultModel {
 public:
  DriveCouplingCause(const robot::BodyCable& driven, int driven_index, const robot::BodyCable& by,
                     int by_index)
      : FaultModel({"drive_coupling", {"cable:" + driven.name, "cable:" + by.name}},
                   "cable " + driven.name + " moving along with cable " + by.name,
                   {{.name = "coupling", .fault = 0.1}}),
        driven_(driven_index),
        by_(by_index) {}

  bool OnDrives() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->drives.mixing(driven_, by_) += z[0];
  }

 private:
  Eigen::Index driven_;
  Eigen::Index by_;
};

}  // namespace

void MakeDriveCoupling(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  const std::vector<robot::BodyCable>& cables = world.body.cables;
  for (std::size_t driven = 0; driven < cables.size(); ++driven) {
    for (std::size_t by = 0; by < cables.size(); ++by) {
      if (by == driven) continue;
      causes->push_back(std::make_unique<DriveCouplingCause>(
          cables[driven], static_cast<int>(driven), cables[by], static_cast<int>(by)));
    }
  }
}

}  // namespace palpate::diagnosis

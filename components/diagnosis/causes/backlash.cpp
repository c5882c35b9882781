// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

/// The play begins in its middle; of z the size counts.

class Backlash final : public FaultModel {
 public:
  Backlash(const std::string& cable, int index)
      : FaultModel({"backlash", {"cable:" + cable}}, "play in the drive of cable " + cable,
                   {{.name = "play_m", .tolerance = 1e-4, .fault = 4e-3, .least = 0.0}}),
        index_(index) {}

  bool OnDrives() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelHypothesis* hypothesis) const override {
    hypothesis->drives.play_m[index_] += z[0];
  }

 private:
  Eigen::Index index_;
};

}  // namespace

void MakeBacklash(const CauseWorld& world, std::vector<FaultModelPtr>* causes) {
  for (std::size_t c = 0; c < world.body.cables.size(); ++c) {
    if (world.observed.timeline.by_tension[c]) continue;
    causes->push_back(std::make_unique<Backlash>(world.body.cables[c].name, static_cast<int>(c)));
  }
}

}  // namespace palpate::diagnosis

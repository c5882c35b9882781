// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/causes/makers.hpp"

namespace palpate::diagnosis {

namespace {

class Lag final : public Cause {
 public:
  Lag()
      : Cause({"lag", {"body"}}, "lag of the drives",
              {{.name = "delay_s", .tolerance = 0.01, .fault = 0.15, .least = 0.0},
               {.name = "tau_s", .fault = 0.15, .least = 0.0}}) {}

  bool OnDrives() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelDraft* draft) const override {
    draft->drives.delay_s += z[0];
    draft->drives.tau_s += std::max(0.0, z[1]);
  }
};

}  // namespace

void MakeLag(const CauseWorld& world, std::vector<CausePtr>* causes) {
  if (world.body.cables.empty()) return;
  causes->push_back(std::make_unique<Lag>());
}

}  // namespace palpate::diagnosis

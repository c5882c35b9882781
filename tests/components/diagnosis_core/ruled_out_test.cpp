// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "components/diagnosis/inference/selection.hpp"
#include "tests/components/diagnosis_core/hidden_causes.hpp"

namespace palpate::diagnosis {
namespace {

/// What a gain does, as something of which no robot has so much.
class GainInDisguise final : public Cause {
 public:
  explicit GainInDisguise(int number)
      : Cause({"disguise", {std::to_string(number)}}, "a gain in disguise",
              {{.name = "z",
                .tolerance = 0.001,
                .fault = 0.02,
                .fault_at = kGain,
                .plausible = 0.05}}) {}

  static constexpr double kGain = 0.1;

  bool OnDrives() const override { return true; }
  void Apply(const Eigen::VectorXd& z, ModelDraft* draft) const override {
    draft->drives.gain[0] += z[0];
  }
};

class RuledOut : public HiddenCauses {
 protected:
  /// With so many causes in disguise beside the real ones.
  Selection Select(int disguises) {
    Measure({{"cable_gain", "cable:up", GainInDisguise::kGain}});
    std::vector<CausePtr> causes = MakeCauses({.body = body_, .observed = observed_}, {});
    for (int k = 0; k < disguises; ++k) causes.push_back(std::make_unique<GainInDisguise>(k));
    with_disguises_ =
        std::make_unique<CauseBook>(std::move(causes), std::map<std::string, double>());
    const Fitter fitter(observed_, body_, *with_disguises_, {}, 1);
    return SelectCauses(observed_, fitter, fitter.AsBuilt(), 1, [](int, int, const auto&) {});
  }
  std::string IdOf(int cause) const { return with_disguises_->cause(cause).name().id; }

  std::unique_ptr<CauseBook> with_disguises_;
};

/// However many are simulated first in vain.
TEST_F(RuledOut, CausesMakeRoomForTheNextOnes) {
  const Selection selection = Select(6);
  ASSERT_EQ(selection.named.size(), 1U) << "seed " << kSeed;
  EXPECT_EQ(IdOf(selection.named[0].cause), "cable_gain");
  EXPECT_GT(selection.named[0].probability, 0.9) << "what was ruled out is no rival";
  EXPECT_TRUE(selection.alike.empty());
}

}  // namespace
}  // namespace palpate::diagnosis

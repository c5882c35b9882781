// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/palpate/markers/marked_bar.hpp"

/// `palpate calibrate` on a bar that is larger than its robot file says.
namespace palpate::command {
namespace {

using testing::HasSubstr;

class BarOfAnotherSize : public MarkedBar {
 protected:
  void Enlarge(double scale) {
    robot::RobotBody body = truth_->body();
    robot::ScaleBody(scale, &body);
    truth_ = std::make_unique<robot::RobotModel>(std::move(body));
  }
  static double NumberAfter(const std::string& words, const std::string& text) {
    const std::size_t at = text.find(words);
    return at == std::string::npos ? 0.0 : std::stod(text.substr(at + words.size()));
  }
  /// Spread of twelve markers about their middle, at rest.
  static double Spread_mm() {
    Eigen::Matrix3Xd places_m(3, 12);
    for (Eigen::Index m = 0; m < 12; ++m) places_m.col(m) = Twelve()[static_cast<std::size_t>(m)];
    const Eigen::Vector3d middle_m = places_m.rowwise().mean();
    return 1e3 * std::sqrt((places_m.colwise() - middle_m).colwise().squaredNorm().mean());
  }
};

TEST_F(BarOfAnotherSize, IsFoundWrittenAndTakenByTheEstimate) {
  constexpr double kScale = 1.03;
  Enlarge(kScale);
  RecordThree({});
  const ProgramRun run = Calibrate({"--geometry-scale-sigma", "0.02"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("size: 1.0"));
  const robot::CalibrationFile found = Found();
  ASSERT_TRUE(found.geometry_scale);
  EXPECT_NEAR(found.geometry_scale->scale, kScale, 4.0 * found.geometry_scale->standard_error);
  EXPECT_LT(found.geometry_scale->standard_error, 5e-3);
  EXPECT_LT(found.residual_rms_m, 3e-4);
  const auto forces = folder_ / "forces.csv";
  const ProgramRun estimate =
      Run({"estimate", robot_.string(), "--data", (folder_ / "data").string(), "--calibration",
           (folder_ / "calibration.yaml").string(), "--out", forces.string()});
  EXPECT_EQ(estimate.exit_code, 0) << estimate.output;
  EXPECT_TRUE(std::filesystem::exists(forces));
}

TEST_F(BarOfAnotherSize, IsSaidWithBothSizesWhereItIsRefused) {
  Enlarge(1.3);
  for (const bool names : {true, false}) {
    RecordThree({.names = names});
    const ProgramRun run = Calibrate();
    ExpectFailure(run, "the sizes disagree: markers are ");
    const double seen_mm = NumberAfter("disagree: markers are ", run.output);
    const double model_mm = NumberAfter("those of the model ", run.output);
    EXPECT_NEAR(seen_mm, 1.3 * Spread_mm(), 0.05 * Spread_mm());
    EXPECT_NEAR(model_mm, Spread_mm(), 0.05 * Spread_mm());
    EXPECT_NEAR(NumberAfter("or one ", run.output), seen_mm / model_mm, 0.006);
  }
}

}  // namespace
}  // namespace palpate::command

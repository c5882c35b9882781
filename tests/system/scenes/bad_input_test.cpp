// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "tests/support/robots.hpp"
#include "tests/support/sensing/sensing_chain.hpp"

/// Images and cable inputs that are wrong, on their way through perception and estimator, while a
/// ball presses with a force that is known: no estimate says a wrong force, and soon after it has
/// gone the right one is there again.
namespace palpate::test_support {
namespace {

using force_estimation::ForceEstimate;

constexpr double kDegree = std::numbers::pi / 180.0;
/// Largest error of a right force over its interval: three sigmas, since many frames are evaluated.
constexpr double kOfInterval = 1.53;
/// Frames from the end of the trouble to the first right one, itself counted.
constexpr int kFramesToRecover = 5;
/// A contact that the camera loses must show for so long before it is said (ContactTracks).
constexpr int kFramesToFindHidden = 4;

template <typename Image>
void Fill(Image* image, typename decltype(Image::values)::value_type value) {
  std::fill(image->values.begin(), image->values.end(), value);
}

/// Without depth in these columns and rows, shares of the image.
ChainFaults WithoutDepth(double u_begin, double u_end, double v_begin, double v_end) {
  return {.images =
              [=](rgbd::RgbdFrame* frame) {
                rgbd::DepthImage& depth = frame->depth;
                const auto at = [](double share, int size) {
                  return static_cast<int>(share * static_cast<double>(size));
                };
                for (int v = at(v_begin, depth.height_px); v < at(v_end, depth.height_px); ++v) {
                  for (int u = at(u_begin, depth.width_px); u < at(u_end, depth.width_px); ++u) {
                    *depth.Pixel(u, v) = 0;
                  }
                }
              },
          .cables = {}};
}

/// One system for all cases, which begin and end with a right estimate.
class BadInput : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<SensingScene>(FourLegRobot(), BallScenario(), 1);
    chain_ = std::make_unique<SensingChain>(FourLegRobot(), *scene_, Settings(), 1);
    chain_->Learn(8);
    Press(*chain_);
  }
  static void TearDownTestSuite() {
    chain_.reset();
    scene_.reset();
  }

  static ChainSettings Settings() {
    ChainSettings settings;
    settings.eyes = ChainSettings::Eyes::kPerception;
    return settings;
  }

  /// On the flank of the hub that the camera sees, with 0.7 N.
  static void Press(SensingChain& chain) {
    scenario::BenchInputs inputs = scene_->Nothing();
    for (const double at_m : {0.035, 0.029, 0.026, 0.024, 0.022}) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = Eigen::Vector3d(at_m, -at_m, 0.103);
      inputs.tools = {{"ball_10", pose}};
      ASSERT_TRUE(scene_->Go(inputs).ok());
      chain.Take();
    }
    ASSERT_EQ(scene_->state().forces.size(), 1u);
  }

  static double Truth_N() { return scene_->state().forces.at(0).force_N.norm(); }

  static bool IsRight(const ForceEstimate& estimate) {
    if (!estimate.status.ok() || estimate.contacts.size() != 1) return false;
    const force_estimation::ContactForce& contact = estimate.contacts[0];
    return std::abs(contact.force_N.norm() - Truth_N()) <= kOfInterval * contact.ci95_N;
  }
  static bool IsNoContact(const ForceEstimate& estimate) {
    return estimate.status.code() == StatusCode::kNoContact;
  }
  static bool IsFlagged(const ForceEstimate& estimate) {
    return !estimate.status.ok() && !IsNoContact(estimate) && !estimate.status.message().empty();
  }

  static std::string Said(const ForceEstimate& estimate) {
    std::ostringstream text;
    text << ToString(estimate.status.code()) << " '" << estimate.status.message() << "', truth "
         << Truth_N() << " N";
    for (const auto& contact : estimate.contacts) {
      text << ", " << contact.name << " " << contact.force_N.norm() << " +- " << contact.ci95_N;
    }
    return text.str();
  }

  static void ExpectFlagged(int frames) {
    for (int k = 0; k < frames; ++k) {
      const ForceEstimate& estimate = chain_->Take();
      EXPECT_TRUE(IsFlagged(estimate)) << k << ": " << Said(estimate);
    }
  }

  /// The force is right, or it is said that there is none to be had; a contact that perception has
  /// lost is missing for a short while.
  static void ExpectNothingWrong(int frames) {
    int missing = 0;
    for (int k = 0; k < frames; ++k) {
      const ForceEstimate& estimate = chain_->Take();
      missing = IsNoContact(estimate) ? missing + 1 : 0;
      const bool fine = IsNoContact(estimate) ? missing <= kFramesToFindHidden
                                              : IsRight(estimate) || IsFlagged(estimate);
      EXPECT_TRUE(fine) << k << ": " << Said(estimate);
    }
  }

  static void ExpectRecovery(const std::string& from) {
    chain_->SetFaults({});
    for (int k = 1;; ++k) {
      const ForceEstimate& estimate = chain_->Take();
      EXPECT_TRUE(IsRight(estimate) || IsFlagged(estimate) || IsNoContact(estimate))
          << from << ", " << k << " frames later: " << Said(estimate);
      if (IsRight(estimate)) return;
      ASSERT_LT(k, kFramesToRecover) << from << ": " << Said(estimate);
    }
  }

  static std::unique_ptr<SensingScene> scene_;
  static std::unique_ptr<SensingChain> chain_;
};

std::unique_ptr<SensingScene> BadInput::scene_;
std::unique_ptr<SensingChain> BadInput::chain_;

TEST_F(BadInput, ImagesThatShowNothingAreSaid) {
  ExpectRecovery("the beginning");
  chain_->SetFaults({.images = [](rgbd::RgbdFrame* frame) { *frame = {}; }, .cables = {}});
  ExpectFlagged(5);
  ExpectRecovery("empty images");
  for (const std::uint16_t depth : {std::uint16_t{0}, std::uint16_t{65535}}) {
    chain_->SetFaults(
        {.images = [depth](rgbd::RgbdFrame* frame) { Fill(&frame->depth, depth); }, .cables = {}});
    ExpectFlagged(5);
    ExpectRecovery("depth of " + std::to_string(depth));
  }
  scene_->TurnCamera(
      Eigen::Quaterniond(Eigen::AngleAxisd(90.0 * kDegree, Eigen::Vector3d::UnitY())));
  ExpectFlagged(5);
  scene_->TurnCamera(Eigen::Quaterniond::Identity());
  ExpectRecovery("a camera turned away");
}

TEST_F(BadInput, CableInputsThatAreNoNumbersAreSaid) {
  ExpectRecovery("the beginning");
  chain_->SetFaults({.images = {}, .cables = [](std::vector<robot::ActuatorCommand>* cables) {
                       cables->front().value = std::numeric_limits<double>::quiet_NaN();
                     }});
  ExpectFlagged(3);
  EXPECT_EQ(chain_->Take().status.code(), StatusCode::kInvalidInput);
  ExpectRecovery("NaN of a cable");
}

TEST_F(BadInput, ImagesThatShowAPartGiveTheForceOrSaySo) {
  ExpectRecovery("the beginning");
  chain_->SetFaults(
      {.images = [](rgbd::RgbdFrame* frame) { Fill(&frame->color, 255); }, .cables = {}});
  ExpectNothingWrong(5);
  ExpectRecovery("saturated colour");
  chain_->SetFaults(WithoutDepth(0.0, 0.5, 0.0, 1.0));
  ExpectNothingWrong(6);
  ExpectRecovery("no left half");
  chain_->SetFaults(WithoutDepth(0.5, 1.0, 0.0, 1.0));
  ExpectNothingWrong(6);
  ExpectRecovery("no right half");
  chain_->SetFaults(WithoutDepth(0.0, 1.0, 0.0, 0.5));
  ExpectNothingWrong(6);
  ExpectRecovery("no upper half");
}

TEST_F(BadInput, TwentyObjectsThatDoNotTouchChangeNothing) {
  ExpectRecovery("the beginning");
  const SceneState before = scene_->state();
  SceneState crowd = before;
  scenario::Random random(3, "crowd");
  while (crowd.inputs.tools.size() < before.inputs.tools.size() + 20) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() =
        Eigen::Vector3d(0.3 * random.Uniform() - 0.15, 0.3 * random.Uniform() - 0.15,
                        0.03 + 0.12 * random.Uniform());
    const double away_m =
        (before.nodes_m.colwise() - pose.translation()).colwise().norm().minCoeff();
    if (away_m < 0.018) continue;
    crowd.inputs.tools.push_back({crowd.inputs.tools.size() % 2 ? "ball_8" : "ball_10", pose});
  }
  scene_->Show(crowd);
  ExpectNothingWrong(5);
  EXPECT_TRUE(IsRight(chain_->Take()));
  scene_->Show(before);
  ExpectRecovery("the crowd");
}

TEST_F(BadInput, WrongIntrinsicsAndACameraThatWasKnockedAreSaid) {
  ExpectRecovery("the beginning");
  rgbd::RgbdCamera camera = scene_->camera();
  camera.depth.fx_px *= 1.3;
  camera.color.fx_px *= 1.3;
  chain_->TellCamera(camera);
  ExpectFlagged(1);
  chain_->TellCamera(scene_->camera());
  ExpectRecovery("a focal length that is wrong");
  scene_->TurnCamera(
      Eigen::Quaterniond(Eigen::AngleAxisd(1.0 * kDegree, Eigen::Vector3d::UnitY())));
  ExpectFlagged(2);
  scene_->TurnCamera(Eigen::Quaterniond::Identity());
  ExpectRecovery("a camera knocked by a degree");
}

}  // namespace
}  // namespace palpate::test_support

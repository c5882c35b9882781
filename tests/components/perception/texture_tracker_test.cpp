// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/texture/texture_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/core/statistics.hpp"
#include "libs/geometry/ray.hpp"
#include "tests/components/perception/labelled_scene.hpp"

namespace palpate::perception {
namespace {

constexpr int kFramesAtRest = 3;
constexpr int kFramesToFindAll = 3;
/// A colour camera beside the depth camera, or one whose pixels are those of the depth image.
enum class ColorCamera { kRegistered, kBeside };

/// Points of texture held against the material points of the drawn robot.
class TextureTrackerTest : public testing::TestWithParam<ColorCamera> {
 protected:
  TextureTrackerTest() : scenario_{PushScenario()} {
    rgbd::RgbdCamera& camera = scenario_.camera->camera;
    camera.color = camera.depth;
    camera.color_registered = GetParam() == ColorCamera::kRegistered;
    if (camera.color_registered) return;
    camera.color.fx_px = camera.color.fy_px = 1.3 * camera.depth.fx_px;
    camera.T_depth_color.translation() = Eigen::Vector3d(0.025, 0.0, 0.0);
  }

  /// Shows a recording's state; the prediction is `off_m` beside it (camera frame).
  void Show(const std::string& recording, double t_s,
            const Eigen::Vector3d& off_m = Eigen::Vector3d::Zero()) {
    if (scene_ == nullptr) {
      scene_ = std::make_unique<LabelledScene>(scenario_);
      tracker_ =
          std::make_unique<TextureTracker>(TextureConfig{.max_points = 150}, scene_->camera());
    }
    const virtual_camera::View view = PushedView(scenario_, recording, t_s);
    scene_->Take(view);
    const PredictedSurface predicted = Predict(scenario_, view.nodes_m, off_m);
    const PredictedSurface truth = Predict(scenario_, view.nodes_m);
    rgbd::RgbdFrame frame = scene_->frame();
    frame.stamp_ns = ++stamp_ns_;
    Compare({truth.vertices_m, truth.triangles}, tracker_->Follow(frame, &predicted, Tools()));
  }

  /// The points of what is not the robot, as a segmentation finds them.
  rgbd::SensedCloud Tools() const {
    const rgbd::RgbdFrame& frame = scene_->frame();
    std::vector<Eigen::Vector3f> points_m;
    for (int v = 0; v < frame.depth.height_px; v += 2) {
      for (int u = 0; u < frame.depth.width_px; u += 2) {
        if (!scene_->Tells(u, v) || scene_->TruthAt(u, v) != Truth::kTool) continue;
        const double z_m = *frame.depth.Pixel(u, v) * scene_->camera().depth_unit_m;
        points_m.push_back(
            (z_m * rgbd::Unproject(scene_->camera().depth, Eigen::Vector2d(u, v))).cast<float>());
      }
    }
    rgbd::SensedCloud cloud;
    cloud.points_m.resize(3, ToIndex(points_m.size()));
    for (std::size_t k = 0; k < points_m.size(); ++k) {
      cloud.points_m.col(ToIndex(k)) = points_m[k];
    }
    return cloud;
  }

  void ShowRest(const std::string& recording) {
    for (int k = 0; k < kFramesAtRest; ++k) Show(recording, 0.0);
    learns_ = false;
  }

  /// At rest the first sight of a point says which material point it is. Those that come later
  /// have none to be compared with.
  void Compare(const geometry::TriangleSurface& surface, const rgbd::TexturePoints& points) {
    errors_px_.clear();
    squared_sigmas_.clear();
    for (Eigen::Index k = 0; k < points.Count(); ++k) {
      const Eigen::Vector3d direction = points.directions.col(k).cast<double>();
      const std::uint64_t id = points.ids[At(k)];
      if (learns_ && !material_.contains(id)) {
        const auto hit = geometry::FirstOnRay(surface, points.origin_m, direction);
        ASSERT_TRUE(hit) << "a point beside the robot";
        material_[id] = *hit;
      } else if (material_.contains(id)) {
        const Eigen::Vector3d expected = PlaceOf(material_[id], surface) - points.origin_m;
        const double off_rad = expected.normalized().cross(direction).norm();
        const double sigma_rad = points.sigma_rad[k];
        errors_px_.push_back(off_rad * scene_->camera().color.fx_px);
        // both the first sight and this one err, in two directions
        squared_sigmas_.push_back(off_rad * off_rad / (4.0 * sigma_rad * sigma_rad));
      }
    }
  }

  static Eigen::Vector3d PlaceOf(const geometry::SurfacePoint& point,
                                 const geometry::TriangleSurface& surface) {
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      place_m += point.barycentric[corner] * surface.Corner(point.triangle, corner);
    }
    return place_m;
  }

  scenario::Scenario scenario_;
  std::unique_ptr<LabelledScene> scene_;
  std::unique_ptr<TextureTracker> tracker_;
  std::int64_t stamp_ns_ = 1'700'000'000'000'000'000;
  bool learns_ = true;
  std::map<std::uint64_t, geometry::SurfacePoint> material_;
  std::vector<double> errors_px_;       ///< of the last frame
  std::vector<double> squared_sigmas_;  ///< 1 where they are as large as is said
};

TEST_P(TextureTrackerTest, FollowsMaterialPointsWhereTheRobotIsPushed) {
  ShowRest("02_push");
  for (const double t_s : {0.5, 1.0, 1.5, 2.0}) {
    Show("02_push", t_s, {5e-4, -3e-4, 4e-4});
    EXPECT_GT(errors_px_.size(), 50U) << t_s;
    EXPECT_LT(Median(errors_px_), 0.15) << t_s;
    EXPECT_LT(Quantile(errors_px_, 0.95), 0.6) << t_s;
    EXPECT_LT(Median(squared_sigmas_), 1.0) << t_s;
  }
}

TEST_P(TextureTrackerTest, FindsThePointsAgainWhereThePredictionIsFarOff) {
  ShowRest("04_ramp");
  for (const double off_m : {2e-3, 10e-3}) {
    for (int k = 0; k < kFramesToFindAll; ++k) Show("04_ramp", 4.0, {off_m, -0.5 * off_m, 4e-4});
    EXPECT_GT(errors_px_.size(), 50U) << off_m;
    EXPECT_LT(Quantile(errors_px_, 0.95), 0.3) << off_m;
  }
}

TEST_P(TextureTrackerTest, SkinWithoutTextureHasNoPointsAndItSaysSo) {
  LabelledScene scene(scenario_);
  TextureTracker tracker(TextureConfig{.max_points = 150}, scene.camera());
  const virtual_camera::View view = RestView(scenario_);
  const PredictedSurface predicted = Predict(scenario_, view.nodes_m);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(128.0, 2.0);
  for (int k = 0; k < TextureTrackerTuning{}.frames_to_judge; ++k) {
    EXPECT_FALSE(tracker.note());
    scene.Take(view);
    rgbd::RgbdFrame frame = scene.frame();
    for (std::uint8_t& value : frame.color.values) {
      value = static_cast<std::uint8_t>(noise(random));
    }
    EXPECT_LT(tracker.Follow(frame, &predicted, {}).Count(), 5);
  }
  EXPECT_TRUE(tracker.note());
}

TEST_P(TextureTrackerTest, WithoutAPredictionNothingIsFollowed) {
  ShowRest("02_push");
  EXPECT_EQ(tracker_->Follow(scene_->frame(), nullptr, {}).Count(), 0);
}

/// A process that starts again must not take a point for another one that had its number.
TEST_P(TextureTrackerTest, NumbersOfPointsAreNotUsedAgainAfterARestart) {
  ShowRest("02_push");
  std::vector<std::uint64_t> before;
  for (const auto& [id, point] : material_) before.push_back(id);
  ASSERT_GT(before.size(), 50U);
  tracker_ = std::make_unique<TextureTracker>(TextureConfig{.max_points = 150}, scene_->camera());
  material_.clear();
  learns_ = true;
  ShowRest("02_push");
  EXPECT_GT(material_.size(), 50U);
  for (const std::uint64_t id : before) EXPECT_FALSE(material_.contains(id));
}

INSTANTIATE_TEST_SUITE_P(Cameras, TextureTrackerTest,
                         testing::Values(ColorCamera::kRegistered, ColorCamera::kBeside),
                         [](const auto& test) {
                           return test.param == ColorCamera::kRegistered ? "registered" : "beside";
                         });

/// Two waves, moved.
GrayWindow Waves(const Eigen::Vector2d& moved_px, double gain = 1.0, double brightness = 100.0) {
  constexpr int kSize_px = 60;
  rgbd::ColorImage color(kSize_px, kSize_px);
  for (int v = 0; v < kSize_px; ++v) {
    for (int u = 0; u < kSize_px; ++u) {
      const double x = u - moved_px.x();
      const double y = v - moved_px.y();
      const double value = brightness + gain * (30.0 * std::sin(0.5 * x) * std::cos(0.4 * y) +
                                                20.0 * std::sin(0.31 * y + 0.2 * x));
      for (int channel = 0; channel < 3; ++channel) {
        color.Pixel(u, v)[channel] = static_cast<std::uint8_t>(std::lround(value));
      }
    }
  }
  GrayWindow window;
  window.Take(color, {.u_begin = 0, .v_begin = 0, .u_end = kSize_px, .v_end = kSize_px}, 0);
  return window;
}

TEST(TexturePatch, IsFoundToAHundredthOfAPixelWhateverTheLight) {
  const TexturePatch patch(Waves({0.0, 0.0}), 30, 30);
  const Eigen::Vector2f guess_px(31.0f, 29.0f);
  for (const double gain : {0.6, 1.0, 1.5}) {
    const auto found =
        patch.Find(Waves({1.3, -0.7}, gain, 110.0), Eigen::Matrix2f::Identity(), guess_px, {});
    ASSERT_TRUE(found) << gain;
    EXPECT_NEAR(found->place_px.x(), 31.3f, 0.02f);
    EXPECT_NEAR(found->place_px.y(), 29.3f, 0.02f);
    EXPECT_GT(found->correlation, 0.98f);
  }
}

TEST(TexturePatch, AnotherPictureIsNotIt) {
  const TexturePatch patch(Waves({0.0, 0.0}), 30, 30);
  const auto found = patch.Find(Waves({0.0, 0.0}, -1.0), Eigen::Matrix2f::Identity(),
                                Eigen::Vector2f(30.0f, 30.0f), {});
  EXPECT_FALSE(found);
}

TEST(TexturePatch, LeavesTheWindowWithoutAResult) {
  const GrayWindow window = Waves({0.0, 0.0});
  const TexturePatch patch(window, 30, 30);
  EXPECT_FALSE(patch.Find(window, Eigen::Matrix2f::Identity(), Eigen::Vector2f(4.0f, 30.0f), {}));
}

}  // namespace
}  // namespace palpate::perception

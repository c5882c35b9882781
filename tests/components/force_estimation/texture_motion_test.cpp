// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/force_estimation/shape/texture_motion.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "libs/core/index.hpp"
#include "libs/geometry/ray.hpp"
#include "tests/support/robots.hpp"

namespace palpate::force_estimation {
namespace {

constexpr float kSigma_rad = 1e-4f;

/// Some points on the surface of the four-legged robot, seen by a camera in front of it.
class TextureMotionTest : public testing::Test {
 protected:
  TextureMotionTest()
      : body_{robot::BuildRobotBody(test_support::FourLegRobot())}, features_{body_} {
    const Eigen::Matrix3Xd& nodes_m = body_.mesh.nodes_m;
    rest_m_ = Eigen::Map<const Eigen::VectorXd>(nodes_m.data(), nodes_m.size());
    view_.T_robot_camera.translation() = Eigen::Vector3d(0.5, 0.02, 0.08);
    view_.T_robot_camera.linear() = (Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                        .toRotationMatrix();
    view_.texture.origin_m = {0.02, 0.0, 0.0};
    std::mt19937 random(2);
    std::uniform_real_distribution<double> aside(-0.03, 0.03);
    while (points_.size() < 40) {
      const Eigen::Vector3d at_m(0.0, aside(random), 0.09 + 0.5 * aside(random));
      const Eigen::Vector3d origin_m = view_.T_robot_camera * view_.texture.origin_m;
      if (const auto hit = geometry::FirstOnRay(Surface(rest_m_), origin_m, at_m - origin_m)) {
        points_.push_back(*hit);
      }
    }
  }

  geometry::TriangleSurface Surface(const Eigen::VectorXd& x_m) const {
    return {Eigen::Map<const Eigen::Matrix3Xd>(x_m.data(), 3, x_m.size() / 3),
            features_.triangles()};
  }

  /// What the camera sees of the points where the nodes are at `x_m`; all lines turned by an error.
  ShapeFrame See(const Eigen::VectorXd& x_m, const Eigen::Vector3d& error_rad) const {
    const geometry::TriangleSurface surface = Surface(x_m);
    ShapeFrame frame;
    frame.views = {view_};
    rgbd::TexturePoints& texture = frame.views[0].texture;
    texture.directions.resize(3, ToIndex(points_.size()));
    texture.sigma_rad = Eigen::VectorXf::Constant(ToIndex(points_.size()), kSigma_rad);
    for (std::size_t k = 0; k < points_.size(); ++k) {
      Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
      for (int corner = 0; corner < 3; ++corner) {
        place_m += points_[k].barycentric[corner] * surface.Corner(points_[k].triangle, corner);
      }
      const Eigen::Vector3d ray =
          (view_.T_robot_camera.inverse() * place_m - texture.origin_m).normalized();
      texture.ids.push_back(static_cast<std::uint64_t>(k) + 7);
      texture.directions.col(ToIndex(k)) = (ray + error_rad.cross(ray)).normalized().cast<float>();
    }
    return frame;
  }

  double LargestResidual_m(const std::vector<TextureMatch>& matches,
                           const Eigen::VectorXd& x_m) const {
    double largest_m = 0.0;
    for (const TextureMatch& match : matches) {
      for (int i = 0; i < 2; ++i) {
        largest_m = std::max(largest_m, std::abs(match.target_m[i] - match.rows[At(i)].Value(x_m)));
      }
    }
    return largest_m;
  }

  robot::RobotBody body_;
  correspondence::SurfaceFeatures features_;
  Eigen::VectorXd rest_m_;
  ShapeView view_;
  std::vector<geometry::SurfacePoint> points_;
};

TEST_F(TextureMotionTest, RowsHoldWhereTheMaterialPointsAre) {
  TextureMotion motion(features_);
  motion.Learn(See(rest_m_, Eigen::Vector3d::Zero()), rest_m_);
  Eigen::VectorXd bent_m = rest_m_;
  for (Eigen::Index n = 0; n < bent_m.size() / 3; ++n) {
    const double z_m = rest_m_[3 * n + 2];
    bent_m.segment<3>(3 * n) += Eigen::Vector3d(0.1, 0.2, -0.05) * z_m * z_m / 0.1;
  }
  const auto& matches = motion.Match(See(bent_m, Eigen::Vector3d::Zero()));
  ASSERT_GT(matches.size(), 3U);
  int count = 0;
  for (const TextureMatch& match : matches) count += match.count;
  EXPECT_EQ(count, 40);
  EXPECT_LT(LargestResidual_m(matches, bent_m), 1e-6);
  EXPECT_GT(LargestResidual_m(matches, rest_m_), 1e-3);
}

TEST_F(TextureMotionTest, AConstantErrorOfTheCameraCancels) {
  TextureMotion motion(features_);
  const Eigen::Vector3d error_rad(2e-3, -1e-3, 3e-3);
  motion.Learn(See(rest_m_, Eigen::Vector3d::Zero()), rest_m_);  // binds the points
  TextureMotion turned(features_);
  turned.Learn(See(rest_m_, error_rad), rest_m_);
  Eigen::VectorXd moved_m = rest_m_;
  for (Eigen::Index n = 0; n < moved_m.size() / 3; ++n) moved_m[3 * n + 1] += 2e-3;
  EXPECT_GT(LargestResidual_m(motion.Match(See(moved_m, error_rad)), moved_m), 1e-3);
  EXPECT_LT(LargestResidual_m(turned.Match(See(moved_m, error_rad)), moved_m), 1e-4)
      << "the rest is of its depth";
}

TEST_F(TextureMotionTest, TheMeanOverContactFreeFramesIsTakenOff) {
  TextureMotion motion(features_);
  motion.Learn(See(rest_m_, Eigen::Vector3d::Zero()), rest_m_);
  const double once_m = motion.Match(See(rest_m_, Eigen::Vector3d::Zero())).front().sigma_m;
  for (int k = 0; k < 9; ++k) motion.Learn(See(rest_m_, {1e-3, 0.0, 0.0}), rest_m_);
  const auto& matches = motion.Match(See(rest_m_, {0.9e-3, 0.0, 0.0}));
  EXPECT_LT(LargestResidual_m(matches, rest_m_), 2e-6);
  EXPECT_NEAR(matches.front().sigma_m / once_m, std::sqrt(1.1 / 2.0), 1e-6);
}

TEST_F(TextureMotionTest, PointsThatWereNotSeenWithoutContactTellNothing) {
  TextureMotion motion(features_);
  EXPECT_TRUE(motion.Match(See(rest_m_, Eigen::Vector3d::Zero())).empty());
}

}  // namespace
}  // namespace palpate::force_estimation

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/calibration/cloud/surface_errors.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "libs/geometry/surface_sampling.hpp"
#include "tests/components/calibration/cloud/cloud_scene.hpp"

namespace palpate::calibration {
namespace {

/// Two settings of the cables, in which the camera sees the same places of the surface.
class SurfaceErrorsTest : public ::testing::Test {
 protected:
  SurfaceErrorsTest() {
    const fem::BoundarySurface& boundary = model_->body().boundary;
    const auto rest = fem::RestSurface(model_->body().mesh, boundary);
    const geometry::SurfaceSamples places = geometry::SampleByArea(rest, 400);
    for (CalibrationFrame& frame : frames_) {
      for (int k = 0; k < places.Count(); ++k) {
        const int face = places.triangles[static_cast<size_t>(k)];
        const Eigen::Vector3i corners = boundary.faces.col(face).head<3>();
        frame.surface.push_back({.sigma_m = 1e-3,
                                 .point = {{corners[0], corners[1], corners[2]}, {0.5, 0.25, 0.25}},
                                 .normal = places.normals.col(k)});
      }
    }
    std::normal_distribution<double> normal(0.0, 2e-3);
    for (Eigen::VectorXd& shape_m : shapes_m_) {
      shape_m = rest_m_;
      for (double& x_m : shape_m) x_m += normal(random_);
    }
  }

  std::vector<bool> Share(const SurfaceErrorSettings& settings) {
    return SurfaceErrors(model_->body(), rest_m_, settings).Share(shapes_m_, &frames_);
  }

  Eigen::Vector3d PlaceOf(const SurfaceSighting& sighting) const {
    return sighting.point.Position(model_->body().mesh.nodes_m.reshaped());
  }

  double Moved_m(std::size_t frame, const SurfaceSighting& sighting) const {
    return sighting.normal.dot(sighting.point.Position(shapes_m_[frame] - rest_m_));
  }

  /// Covariance of the errors at two sightings, m^2.
  static double Covariance(const SurfaceSighting& a, const SurfaceSighting& b) {
    std::map<int, double> parts;
    for (const SharedError& error : a.shared) parts[error.number] += error.per_unit_m;
    double sum = 0.0;
    for (const SharedError& error : b.shared) {
      if (parts.count(error.number) > 0) sum += parts[error.number] * error.per_unit_m;
    }
    return sum;
  }

  std::unique_ptr<robot::RobotModel> model_ = Build(QuickFourLegRobot());
  Eigen::VectorXd rest_m_ = model_->RestState().x_m;
  std::vector<Eigen::VectorXd> shapes_m_{2};
  std::vector<CalibrationFrame> frames_{2};
  std::mt19937_64 random_{20261124};
};

TEST_F(SurfaceErrorsTest, AreAsLargeEverywhereAsTheSettingsSay) {
  const SurfaceErrorSettings s;
  Share(s);
  const double resting_m2 = s.whole_sigma_m * s.whole_sigma_m + s.patch_sigma_m * s.patch_sigma_m +
                            s.region_sigma_m * s.region_sigma_m;
  const double per_motion =
      s.motion_sigma * s.motion_sigma + s.region_motion_sigma * s.region_motion_sigma;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    for (const SurfaceSighting& sighting : frames_[f].surface) {
      const double moved_m = Moved_m(f, sighting);
      const double expected_m2 = resting_m2 + per_motion * moved_m * moved_m;
      EXPECT_NEAR(Covariance(sighting, sighting), expected_m2, 1e-9 * expected_m2);
    }
  }
}

TEST_F(SurfaceErrorsTest, AreThoseOfTheSamePlaceInAllSettingsButForWhatMoves) {
  const std::vector<bool> are_models_own =
      Share({.motion_sigma = 0.0, .region_motion_sigma = 0.02});
  for (std::size_t k = 0; k < frames_[0].surface.size(); ++k) {
    const SurfaceSighting& here = frames_[0].surface[k];
    const SurfaceSighting& there = frames_[1].surface[k];
    std::map<int, double> parts;
    for (const SharedError& error : here.shared) parts[error.number] = error.per_unit_m;
    for (const SharedError& error : there.shared) {
      const bool is_shared = parts.count(error.number) > 0;
      EXPECT_EQ(is_shared, are_models_own.at(static_cast<size_t>(error.number)));
      if (is_shared) {
        EXPECT_EQ(parts[error.number], error.per_unit_m);
      }
    }
  }
}

TEST_F(SurfaceErrorsTest, AreAlikeNearbyAndTheirOwnFarAway) {
  const SurfaceErrorSettings regions{
      .whole_sigma_m = 0.0, .patch_sigma_m = 0.0, .motion_sigma = 0.0, .region_motion_sigma = 0.0};
  Share(regions);
  const double variance_m2 = regions.region_sigma_m * regions.region_sigma_m;
  int near = 0, far = 0;
  for (const SurfaceSighting& a : frames_[0].surface) {
    for (const SurfaceSighting& b : frames_[0].surface) {
      const double away_m = (PlaceOf(a) - PlaceOf(b)).norm();
      const double correlation = Covariance(a, b) / variance_m2;
      if (away_m < 0.1 * regions.region_m && a.normal.dot(b.normal) > 0.99) {
        EXPECT_GT(correlation, 0.9);
        ++near;
      } else if (away_m > 3.0 * regions.region_m) {
        EXPECT_LT(std::abs(correlation), 0.1);
        ++far;
      }
    }
  }
  EXPECT_GT(near, 400);
  EXPECT_GT(far, 400);
}

TEST_F(SurfaceErrorsTest, SidesOfALegHavePatchesOfTheirOwn) {
  Share({.whole_sigma_m = 0.0,
         .region_sigma_m = 0.0,
         .motion_sigma = 0.0,
         .region_motion_sigma = 0.0});
  for (const SurfaceSighting& a : frames_[0].surface) {
    for (const SurfaceSighting& b : frames_[0].surface) {
      if (a.normal.dot(b.normal) < -0.9) {
        EXPECT_EQ(Covariance(a, b), 0.0);
      }
    }
  }
}

TEST_F(SurfaceErrorsTest, AreNoneWhereTheModelCountsAsRight) {
  EXPECT_TRUE(Share(NoSurfaceErrors()).empty());
  EXPECT_TRUE(frames_[1].surface.front().shared.empty());
}

}  // namespace
}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/inference/linear_model.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "libs/linalg/cholesky.hpp"

namespace palpate::diagnosis {
namespace {

constexpr unsigned kLinearSeed = 7;
constexpr Eigen::Index kParameters = 3;
constexpr Eigen::Index kMarkerCount = 2;

/// Four samples of two recordings, two markers, made up.
class LinearModelTest : public testing::Test {
 protected:
  LinearModelTest() {
    observed_.recordings.resize(2);
    observed_.recordings[1].T_measurement_robot.linear() =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
    observed_.recordings[1].T_measurement_robot.translation() << 0.2, -0.1, 0.4;
    observed_.sigma_m << 1e-4, 2e-4, 5e-4;
    observed_.markers.resize(kMarkerCount);
    for (int s = 0; s < 4; ++s) {
      Sample& sample = observed_.samples.emplace_back();
      sample.recording = s < 3 ? 0 : 1;
      sample.position_m = 0.1 * Random(3, kMarkerCount);
      sample.count = Eigen::Vector2i(1 + s, 5);
      SimulatedSample& simulated = simulation_.samples.emplace_back();
      simulated.status = Status::Ok();
      simulated.seen_m = (0.1 * Random(3, kMarkerCount)).reshaped();
      simulated.markers = kMarkerCount;
      simulated.jacobian_m = Random(3 * kMarkerCount, kParameters);
    }
    rest_m_ = 0.1 * Random(3, kMarkerCount);
    z_ = Random(kParameters, 1);
  }

  Eigen::MatrixXd Random(Eigen::Index rows, Eigen::Index cols) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return normal(random_); });
  }

  LinearModel Model() const { return Linearise(observed_, simulation_, z_, rest_m_, noise_); }

  /// What a recording says, from the covariance of each of its series.
  Information Dense(int recording) const {
    Information all(kParameters);
    for (Eigen::Index coordinate = 0; coordinate < 3 * kMarkerCount; ++coordinate) {
      std::vector<std::size_t> seen;
      for (std::size_t s = 0; s < observed_.samples.size(); ++s) {
        const Sample& sample = observed_.samples[s];
        if (sample.recording == recording && sample.count[coordinate / 3] > 0) seen.push_back(s);
      }
      if (seen.empty()) continue;
      const Information one = DenseSeries(recording, coordinate, seen);
      all.H += one.H;
      all.b += one.b;
      all.c += one.c;
      all.rows += one.rows;
    }
    return all;
  }

  Information DenseSeries(int recording, Eigen::Index coordinate,
                          const std::vector<std::size_t>& seen) const {
    const auto rows = std::ssize(seen);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows);
    Eigen::VectorXd common(rows);
    Eigen::MatrixXd J(rows, kParameters);
    Eigen::VectorXd y(rows);
    const Eigen::Vector3d rest_m =
        observed_.recordings[static_cast<std::size_t>(recording)].T_measurement_robot *
        rest_m_.col(coordinate / 3);
    for (Eigen::Index k = 0; k < rows; ++k) {
      const std::size_t s = seen[static_cast<std::size_t>(k)];
      const double sigma_m = observed_.sigma_m[coordinate % 3];
      covariance(k, k) = sigma_m * sigma_m / observed_.samples[s].count[coordinate / 3];
      const SimulatedSample& simulated = simulation_.samples[s];
      common[k] =
          noise_.relative_error * (simulated.markers_m().col(coordinate / 3) - rest_m).norm();
      J.row(k) = simulated.jacobian_m.row(coordinate);
      y[k] = observed_.samples[s].position_m(coordinate % 3, coordinate / 3) -
             simulated.markers_m()(coordinate % 3, coordinate / 3) + J.row(k).dot(z_);
    }
    covariance += common * common.transpose();
    if (observed_.recordings[static_cast<std::size_t>(recording)].held_until_s) {
      covariance.array() += observed_.reference_sigma_m * observed_.reference_sigma_m;
    }
    const Eigen::MatrixXd inverse = linalg::InverseSymmetric(covariance);
    Information information(kParameters);
    information.H = J.transpose() * inverse * J;
    information.b = J.transpose() * inverse * y;
    information.c = y.dot(inverse * y);
    information.rows = static_cast<int>(rows);
    return information;
  }

  void ExpectAsDense(const LinearModel& model) const {
    for (int recording = 0; recording < 2; ++recording) {
      const Information one = model.OfRecording(static_cast<std::size_t>(recording));
      const Information dense = Dense(recording);
      EXPECT_EQ(one.rows, dense.rows);
      EXPECT_TRUE(one.H.isApprox(dense.H, 1e-8)) << one.H << "\n\n" << dense.H;
      EXPECT_TRUE(one.b.isApprox(dense.b, 1e-8));
      EXPECT_NEAR(one.c, dense.c, 1e-8 * dense.c);
    }
  }

  std::mt19937 random_{kLinearSeed};
  ObservedExperiment observed_;
  Simulation simulation_;
  Eigen::Matrix3Xd rest_m_;
  Eigen::VectorXd z_;
  NoiseModel noise_{.relative_error = 0.01};
};

TEST_F(LinearModelTest, AHeldReferenceIsAConstantOfEachSeries) {
  observed_.recordings[0].held_until_s = 0.5;
  observed_.reference_sigma_m = 2e-3;
  ExpectAsDense(Model());
}

TEST_F(LinearModelTest, WeighsByNoiseOfFramesAndWhatTheMeshHasInCommon) { ExpectAsDense(Model()); }

TEST_F(LinearModelTest, WithoutAMeshErrorOnlyByTheNoise) {
  noise_.relative_error = 0.0;
  ExpectAsDense(Model());
}

TEST_F(LinearModelTest, WhatWasNotSeenOrNotSolvedHasNoRows) {
  EXPECT_EQ(Model().y.size(), 24);
  observed_.samples[1].count[0] = 0;
  observed_.samples[1].position_m.col(0).setConstant(std::numeric_limits<double>::quiet_NaN());
  const LinearModel model = Model();
  EXPECT_EQ(model.y.size(), 21);
  EXPECT_TRUE(model.y.allFinite() && model.J.allFinite());
  ExpectAsDense(model);
  simulation_.samples[3].status = Status(StatusCode::kNotConverged, "made up");
  simulation_.samples[3].seen_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  const LinearModel without = Model();
  EXPECT_EQ(without.y.size(), 15);
  EXPECT_EQ(without.rows_of_recording[1], 0);
  EXPECT_TRUE(without.y.allFinite() && without.J.allFinite());
}

TEST_F(LinearModelTest, RowsKnowTheirMomentAndAddUp) {
  const LinearModel model = Model();
  ASSERT_EQ(std::ssize(model.sample_of_row), model.y.size());
  for (std::size_t row = 0; row < model.sample_of_row.size(); ++row) {
    EXPECT_EQ(model.sample_of_row[row] == 3, row >= 18) << row;
  }
  EXPECT_EQ(model.coordinate_of_row[0], 0);
  EXPECT_EQ(model.coordinate_of_row[3], 1);
  EXPECT_TRUE(model.All().H.isApprox(model.J.transpose() * model.J, 1e-9));
  // A difference of sums.
  EXPECT_TRUE(model.AllBut(0).b.isApprox(model.OfRecording(1).b, 1e-9));
  EXPECT_TRUE(model.AllBut(0).H.isApprox(model.OfRecording(1).H, 1e-9));
}

}  // namespace
}  // namespace palpate::diagnosis

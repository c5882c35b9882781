// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "components/diagnosis/data/observed_experiment.hpp"
#include "components/diagnosis/forward/simulation.hpp"

namespace palpate::diagnosis {

/// What a set of measurements says about parameters z, linear about a point:
/// -2 ln p(y | z) = c - 2 b' z + z' H z, constants left out. Adds up over independent measurements.
struct Information {
  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  double c = 0.0;
  int rows = 0;
  Eigen::VectorXd about;  ///< the z about which it is linear

  explicit Information(Eigen::Index parameters);
  /// What is left without `part`, measurements that are among these.
  void Remove(const Information& part);
};

/// An experiment linearised about z, whitened: y - J z is noise of unit variance. Rows of one
/// recording and coordinate share the mesh's error (NoiseModel) and, of markers, where the
/// recording counts from a shape in which the body was held, that shape's.
struct LinearModel {
  Eigen::MatrixXd J;  ///< [rows x parameters], one recording after the other
  Eigen::VectorXd y;  ///< [rows]
  std::vector<int> sample_of_row;
  std::vector<int> coordinate_of_row;  ///< 3 marker + axis, then features of the surface
  std::vector<Eigen::Index> rows_of_recording;

  /// Of all rows. To be called again when J or y changed.
  void Sum(const Eigen::VectorXd& about);
  const Information& All() const { return all_; }
  /// The z about which it is linear is another than that of y.
  void SetAbout(const Eigen::VectorXd& z) { all_.about = z; }
  Eigen::MatrixXd RowsOf(std::size_t recording) const;  ///< of J
  Information OfRecording(std::size_t recording) const;
  Information AllBut(std::size_t recording) const;

 private:
  Eigen::Index FirstRowOf(std::size_t recording) const;

  Information all_{0};
};

struct NoiseModel {
  /// What a mesh gets wrong, as a share of how far a marker, or the surface, is displaced: of each
  /// coordinate and recording a constant, one sigma. Noise that no averaging removes.
  double relative_error = 0.01;
  /// The same of the surface, m: where it lies beside its drawing and the camera's smooth error,
  /// from another side, or in another shape.
  double skin_error_m = 1e-4;
};

/// About `z` [parameters], at which `simulation` with its Jacobian was made. Samples that failed
/// and what was not seen have no rows. `rest_m` [3 x markers]: of the undeformed body. Threads
/// share the recordings.
LinearModel Linearise(const ObservedExperiment& observed, const Simulation& simulation,
                      const Eigen::VectorXd& z, const Eigen::Matrix3Xd& rest_m,
                      const NoiseModel& noise, int threads = 1);

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "libs/core/status.hpp"
#include "libs/fem/surface_patch.hpp"
#include "libs/robot/effector_row.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::force_estimation {

/// How the whole body moves, to first order, when a unit force along x, y or z acts on one of many
/// patches: three columns of K^-1 for each, solved once and kept. Cables at imposed displacement
/// hold their length, slack ones stay slack (eq. (14) solved for the cables, as CableElimination
/// does). Kept in single precision: 4 bytes times rows of the reduced system times 3 patches.
class PatchResponses {
 public:
  /// Columns about `x_m` with the factor that `model` has. kUnobservable where two taut cables act
  /// alike, kInvalidInput where a column comes out infinite.
  Status Solve(robot::RobotModel& model, const std::vector<fem::SurfacePatch>& patches,
               const Eigen::VectorXd& x_m, const std::vector<robot::CableCommand>& commands,
               const Eigen::VectorXd& lambda_a_N);

  Eigen::Index ColumnCount() const { return columns_.cols(); }  ///< 3 for each patch
  size_t MemoryBytes() const {
    return static_cast<size_t>(columns_.size()) * sizeof(*columns_.data());
  }

  /// [rows x 3 patches] what the rows, each times its `scale`, do under the unit forces.
  Eigen::MatrixXd Observe(const std::vector<robot::EffectorRow>& rows,
                          const Eigen::VectorXd& scale) const;

 private:
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  RowMajor columns_;             ///< [reduced x 3 patches]
  std::vector<int> free_index_;  ///< [nodes]
};

/// The same [rows x 3 patches] of these rows alone, about another `x_m` with the factor that
/// `model` has there: as K is symmetric, a substitution for each row serves all patches. Fails as
/// Solve.
Status ObserveAbout(robot::RobotModel& model, const std::vector<fem::SurfacePatch>& patches,
                    const std::vector<robot::EffectorRow>& rows, const Eigen::VectorXd& x_m,
                    const std::vector<robot::CableCommand>& commands,
                    const Eigen::VectorXd& lambda_a_N, Eigen::MatrixXd* observed);

}  // namespace palpate::force_estimation

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <vector>

#include "libs/fem/fibre.hpp"
#include "libs/fem/stiffness_matrix.hpp"

namespace palpate::fem {

/// Forces of fibres in a body, and their exact tangent. With the stretch l = |t| / |T| of a point,
/// t and T its direction deformed and at rest, and ds the rest length that it stands for, the
/// energy is sum EA/2 (l - 1)^2 ds. It depends on the stretches only, so the forces have neither
/// resultant nor moment, and turn with the body. A fibre resists compression as it resists tension:
/// it is embedded, and the body keeps it from buckling. So the energy is smooth at rest.
class FibreForces {
 public:
  /// `rest_m` [3n]; may differ from where the fibres were laid: they are material lines.
  FibreForces(const std::vector<EmbeddedFibre>& fibres, const Eigen::VectorXd& rest_m);

  /// Adds dEnergy/dx [3n], N.
  void AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const;
  double Energy(const Eigen::VectorXd& x_m) const;
  /// Of each fibre, its strain l - 1 where that is largest in size; [fibres].
  Eigen::VectorXd LargestStrains(const Eigen::VectorXd& x_m) const;

  /// Looks up its blocks once; AddTangent needs it.
  void BindTo(const StiffnessMatrix& stiffness);
  void AddTangent(const Eigen::VectorXd& x_m, StiffnessMatrix& stiffness) const;

  /// Adds factor * K dx to `force_N` [3n], over all nodes, held ones included.
  void AddAlongPositions(const Eigen::VectorXd& x_m, const Eigen::VectorXd& dx_m, double factor,
                         Eigen::VectorXd& force_N) const;
  /// Adds factor * dF/dX [dX] at fixed x: the rest lengths change.
  void AddAlongRestShape(const Eigen::VectorXd& x_m, const Eigen::VectorXd& dX_m, double factor,
                         Eigen::VectorXd& force_N) const;

 private:
  struct Point {
    int fibre;
    double stiffness_Nm;             ///< EA ds / |T|^2: of the length of t, which has no unit
    Eigen::Vector3d rest_direction;  ///< T
    std::vector<double> weights;     ///< [nodes of its cell]
  };
  /// Points in one cell, whose tangents are summed before they go to the matrix.
  struct Cell {
    std::vector<int> nodes;
    std::vector<BlockSlot> slots;  ///< of the pairs (a, b), b <= a
    size_t first_point = 0;
    size_t end_point = 0;
  };
  /// Direction of a point and what it resists with.
  struct Pull;

  static Eigen::Vector3d Direction(const Cell& cell, const Point& point,
                                   const Eigen::VectorXd& nodal);
  static void Scatter(const Cell& cell, const Point& point, const Eigen::Vector3d& pull_Nm,
                      Eigen::VectorXd& force_N);
  /// Calls work(cell, point) for every point.
  template <typename Work>
  void OnEveryPoint(const Work& work) const;

  std::vector<Point> points_;  ///< those of a cell lie together
  std::vector<Cell> cells_;
  int fibre_count_;
};

}  // namespace palpate::fem

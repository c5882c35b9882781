// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <vector>

namespace palpate::test_support {

/// A hyperelastic body of ten-node tetrahedra whose equilibria CalculiX (`ccx` on PATH) computes:
/// no line of it is palpate's. Lengths in mm, forces in N, moduli in MPa, robot frame.
class CalculixBody {
 public:
  struct Material {
    double youngs_modulus_MPa = 0.1;  ///< of the small-strain limit of a neo-Hookean solid
    double poissons_ratio = 0.45;
    double density_t_mm3 = 1.07e-9;
  };
  /// A point of the surface: weights of the six nodes of a face.
  struct SurfacePoint {
    std::size_t face = 0;
    std::array<double, 3> barycentric = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  };
  using Loads = std::map<int, Eigen::Vector3d>;  ///< force on a node, N
  using Positions = std::vector<Eigen::Vector3d>;

  /// Corner nodes and tetrahedra; mid-edge nodes are added.
  CalculixBody(Positions corners_mm, const std::vector<std::array<int, 4>>& tetrahedra,
               const Material& material);
  /// The tetrahedra of an ASCII file of Gmsh 4.1, whose unit is mm.
  static CalculixBody FromGmsh(const std::filesystem::path& file, const Material& material);
  /// A bar of `cells` bricks, six tetrahedra each, from corner `low` to corner `high`.
  static CalculixBody Bar(const Eigen::Vector3d& low_mm, const Eigen::Vector3d& high_mm,
                          const std::array<int, 3>& cells, const Material& material);

  /// Nodes for which this is true do not move.
  void Fix(const std::function<bool(const Eigen::Vector3d& position_mm)>& is_fixed);

  /// Equilibrium under gravity (z up) and the loads. Throws std::runtime_error where ccx fails.
  Positions Solve(const Loads& loads) const;

  const Positions& nodes_mm() const { return nodes_mm_; }
  const std::vector<std::array<int, 6>>& faces() const { return faces_; }  ///< from outside
  Eigen::Vector3d At(const SurfacePoint& point, const Positions& positions_mm) const;
  Eigen::Vector3d NormalAt(const SurfacePoint& point, const Positions& positions_mm) const;
  double AreaOf(std::size_t face) const;
  /// `force_N` as a pressure that falls to zero `radius_mm` from the point, of the undeformed body.
  void Press(const SurfacePoint& point, double radius_mm, const Eigen::Vector3d& force_N,
             Loads* loads) const;
  /// Barycentric weights of a point inside the body over the corners of its tetrahedron.
  std::map<int, double> WeightsInside(const Eigen::Vector3d& position_mm) const;
  /// [4 per face] triangles of the surface.
  std::vector<std::array<int, 3>> Triangles() const;

 private:
  Positions nodes_mm_;
  std::vector<std::array<int, 10>> cells_;
  std::vector<std::array<int, 6>> faces_;
  std::vector<int> fixed_;
  Material material_;
};

}  // namespace palpate::test_support

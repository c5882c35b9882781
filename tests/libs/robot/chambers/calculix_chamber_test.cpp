// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <vector>

#include "libs/fem/boundary_surface.hpp"
#include "libs/robot/chamber.hpp"
#include "tests/libs/fem/verification/calculix.hpp"
#include "tests/libs/fem/verification/grid_mesh.hpp"
#include "tests/libs/robot/chambers/hollow_bodies.hpp"

namespace palpate::robot {
namespace {

using fem::verification::StaticProblem;

/// That the pressure follows the wall is 3 % of the answer. At
/// larger pressures CalculiX's integration over faces that bend (three points) shows.
constexpr double kBarPressure_Pa = 1e3;

/// A bar of 60 x 20 x 20 mm, clamped at x = 0, with a hollow off its axis: pressure bends it. The
/// material is CalculiX's neo-Hookean (Yeoh's first term).
StaticProblem HollowBar(fem::ElementType element) {
  const Eigen::Array3i cells(6, 4, 4);
  const fem::TetMesh box = fem::verification::MakeBox(cells, element, {0.06, 0.02, 0.02});
  StaticProblem bar(
      KeepCells(box,
                [](const Eigen::Vector3d& p) {
                  return p.x() < 0.010 || p.x() > 0.050 || p.y() < 0.005 || p.y() > 0.015 ||
                         p.z() < 0.010 || p.z() > 0.015;
                }),
      {.model = fem::MaterialModel::kYeoh, .youngs_modulus_Pa = 150e3, .poissons_ratio = 0.45});
  bar.Fix([](const Eigen::Vector3d& p) { return p.x() < 1e-9; });
  return bar;
}

/// The pressure on the faces of the hollow, for CalculiX.
void Press(double pressure_Pa, StaticProblem* bar) {
  const fem::BoundarySurface boundary = fem::ExtractBoundary(bar->mesh);
  const std::vector<int> faces = fem::InnerSkins(bar->mesh, boundary).at(0);
  for (const int face : faces) {
    const int cell = boundary.cells[face];
    for (int corner = 0; corner < 4; ++corner) {
      const int node = bar->mesh.cells(corner, cell);
      if ((boundary.faces.col(face).head<3>().array() == node).any()) continue;
      bar->pressures.push_back({cell, corner, pressure_Pa});
    }
  }
}

class ChamberInCalculix : public testing::TestWithParam<fem::ElementType> {};

TEST_P(ChamberInCalculix, BendsABarAlike) {
  const auto ccx = fem::verification::FindCalculix();
  if (!ccx) GTEST_SKIP() << "ccx (CalculiX, package calculix-ccx) is not installed";
  StaticProblem bar = HollowBar(GetParam());
  Chamber chamber(CavityWall(bar.mesh), bar.mesh.nodes_m.reshaped());
  bar.constraints = {&chamber};
  bar.commands = {{.mode = fem::ConstraintCommand::Mode::kMultiplier,
                   .value = kBarPressure_Pa * chamber.area_m2()}};
  const fem::verification::Solution ours = fem::verification::Solve(bar);
  ASSERT_TRUE(ours.result.status.ok()) << ours.result.status.message();
  Press(kBarPressure_Pa, &bar);
  const Eigen::VectorXd theirs_m = SolveWithCalculix(*ccx, bar);
  EXPECT_GT(theirs_m.lpNorm<Eigen::Infinity>(), 5e-5);  // it bends
  EXPECT_LE((ours.u_m - theirs_m).norm(), 1e-4 * theirs_m.norm());
}

INSTANTIATE_TEST_SUITE_P(Elements, ChamberInCalculix,
                         testing::Values(fem::ElementType::kTet4, fem::ElementType::kTet10),
                         [](const auto& of) {
                           return of.param == fem::ElementType::kTet4 ? "Tet4" : "Tet10";
                         });

}  // namespace
}  // namespace palpate::robot

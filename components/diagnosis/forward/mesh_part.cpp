// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/diagnosis/forward/mesh_part.hpp"

#include <array>
#include <map>
#include <utility>

#include "libs/core/index.hpp"
#include "libs/fem/refined_mesh.hpp"

namespace palpate::diagnosis {

namespace {

/// [cells] whether they have a corner of `cell`: one more layer of them changes what finer elements
/// add by less than a tenth.
std::vector<bool> CellsAbout(const fem::TetMesh& mesh, int cell) {
  const auto corners = mesh.cells.topRows<4>();
  std::vector<bool> chosen(static_cast<std::size_t>(mesh.CellCount()), false);
  for (int k = 0; k < mesh.CellCount(); ++k) {
    for (const int node : corners.col(cell)) {
      chosen[At(k)] = chosen[At(k)] || (corners.col(k).array() == node).any();
    }
  }
  return chosen;
}

/// The chosen elements, with nodes of their own; `number` [nodes of the body] gets these, or -1.
MeshPart Extract(const robot::RobotBody& body, const std::vector<bool>& chosen,
                 std::vector<int>* number) {
  number->assign(static_cast<std::size_t>(body.mesh.NodeCount()), -1);
  MeshPart part{.mesh = {.nodes_m = body.mesh.nodes_m,
                         .cells = Eigen::MatrixXi(4, body.mesh.CellCount()),
                         .groups = {}},
                .material_of_cell = {},
                .fixed = body.fixed};
  int nodes = 0;
  Eigen::Index cells = 0;
  for (int k = 0; k < body.mesh.CellCount(); ++k) {
    if (!chosen[At(k)]) continue;
    part.material_of_cell.push_back(body.material_of_cell[At(k)]);
    for (int c = 0; c < 4; ++c) {
      const int node = body.mesh.cells(c, k);
      int& own = (*number)[At(node)];
      if (own < 0) {
        part.mesh.nodes_m.col(nodes) = body.mesh.nodes_m.col(node);
        part.fixed.col(nodes) = body.fixed.col(node);
        own = nodes++;
      }
      part.mesh.cells(c, cells) = own;
    }
    ++cells;
  }
  part.mesh.nodes_m.conservativeResize(3, nodes);
  part.mesh.cells.conservativeResize(4, cells);
  part.fixed.conservativeResize(3, nodes);
  return part;
}

/// Of `finer`, whose nodes are those of `mesh` and middles of its edges.
fem::FixedDirections Inherit(const fem::TetMesh& mesh, const fem::FixedDirections& fixed,
                             const fem::TetMesh& finer) {
  const auto key = [](const Eigen::Vector3d& at_m) {
    return std::array{at_m.x(), at_m.y(), at_m.z()};
  };
  std::map<std::array<double, 3>, std::pair<int, int>> edges;
  for (int k = 0; k < mesh.CellCount(); ++k) {
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        const int first = mesh.cells(a, k);
        const int second = mesh.cells(b, k);
        edges[key(0.5 * (mesh.nodes_m.col(first) + mesh.nodes_m.col(second)))] = {first, second};
      }
    }
  }
  fem::FixedDirections held = fem::FixedDirections::Constant(3, finer.NodeCount(), false);
  held.leftCols(fixed.cols()) = fixed;
  for (int node = mesh.NodeCount(); node < finer.NodeCount(); ++node) {
    const auto& [first, second] = edges.at(key(finer.nodes_m.col(node)));
    held.col(node) = fixed.col(first).array() && fixed.col(second).array();
  }
  return held;
}

fem::TetMesh InElement(const fem::TetMesh& corners, fem::ElementType element) {
  return element == fem::ElementType::kTet10 ? fem::MakeQuadratic(corners) : corners;
}

}  // namespace

MeshPart WholeMesh(const robot::RobotBody& body) {
  std::vector<int> number;
  return Extract(body, std::vector<bool>(static_cast<std::size_t>(body.mesh.CellCount()), true),
                 &number);
}

MeshPart PartAbout(const robot::RobotBody& body, int cell) {
  const std::vector<bool> chosen = CellsAbout(body.mesh, cell);
  std::vector<int> number;
  MeshPart part = Extract(body, chosen, &number);
  for (int k = 0; k < body.mesh.CellCount(); ++k) {
    if (chosen[At(k)]) continue;
    for (const int node : body.mesh.cells.topRows<4>().col(k)) {
      if (number[At(node)] >= 0) part.fixed.col(number[At(node)]).setConstant(true);
    }
  }
  return part;
}

MeshPart Refined(const MeshPart& part) {
  MeshPart finer{.mesh = fem::RefineUniformly(part.mesh), .material_of_cell = {}, .fixed = {}};
  for (const int material : part.material_of_cell) {
    finer.material_of_cell.insert(finer.material_of_cell.end(), 8, material);
  }
  finer.fixed = Inherit(part.mesh, part.fixed, finer.mesh);
  return finer;
}

void AddPointLoad(const fem::InterpolationWeights& point, const Eigen::Vector3d& force_N,
                  Eigen::Ref<Eigen::VectorXd> nodal_N) {
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    nodal_N.segment<3>(3 * point.nodes[k]) += point.weights[k] * force_N;
  }
}

PartAtRest::PartAtRest(const MeshPart& part, fem::ElementType element, const robot::RobotBody& body)
    : mesh_(InElement(part.mesh, element)),
      fixed_(Inherit(part.mesh, part.fixed, mesh_)),
      elastic_(mesh_, body.materials, part.material_of_cell),
      at_rest_(elastic_, {}, fixed_) {}

std::optional<Eigen::MatrixXd> PartAtRest::MotionUnder(const Eigen::MatrixXd& loads_N) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(loads_N.rows());
  if (!at_rest_.Update(elastic_.rest_m(), {}, none).ok()) return std::nullopt;
  Eigen::MatrixXd columns(at_rest_.Size(), loads_N.cols());
  for (Eigen::Index k = 0; k < loads_N.cols(); ++k) {
    at_rest_.matrix().Reduce(loads_N.col(k), columns.col(k));
  }
  at_rest_.Solve(columns);
  Eigen::MatrixXd motion_m = Eigen::MatrixXd::Zero(loads_N.rows(), loads_N.cols());
  for (Eigen::Index k = 0; k < loads_N.cols(); ++k) {
    at_rest_.matrix().AddExpanded(columns.col(k), 1.0, motion_m.col(k));
  }
  return motion_m;
}

}  // namespace palpate::diagnosis

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/mesh_report.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <tuple>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

constexpr double kDegenerateQuality = 1e-6;
constexpr std::array<std::array<int, 3>, 4> kFaces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<std::array<int, 2>, 6> kEdges = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

Eigen::Vector3d Node(const TetMesh& mesh, int k, int cell) {
  return mesh.nodes_m.col(mesh.cells(k, cell));
}

double CornerVolume_m3(const TetMesh& mesh, int cell) {
  const Eigen::Vector3d origin = Node(mesh, 0, cell);
  return (Node(mesh, 1, cell) - origin)
             .cross(Node(mesh, 2, cell) - origin)
             .dot(Node(mesh, 3, cell) - origin) /
         6.0;
}

/// det dx/d(L1, L2, L3) of a tet10 at barycentric coordinates L, from
/// x = sum_i L_i (2 L_i - 1) x_i + sum_ij 4 L_i L_j x_ij; six times the volume of a straight one.
double JacobianDeterminant_m3(const TetMesh& mesh, int cell, const Eigen::Vector4d& L) {
  Eigen::Matrix<double, 3, 4> dx_dL;
  for (int i = 0; i < 4; ++i) dx_dL.col(i) = (4.0 * L(i) - 1.0) * Node(mesh, i, cell);
  for (int edge = 0; edge < 6; ++edge) {
    const auto [i, j] = kEdges[At(edge)];
    const Eigen::Vector3d middle = Node(mesh, 4 + edge, cell);
    dx_dL.col(i) += 4.0 * L(j) * middle;
    dx_dL.col(j) += 4.0 * L(i) * middle;
  }
  const Eigen::Matrix3d jacobian = dx_dL.rightCols<3>().colwise() - dx_dL.col(0);
  return jacobian.determinant();
}

/// One coordinate `own`, the three others equal.
Eigen::Vector4d Barycentric(int corner, double own) {
  Eigen::Vector4d L = Eigen::Vector4d::Constant((1.0 - own) / 3.0);
  L(corner) = own;
  return L;
}

/// By the five-point rule of degree 3 (Keast 1986), which det J of a tet10 is a polynomial of.
double QuadraticVolume_m3(const TetMesh& mesh, int cell) {
  double sum = -0.8 * JacobianDeterminant_m3(mesh, cell, Eigen::Vector4d::Constant(0.25));
  for (int k = 0; k < 4; ++k) {
    sum += 0.45 * JacobianDeterminant_m3(mesh, cell, Barycentric(k, 0.5));
  }
  return sum / 6.0;
}

/// At the four-point rule that the elements use (Hammer & Stroud 1956).
bool FoldsAtIntegrationPoint(const TetMesh& mesh, int cell) {
  constexpr double kOwn = 0.58541019662496845446;  // (5 + 3 sqrt 5) / 20
  for (int k = 0; k < 4; ++k) {
    if (JacobianDeterminant_m3(mesh, cell, Barycentric(k, kOwn)) <= 0.0) return true;
  }
  return false;
}

double Quality(const TetMesh& mesh, int cell, double volume_m3) {
  double squared_lengths_m2 = 0.0;
  for (const auto& [i, j] : kEdges) {
    squared_lengths_m2 += (Node(mesh, i, cell) - Node(mesh, j, cell)).squaredNorm();
  }
  return 12.0 * std::pow(3.0 * std::abs(volume_m3), 2.0 / 3.0) / squared_lengths_m2;
}

void JudgeCells(const TetMesh& mesh, const std::vector<int>& cells, MeshReport* report) {
  const bool quadratic = mesh.element_type() == ElementType::kTet10;
  for (const int cell : cells) {
    const double corner_volume_m3 = CornerVolume_m3(mesh, cell);
    report->volume_m3 += quadratic ? QuadraticVolume_m3(mesh, cell) : corner_volume_m3;
    double quality = Quality(mesh, cell, corner_volume_m3);
    if (!std::isfinite(quality)) quality = 0.0;  // no length, or no finite one
    if (report->worst_cell < 0 || quality < report->worst_quality) {
      report->worst_quality = quality;
      report->worst_cell = cell;
    }
    if (quality <= kDegenerateQuality) {
      report->degenerate_cells.push_back(cell);
    } else if (corner_volume_m3 < 0.0 || (quadratic && FoldsAtIntegrationPoint(mesh, cell))) {
      report->inverted_cells.push_back(cell);
    }
  }
}

/// Sets of things that are joined pair by pair.
class DisjointSets {
 public:
  explicit DisjointSets(int count) : parent_(static_cast<size_t>(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int Root(int k) {
    while (At(k) != k) k = At(k) = At(At(k));
    return k;
  }
  void Join(int a, int b) { At(Root(a)) = Root(b); }

  int CountRoots(const std::vector<int>& members) {
    return static_cast<int>(
        std::count_if(members.begin(), members.end(), [this](int k) { return At(k) == k; }));
  }

 private:
  int& At(int k) { return parent_[palpate::At(k)]; }
  std::vector<int> parent_;
};

template <size_t kCorners>
std::array<int, kCorners> Sorted(std::array<int, kCorners> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// `first_at_place` [nodes]: a body that a file holds twice has nodes of its own each time.
std::vector<int> FindDuplicateCells(const TetMesh& mesh, const std::vector<int>& cells,
                                    const std::vector<int>& first_at_place) {
  std::vector<std::pair<std::array<int, 4>, int>> keyed;
  for (const int cell : cells) {
    const auto corner = [&](int k) { return first_at_place[At(mesh.cells(k, cell))]; };
    keyed.emplace_back(Sorted<4>({corner(0), corner(1), corner(2), corner(3)}), cell);
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<int> duplicates;
  for (size_t k = 1; k < keyed.size(); ++k) {
    if (keyed[k].first == keyed[k - 1].first) duplicates.push_back(keyed[k].second);
  }
  std::sort(duplicates.begin(), duplicates.end());
  return duplicates;
}

int CountFreeEdges(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& [a, b, c] : triangles) {
    edges.insert(edges.end(), {Sorted<2>({a, b}), Sorted<2>({b, c}), Sorted<2>({a, c})});
  }
  std::sort(edges.begin(), edges.end());
  int free_edges = 0;
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::upper_bound(first, edges.end(), *first);
    free_edges += last - first == 2 ? 0 : 1;
    first = last;
  }
  return free_edges;
}

void JudgeSurface(const TetMesh& mesh, const std::vector<int>& cells, MeshReport* report) {
  std::vector<std::pair<std::array<int, 3>, int>> faces;
  for (const int cell : cells) {
    for (const auto& [a, b, c] : kFaces) {
      faces.emplace_back(Sorted<3>({mesh.cells(a, cell), mesh.cells(b, cell), mesh.cells(c, cell)}),
                         cell);
    }
  }
  std::sort(faces.begin(), faces.end());
  DisjointSets parts(mesh.CellCount());
  std::vector<std::array<int, 3>> boundary;
  for (size_t first = 0, last = 0; first < faces.size(); first = last) {
    for (last = first + 1; last < faces.size() && faces[last].first == faces[first].first; ++last) {
      parts.Join(faces[first].second, faces[last].second);
    }
    if (last - first == 1) boundary.push_back(faces[first].first);
    if (last - first > 2) ++report->overshared_faces;
  }
  report->parts = parts.CountRoots(cells);
  report->boundary_triangles = static_cast<int>(boundary.size());
  report->free_edges = CountFreeEdges(boundary);
}

void JudgeUseOfNodes(const TetMesh& mesh, const std::vector<int>& cells, MeshReport* report) {
  DisjointSets pieces(mesh.NodeCount());
  std::vector<bool> used(static_cast<size_t>(mesh.NodeCount()), false);
  for (const int cell : cells) {
    for (const int node : mesh.cells.col(cell)) {
      used[At(node)] = true;
      pieces.Join(node, mesh.cells(0, cell));
    }
  }
  std::vector<int> used_nodes;
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    (used[At(node)] ? used_nodes : report->unused_nodes).push_back(node);
  }
  report->pieces = pieces.CountRoots(used_nodes);
  if (used_nodes.empty()) return;
  report->min_m = report->max_m = mesh.nodes_m.col(used_nodes.front());
  for (const int node : used_nodes) {
    report->min_m = report->min_m.cwiseMin(mesh.nodes_m.col(node));
    report->max_m = report->max_m.cwiseMax(mesh.nodes_m.col(node));
  }
}

/// [nodes] the first node exactly where each is: itself where no earlier one is there.
std::vector<int> JudgePlacesOfNodes(const TetMesh& mesh, MeshReport* report) {
  std::vector<int> first_at_place(static_cast<size_t>(mesh.NodeCount()));
  std::iota(first_at_place.begin(), first_at_place.end(), 0);
  std::vector<int> finite;
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    (mesh.nodes_m.col(node).allFinite() ? finite : report->nonfinite_nodes).push_back(node);
  }
  const auto place = [&](int node) {
    return std::tuple(mesh.nodes_m(0, node), mesh.nodes_m(1, node), mesh.nodes_m(2, node));
  };
  std::sort(finite.begin(), finite.end(),
            [&](int a, int b) { return std::tuple(place(a), a) < std::tuple(place(b), b); });
  for (size_t k = 1; k < finite.size(); ++k) {
    if (place(finite[k]) != place(finite[k - 1])) continue;
    report->duplicate_nodes.push_back(finite[k]);
    first_at_place[At(finite[k])] = first_at_place[At(finite[k - 1])];
  }
  std::sort(report->duplicate_nodes.begin(), report->duplicate_nodes.end());
  return first_at_place;
}

/// Cells whose nodes all exist; the others go to the report.
std::vector<int> CellsOfExistingNodes(const TetMesh& mesh, MeshReport* report) {
  std::vector<int> cells;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const auto nodes = mesh.cells.col(cell);
    const bool exist = nodes.minCoeff() >= 0 && nodes.maxCoeff() < mesh.NodeCount();
    (exist ? cells : report->bad_index_cells).push_back(cell);
  }
  return cells;
}

/// "3, 17, 20 and 5 more".
std::string FirstOf(const std::vector<int>& indices) {
  constexpr size_t kShown = 5;
  std::string text;
  for (size_t k = 0; k < std::min(kShown, indices.size()); ++k) {
    text += (k == 0 ? "" : ", ") + std::to_string(indices[k]);
  }
  const size_t more = indices.size() - std::min(kShown, indices.size());
  return more == 0 ? text : text + " and " + std::to_string(more) + " more";
}

}  // namespace

MeshReport ReportMesh(const TetMesh& mesh) {
  MeshReport report;
  report.node_count = mesh.NodeCount();
  report.cell_count = mesh.CellCount();
  report.nodes_per_cell = static_cast<int>(mesh.cells.rows());
  if (mesh.CellCount() > 0) {
    PALPATE_CHECK(mesh.cells.rows() == 4 || mesh.cells.rows() == 10, mesh.cells.rows());
  }
  std::vector<int> cells = CellsOfExistingNodes(mesh, &report);
  const std::vector<int> first_at_place = JudgePlacesOfNodes(mesh, &report);
  JudgeUseOfNodes(mesh, cells, &report);
  JudgeCells(mesh, cells, &report);
  report.duplicate_cells = FindDuplicateCells(mesh, cells, first_at_place);
  std::vector<int> distinct_cells;
  std::set_difference(cells.begin(), cells.end(), report.duplicate_cells.begin(),
                      report.duplicate_cells.end(), std::back_inserter(distinct_cells));
  JudgeSurface(mesh, distinct_cells, &report);
  return report;
}

std::string ToText(const MeshReport& report) {
  std::ostringstream text;
  const auto count = [&](const char* name, const std::vector<int>& indices) {
    text << "  " << name << indices.size();
    if (!indices.empty()) text << " (" << FirstOf(indices) << ")";
    text << "\n";
  };
  const Eigen::Vector3d size_m = report.max_m - report.min_m;
  text << "mesh of " << report.node_count << " nodes and " << report.cell_count << " tetrahedra of "
       << report.nodes_per_cell << " nodes\n"
       << "  volume              " << report.volume_m3 << " m3\n"
       << "  worst quality       " << report.worst_quality << " (mean ratio, cell "
       << report.worst_cell << ")\n"
       << "  from                (" << report.min_m.transpose() << ") m\n"
       << "  to                  (" << report.max_m.transpose() << ") m\n"
       << "  size                (" << size_m.transpose() << ") m\n"
       << "  boundary triangles  " << report.boundary_triangles << "\n"
       << "  free edges          " << report.free_edges << "\n"
       << "  overshared faces    " << report.overshared_faces << "\n"
       << "  pieces              " << report.pieces << "\n";
  if (report.parts > report.pieces) {
    text << "  parts               " << report.parts
         << " (some hang together by an edge or node)\n";
  }
  count("inverted cells      ", report.inverted_cells);
  count("degenerate cells    ", report.degenerate_cells);
  count("duplicate cells     ", report.duplicate_cells);
  count("cells without nodes ", report.bad_index_cells);
  count("duplicate nodes     ", report.duplicate_nodes);
  count("unused nodes        ", report.unused_nodes);
  count("nodes not finite    ", report.nonfinite_nodes);
  return text.str();
}

void CheckSolvable(const TetMesh& mesh, const MeshReport& report, const std::string& file,
                   Pieces pieces) {
  PALPATE_CHECK(report.cell_count == mesh.CellCount() && report.node_count == mesh.NodeCount());
  const auto refuse = [&file](const std::string& message) {
    throw InputError(file + ": " + message);
  };
  const auto refuse_any = [&](const std::vector<int>& indices, const char* what) {
    if (indices.empty()) return;
    refuse(std::to_string(indices.size()) + " " + what + ": " + FirstOf(indices));
  };
  if (report.cell_count == 0) refuse("the mesh has no cells");
  refuse_any(report.bad_index_cells, "cells name a node that does not exist");
  refuse_any(report.nonfinite_nodes, "nodes have a coordinate that is not finite");
  refuse_any(report.degenerate_cells, "degenerate cells (flat, or a node twice)");
  refuse_any(report.inverted_cells, "inverted cells");
  refuse_any(report.duplicate_cells, "duplicate cells (same corners as an earlier one)");
  if (report.overshared_faces > 0) {
    refuse(std::to_string(report.overshared_faces) +
           " faces are shared by more than two cells: cells overlap");
  }
  if (report.pieces > 1 && pieces == Pieces::kOneOnly) {
    refuse("the mesh is in " + std::to_string(report.pieces) + " pieces without a common node (" +
           std::to_string(report.duplicate_nodes.size()) +
           " nodes coincide with another): join them, or hold each");
  }
}

}  // namespace palpate::fem

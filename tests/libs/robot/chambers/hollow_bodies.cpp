// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/robot/chambers/hollow_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/boundary_surface.hpp"
#include "libs/robot/chamber_wall.hpp"

namespace palpate::robot {

namespace {

/// Triangles of points that a radius turns into places: a sphere's directions, or angles and
/// heights of a cylinder.
struct Skin {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
};

/// An octahedron with edges cut into `divisions`, its points unit vectors, outward.
Skin Octahedron(int divisions) {
  Skin skin;
  std::map<std::array<int, 3>, int> index;  // by whole coordinates, |x| + |y| + |z| = divisions
  const auto point = [&](const Eigen::Vector3i& at) {
    const auto [entry, is_new] =
        index.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(skin.points.size()));
    if (is_new) skin.points.push_back(at.cast<double>().normalized());
    return entry->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3i sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    const auto add = [&](const Eigen::Vector3i& a, const Eigen::Vector3i& b,
                         const Eigen::Vector3i& c) {
      Eigen::Vector3i triangle(point(a.cwiseProduct(sign)), point(b.cwiseProduct(sign)),
                               point(c.cwiseProduct(sign)));
      if (sign.prod() < 0) std::swap(triangle[1], triangle[2]);
      skin.triangles.push_back(triangle);
    };
    for (int i = 0; i < divisions; ++i) {
      for (int j = 0; i + j < divisions; ++j) {
        const int k = divisions - i - j;
        const Eigen::Vector3i at(k, i, j);
        const Eigen::Vector3i right(k - 1, i + 1, j), up(k - 1, i, j + 1);
        add(at, right, up);
        if (k >= 2) add(right, Eigen::Vector3i(k - 2, i + 1, j + 1), up);
      }
    }
  }
  return skin;
}

/// A cylinder of radius 1 and height `length_m`, one strip of `around` squares, outward.
Skin Cylinder(int around, double length_m) {
  Skin skin;
  for (int k = 0; k < around; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / around;
    skin.points.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    skin.points.emplace_back(std::cos(angle), std::sin(angle), length_m);
  }
  for (int k = 0; k < around; ++k) {
    const int here = 2 * k, next = 2 * ((k + 1) % around);
    skin.triangles.emplace_back(here, next, next + 1);
    skin.triangles.emplace_back(here, next + 1, here + 1);
  }
  return skin;
}

/// Scales the first `axes` coordinates to this length.
Eigen::Vector3d AtRadius(Eigen::Vector3d point, int axes, double radius_m) {
  const double length = point.head(axes).norm();
  if (length > 0.0) point.head(axes) *= radius_m / length;
  return point;
}

/// Prisms over the triangles, layer by layer, each cut into three tetrahedra so that neighbours
/// agree: diagonals begin at the lower number. Mid-edge nodes lie on the curved surfaces.
fem::TetMesh Extrude(const Skin& skin, int axes, double inner_m, double outer_m, int layers,
                     bool fill, fem::ElementType element) {
  const int per_layer = static_cast<int>(skin.points.size());
  fem::TetMesh mesh;
  mesh.nodes_m.resize(3, per_layer * (layers + 1) + (fill ? 1 : 0));
  mesh.nodes_m.setZero();
  for (int layer = 0; layer <= layers; ++layer) {
    const double radius_m = inner_m + (outer_m - inner_m) * layer / layers;
    for (int p = 0; p < per_layer; ++p) {
      mesh.nodes_m.col(layer * per_layer + p) = AtRadius(skin.points[At(p)], axes, radius_m);
    }
  }
  std::vector<Eigen::Vector4i> cells;
  for (int layer = 0; layer < layers; ++layer) {
    for (const Eigen::Vector3i& triangle : skin.triangles) {
      Eigen::Vector3i low = triangle;  // rising; the order of the corners decides the diagonals
      std::sort(low.begin(), low.end());
      low.array() += layer * per_layer;
      const Eigen::Vector3i high = low.array() + per_layer;
      cells.emplace_back(low[0], low[1], low[2], high[2]);
      cells.emplace_back(low[0], low[1], high[1], high[2]);
      cells.emplace_back(low[0], high[0], high[1], high[2]);
    }
  }
  if (fill) {
    const int middle = static_cast<int>(mesh.nodes_m.cols()) - 1;
    for (const Eigen::Vector3i& triangle : skin.triangles) {
      cells.emplace_back(middle, triangle[0], triangle[1], triangle[2]);
    }
  }
  mesh.cells.resize(4, std::ssize(cells));
  for (std::size_t c = 0; c < cells.size(); ++c) {
    Eigen::Matrix3d edges_m;
    for (int k = 1; k < 4; ++k) {
      edges_m.col(k - 1) = mesh.nodes_m.col(cells[c][k]) - mesh.nodes_m.col(cells[c][0]);
    }
    if (edges_m.determinant() < 0.0) std::swap(cells[c][2], cells[c][3]);
    mesh.cells.col(ToIndex(c)) = cells[c];
  }
  if (element == fem::ElementType::kTet4) return mesh;
  const int corners = mesh.NodeCount();
  mesh = fem::MakeQuadratic(mesh);
  constexpr std::array<std::array<int, 2>, 6> kEdges{
      {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    for (int e = 0; e < 6; ++e) {
      const int node = mesh.cells(4 + e, cell);
      PALPATE_CHECK(node >= corners, node);
      double radius_m = 0.0;
      for (const int end : kEdges[At(e)]) {
        radius_m += 0.5 * mesh.nodes_m.col(mesh.cells(end, cell)).head(axes).norm();
      }
      mesh.nodes_m.col(node) = AtRadius(mesh.nodes_m.col(node), axes, radius_m);
    }
  }
  return mesh;
}

int ShellCells(int layers, int divisions) { return 3 * 8 * divisions * divisions * layers; }

}  // namespace

fem::TetMesh SphericalShell(int layers, int divisions, fem::ElementType element) {
  return Extrude(Octahedron(divisions), 3, kInner_m, kOuter_m, layers, false, element);
}

FilledShell FillShell(int layers, int divisions, fem::ElementType element) {
  const fem::TetMesh whole =
      Extrude(Octahedron(divisions), 3, kInner_m, kOuter_m, layers, true, element);
  const int shell = ShellCells(layers, divisions);
  FilledShell filled{whole, whole};
  filled.shell.cells = whole.cells.leftCols(shell).eval();
  filled.inside.cells = whole.cells.rightCols(whole.CellCount() - shell).eval();
  return filled;
}

fem::TetMesh Tube(double length_m, int layers, int around, fem::ElementType element) {
  return Extrude(Cylinder(around, length_m), 2, kInner_m, kOuter_m, layers, false, element);
}

fem::TetMesh KeepCells(const fem::TetMesh& mesh,
                       const std::function<bool(const Eigen::Vector3d&)>& keep) {
  std::vector<int> kept;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    Eigen::Vector3d centroid_m = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) centroid_m += 0.25 * mesh.nodes_m.col(mesh.cells(k, cell));
    if (keep(centroid_m)) kept.push_back(cell);
  }
  fem::TetMesh part;
  part.cells = mesh.cells(Eigen::all, kept).eval();
  std::vector<int> new_index(At(mesh.NodeCount()), -1);
  std::vector<int> nodes;
  for (int& node : part.cells.reshaped()) {
    if (new_index[At(node)] < 0) {
      new_index[At(node)] = static_cast<int>(nodes.size());
      nodes.push_back(node);
    }
    node = new_index[At(node)];
  }
  part.nodes_m = mesh.nodes_m(Eigen::all, nodes);
  return part;
}

fem::MovingSurface CavityWall(const fem::TetMesh& mesh) {
  const fem::BoundarySurface boundary = fem::ExtractBoundary(mesh);
  return WallOfFaces(boundary, fem::InnerSkins(mesh, boundary).at(0));
}

namespace {

/// An edge of a rim as the lid passes it, and the point on its middle (-1: faces are flat).
struct RimEdge {
  int a, b, middle;
};

/// Closes a rim by triangles around the mean of its points.
void AddLid(const std::vector<RimEdge>& rim, Eigen::Index per_face, fem::MovingSurface* wall,
            std::vector<Eigen::VectorXi>* faces) {
  fem::InterpolationWeights centre;
  for (const RimEdge& edge : rim) {
    centre.nodes.push_back(edge.a);
    centre.weights.push_back(1.0 / static_cast<double>(rim.size()));
  }
  const int middle = static_cast<int>(wall->points.size());
  wall->points.push_back(centre);
  std::map<int, int> spoke_of;  // point half way to the centre
  const auto spoke = [&](int node) {
    const auto [entry, is_new] = spoke_of.try_emplace(node, static_cast<int>(wall->points.size()));
    if (is_new) {
      fem::InterpolationWeights half = centre;
      for (double& weight : half.weights) weight *= 0.5;
      half.nodes.push_back(node);
      half.weights.push_back(0.5);
      wall->points.push_back(half);
    }
    return entry->second;
  };
  for (const RimEdge& edge : rim) {
    Eigen::VectorXi face(per_face);
    face.head<3>() << edge.a, edge.b, middle;
    if (per_face == 6) face.tail<3>() << edge.middle, spoke(edge.b), spoke(edge.a);
    faces->push_back(face);
  }
}

}  // namespace

fem::MovingSurface TubeWall(const fem::TetMesh& tube, double length_m) {
  constexpr double kSame_m = 1e-6;
  constexpr std::array<int, 6> kTurned{0, 2, 1, 5, 4, 3};
  const fem::BoundarySurface boundary = fem::ExtractBoundary(tube);
  const Eigen::Index per_face = boundary.faces.rows();
  fem::MovingSurface wall;
  for (int node = 0; node < tube.NodeCount(); ++node) wall.points.push_back({{node}, {1.0}});
  std::vector<Eigen::VectorXi> faces;
  std::array<std::vector<RimEdge>, 2> rims;
  for (int f = 0; f < boundary.FaceCount(); ++f) {
    Eigen::VectorXi face(per_face);
    bool is_inner = true;
    for (Eigen::Index k = 0; k < per_face; ++k) {
      face[k] = boundary.faces(kTurned[At(k)], f);
      is_inner = is_inner && tube.nodes_m.col(face[k]).head<2>().norm() < kInner_m + kSame_m;
    }
    if (!is_inner) continue;
    faces.push_back(face);
    for (int k = 0; k < 3; ++k) {
      const int a = face[k], b = face[(k + 1) % 3];
      for (int end = 0; end < 2; ++end) {
        const double z_m = end * length_m;
        const bool on_rim = std::abs(tube.nodes_m(2, a) - z_m) < kSame_m &&
                            std::abs(tube.nodes_m(2, b) - z_m) < kSame_m;
        if (on_rim) rims[At(end)].push_back({b, a, per_face == 6 ? face[3 + k] : -1});
      }
    }
  }
  for (const std::vector<RimEdge>& rim : rims) AddLid(rim, per_face, &wall, &faces);
  wall.faces.resize(per_face, std::ssize(faces));
  for (std::size_t f = 0; f < faces.size(); ++f) wall.faces.col(ToIndex(f)) = faces[f];
  return wall;
}

Eigen::VectorXd Shaken(const fem::TetMesh& mesh, double amount_m) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-amount_m, amount_m);
  Eigen::VectorXd x_m = mesh.nodes_m.reshaped();
  for (double& coordinate_m : x_m) coordinate_m += uniform(random);
  return x_m;
}

}  // namespace palpate::robot

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/components/palpate/new_robot/drawn_mesh.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "libs/core/index.hpp"
#include "libs/fem/boundary_surface.hpp"
#include "tests/libs/fem/points/meshes.hpp"

namespace palpate::command::test {

namespace {

int NearestNode(const fem::TetMesh& mesh, const Eigen::Vector3d& point) {
  Eigen::Index node = 0;
  (mesh.nodes_m.colwise() - point).colwise().squaredNorm().minCoeff(&node);
  return static_cast<int>(node);
}

/// "TYPE 2 PHYSICAL 1 NODES" for each element of a group.
std::vector<std::string> ElementsOf(const fem::TetMesh& mesh, const DrawnGroup& group, int tag) {
  std::vector<std::string> elements;
  const std::string tags = " 2 " + std::to_string(tag) + " 1";
  if (group.dimension == 0) {
    for (int node = 0; node < mesh.NodeCount(); ++node) {
      if (group.holds(mesh.nodes_m.col(node))) {
        elements.push_back("15" + tags + " " + std::to_string(node + 1));
      }
    }
  }
  for (size_t k = 1; group.dimension == 1 && k < group.chain.size(); ++k) {
    elements.push_back("1" + tags + " " +
                       std::to_string(NearestNode(mesh, group.chain[k - 1]) + 1) + " " +
                       std::to_string(NearestNode(mesh, group.chain[k]) + 1));
  }
  if (group.dimension == 2) {
    const fem::BoundarySurface boundary = fem::ExtractBoundary(mesh);
    for (const auto& face : boundary.faces.topRows<3>().colwise()) {
      bool all = true;
      std::string nodes;
      for (const int node : face) {
        all = all && group.holds(mesh.nodes_m.col(node));
        nodes += " " + std::to_string(node + 1);
      }
      if (all) elements.push_back("2" + tags + nodes);
    }
  }
  return elements;
}

}  // namespace

fem::TetMesh Bar(const Eigen::Vector3d& size, const Eigen::Vector3i& counts,
                 const Eigen::Vector3d& corner) {
  return Moved(fem::BoxMesh(size, counts),
               [&](const Eigen::Vector3d& at) -> Eigen::Vector3d { return at + corner; });
}

fem::TetMesh Tube(double inner, double outer, double length) {
  constexpr int kAround = 12, kAcross = 2, kAlong = 12;
  const fem::TetMesh flat = fem::BoxMesh({1, 1, 1}, {kAround, kAcross, kAlong});
  // The last column of nodes is the first one.
  const auto index_of = [](const Eigen::Vector3d& at) {
    const auto around = std::lround(at.x() * kAround) % kAround;
    const auto across = std::lround(at.y() * kAcross), along = std::lround(at.z() * kAlong);
    return static_cast<int>((along * (kAcross + 1) + across) * kAround + around);
  };
  fem::TetMesh mesh;
  mesh.nodes_m.resize(3, kAround * (kAcross + 1) * (kAlong + 1));
  for (const auto& at : flat.nodes_m.colwise()) {
    const double angle = -2.0 * std::numbers::pi * at.x();
    const double radius = inner + (outer - inner) * at.y();
    mesh.nodes_m.col(index_of(at)) << radius * std::cos(angle), radius * std::sin(angle),
        length * at.z();
  }
  mesh.cells = flat.cells.unaryExpr([&](int node) { return index_of(flat.nodes_m.col(node)); });
  return mesh;
}

fem::TetMesh Moved(fem::TetMesh mesh,
                   const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& to) {
  for (auto node : mesh.nodes_m.colwise()) node = to(node).eval();
  return mesh;
}

std::filesystem::path WriteMsh(const test_support::TestFolder& folder, const std::string& name,
                               const fem::TetMesh& mesh, const std::vector<DrawnGroup>& groups) {
  std::ostringstream text;
  text.precision(17);
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << groups.size() << "\n";
  for (size_t k = 0; k < groups.size(); ++k) {
    text << groups[k].dimension << " " << k + 1 << " \"" << groups[k].name << "\"\n";
  }
  text << "$EndPhysicalNames\n$Nodes\n" << mesh.NodeCount() << "\n";
  for (int node = 0; node < mesh.NodeCount(); ++node) {
    text << node + 1 << " " << mesh.nodes_m.col(node).transpose() << "\n";
  }
  std::vector<std::string> elements;
  for (size_t k = 0; k < groups.size(); ++k) {
    const auto own = ElementsOf(mesh, groups[k], static_cast<int>(k) + 1);
    elements.insert(elements.end(), own.begin(), own.end());
  }
  for (const auto& cell : mesh.cells.colwise()) {
    std::ostringstream nodes;
    for (const int node : cell) nodes << " " << node + 1;
    elements.push_back((mesh.cells.rows() == 4 ? "4" : "11") + (" 2 0 1" + nodes.str()));
  }
  text << "$EndNodes\n$Elements\n" << elements.size() << "\n";
  for (size_t k = 0; k < elements.size(); ++k) text << k + 1 << " " << elements[k] << "\n";
  text << "$EndElements\n";
  return folder.Write(name, text.str());
}

}  // namespace palpate::command::test

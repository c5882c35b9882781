// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/body_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <sstream>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_report.hpp"
#include "libs/fem/seams.hpp"
#include "libs/geometry/box.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::robot {

namespace {

/// FNV-1a, 64 bit (Fowler, Noll, Vo): bytes of each word from the lowest on, whatever the machine.
class Fnv1a {
 public:
  void Add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) {
      state_ ^= (word >> (8 * byte)) & 0xffU;
      state_ *= 0x100000001b3ULL;
    }
  }
  /// -0 counts as 0.
  void Add(double value) { Add(std::bit_cast<std::uint64_t>(value + 0.0)); }

  std::string ToHex() const {
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx",
                  static_cast<unsigned long long>(state_));  // NOLINT(google-runtime-int)
    return digits.data();
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

std::string Printed(const char* format, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

std::string Summary(const fem::MeshReport& report, const std::string& file) {
  return "mesh " + file + ": " + std::to_string(report.node_count) + " nodes, " +
         std::to_string(report.cell_count) + " elements of " +
         std::to_string(report.nodes_per_cell) + " nodes, volume " +
         Printed("%.6g", report.volume_m3 * 1e6) + " cm3, worst quality " +
         Printed("%.3g", report.worst_quality) + " (element " + std::to_string(report.worst_cell) +
         ")";
}

/// Indices of the nodes, the first few.
std::string SomeOf(const std::vector<int>& nodes) {
  constexpr size_t kShown = 5;
  std::string text;
  for (size_t k = 0; k < std::min(kShown, nodes.size()); ++k) {
    text += (k == 0 ? "" : ", ") + std::to_string(nodes[k]);
  }
  return nodes.size() > kShown ? text + ", ..." : text;
}

void AddReportNotes(const fem::MeshReport& report, const std::string& file,
                    std::vector<std::string>* notes) {
  notes->push_back(Summary(report, file));
  if (report.pieces > 1) {
    notes->push_back("mesh " + file + ": " + std::to_string(report.pieces) + " separate pieces");
  }
  if (report.parts > report.pieces) {
    notes->push_back("mesh " + file + ": some parts hang together by an edge or a node only");
  }
  std::vector<int> loose = report.duplicate_nodes;
  std::erase_if(loose, [&](int node) {
    return std::binary_search(report.unused_nodes.begin(), report.unused_nodes.end(), node);
  });
  if (!loose.empty()) {
    notes->push_back("mesh " + file + ": " + std::to_string(loose.size()) +
                     " nodes lie where another one does and are not joined (" + SomeOf(loose) +
                     "): the body has a slit there");
  }
  if (!report.unused_nodes.empty()) {
    notes->push_back("mesh " + file + ": " + std::to_string(report.unused_nodes.size()) +
                     " nodes that no element uses, held fixed");
  }
}

/// Nodes with the same number hang together through elements.
class PieceOfNode {
 public:
  explicit PieceOfNode(const fem::TetMesh& mesh) : parent_(static_cast<size_t>(mesh.NodeCount())) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (int cell = 0; cell < mesh.CellCount(); ++cell) {
      for (Eigen::Index k = 1; k < mesh.cells.rows(); ++k) {
        parent_[At(Root(mesh.cells(k, cell)))] = Root(mesh.cells(0, cell));
      }
    }
  }

  int Root(int node) {
    while (parent_[At(node)] != node) {
      int& parent = parent_[At(node)];
      parent = parent_[At(parent)];
      node = parent;
    }
    return node;
  }

 private:
  std::vector<int> parent_;
};

/// Whether three of the points span a triangle: then no rigid motion keeps them all.
bool SpanTriangle(const Eigen::Matrix3Xd& points_m) {
  if (points_m.cols() < 3) return false;
  const Eigen::Matrix3Xd from_first_m = points_m.colwise() - points_m.col(0);
  Eigen::Index farthest = 0;
  const double length_m = from_first_m.colwise().norm().maxCoeff(&farthest);
  if (length_m == 0.0) return false;
  const Eigen::Vector3d axis = from_first_m.col(farthest) / length_m;
  const double off_axis_m =
      (from_first_m - axis * (axis.transpose() * from_first_m)).colwise().norm().maxCoeff();
  return off_axis_m > 1e-6 * length_m;
}

void RefuseLoosePieces(const RobotDescription& robot, const BodyMesh& body,
                       const std::vector<bool>& held) {
  PieceOfNode pieces(body.mesh);
  std::vector<std::vector<int>> held_of_piece(held.size());
  for (int node = 0; node < body.mesh.NodeCount(); ++node) {
    if (held[At(node)]) {
      held_of_piece[At(pieces.Root(node))].push_back(node);
    }
  }
  for (int node = 0; node < body.mesh.NodeCount(); ++node) {
    if (!body.used[At(node)] || pieces.Root(node) != node) continue;
    const std::vector<int>& nodes = held_of_piece[At(node)];
    if (SpanTriangle(body.mesh.nodes_m(Eigen::all, nodes))) continue;
    throw InputError(robot.fixed_where.front(),
                     "the piece of the mesh that holds node " + std::to_string(node) +
                         " can still move as a whole: " + std::to_string(nodes.size()) +
                         " of its nodes are fixed, and it takes three that span a triangle");
  }
}

std::string SizeText(const Eigen::Vector3d& size_m) {
  const double unit_m = size_m.maxCoeff() < 0.1 ? 1e-3 : 1.0;
  const auto text = [&](Eigen::Index axis) { return Printed("%.3g", size_m[axis] / unit_m); };
  return text(0) + " x " + text(1) + " x " + text(2) + (unit_m == 1.0 ? " m" : " mm");
}

/// A mesh file does not say its unit. No soft robot is longer than 10 m, or shorter than 0.1 mm.
void CheckSize(const RobotDescription& robot, const fem::TetMesh& mesh) {
  constexpr double kShortest_m = 1e-4, kLongest_m = 10.0;
  const geometry::Box box = geometry::BoundingBox(mesh.nodes_m(Eigen::all, mesh.cells.reshaped()));
  const Eigen::Vector3d size_m = box.upper_m - box.lower_m;
  const double length_m = size_m.maxCoeff();
  if (length_m >= kShortest_m && length_m <= kLongest_m) return;
  const std::string unit = robot.mesh.metres_per_unit == 1.0    ? "m"
                           : robot.mesh.metres_per_unit == 1e-2 ? "cm"
                                                                : "mm";
  throw InputError(robot.mesh.where, "the body would be " + SizeText(size_m) +
                                         " large with unit: " + unit + "; is the mesh in " +
                                         (length_m > kLongest_m ? "mm" : "m") + "?");
}

void NoteJoined(const std::vector<int>& joined, const RobotDescription& robot,
                std::vector<std::string>* notes) {
  if (joined.empty()) return;
  notes->push_back("mesh " + robot.mesh.file.filename().string() + ": " +
                   std::to_string(joined.size()) + " doubled nodes joined at a seam (" +
                   SomeOf(joined) + ")");
}

bool NamesNodeGroup(const RobotDescription& robot) {
  return std::any_of(
      robot.chambers.begin(), robot.chambers.end(),
      [](const ChamberSettings& chamber) { return !chamber.surface.physical_group.empty(); });
}

fem::TetMesh ReadChecked(const RobotDescription& robot, std::vector<std::string>* notes,
                         std::vector<fem::NodeGroup>* node_groups) {
  const std::string file = robot.mesh.file.string();
  if (!std::filesystem::exists(robot.mesh.file)) {
    throw InputError(robot.mesh.where, "there is no mesh file " + file);
  }
  fem::TetMesh mesh = fem::ReadMesh(robot.mesh.file, robot.mesh.metres_per_unit, notes,
                                    NamesNodeGroup(robot) ? node_groups : nullptr);
  CheckSize(robot, mesh);
  NoteJoined(fem::JoinSeams(&mesh), robot, notes);
  const fem::MeshReport report = fem::ReportMesh(mesh);
  fem::CheckSolvable(mesh, report, file, fem::Pieces::kSeveralAllowed);
  if (robot.element == fem::ElementType::kTet4 && mesh.element_type() != robot.element) {
    throw InputError(robot.mesh.where, "element tet4 needs a mesh of 4-node elements, " + file +
                                           " has elements of 10 nodes");
  }
  AddReportNotes(report, robot.mesh.file.filename().string(), notes);
  return mesh;
}

}  // namespace

std::string HashMesh(const fem::TetMesh& mesh, fem::ElementType element) {
  Fnv1a hash;
  hash.Add(static_cast<std::uint64_t>(element));
  hash.Add(static_cast<std::uint64_t>(mesh.NodeCount()));
  for (const double coordinate : mesh.nodes_m.reshaped()) hash.Add(coordinate);
  hash.Add(static_cast<std::uint64_t>(mesh.CellCount()));
  for (const int node : mesh.cells.reshaped()) hash.Add(static_cast<std::uint64_t>(node));
  return "fnv1a-" + hash.ToHex();
}

BodyMesh ReadBodyMesh(const RobotDescription& robot, std::vector<std::string>* notes) {
  BodyMesh body;
  body.mesh = ReadChecked(robot, notes, &body.node_groups);
  body.hash = HashMesh(body.mesh, robot.element);
  const Eigen::Matrix3d R = geometry::RotationFromFixedXyz_deg(robot.mesh.rotate_xyz_deg);
  body.mesh.nodes_m = ((R * body.mesh.nodes_m).colwise() + robot.mesh.translate_m).eval();
  if (robot.element == fem::ElementType::kTet10) body.mesh = fem::MakeQuadratic(body.mesh);
  body.used.assign(static_cast<size_t>(body.mesh.NodeCount()), false);
  for (const int node : body.mesh.cells.reshaped()) body.used[At(node)] = true;
  return body;
}

Eigen::Matrix<bool, 3, Eigen::Dynamic> HoldNodes(const RobotDescription& robot,
                                                 const BodyMesh& body,
                                                 std::vector<std::string>* notes) {
  const int count = body.mesh.NodeCount();
  std::vector<bool> held(static_cast<size_t>(count), false);
  for (size_t b = 0; b < robot.fixed.size(); ++b) {
    int inside = 0;
    for (int node = 0; node < count; ++node) {
      const auto n = static_cast<size_t>(node);
      if (!body.used[n] || !robot.fixed[b].Contains(body.mesh.nodes_m.col(node))) continue;
      held[n] = true;
      ++inside;
    }
    if (inside == 0) {
      const geometry::Box box = geometry::BoundingBox(body.mesh.nodes_m);
      const Eigen::IOFormat one_line(6, Eigen::DontAlignCols, ", ", ", ", "", "", "[", "]");
      std::ostringstream message;
      message << "no node of the mesh lies in this box; the mesh spans "
              << box.lower_m.transpose().format(one_line) << " to "
              << box.upper_m.transpose().format(one_line) << " m in the robot frame";
      throw InputError(robot.fixed_where[b], message.str());
    }
  }
  RefuseLoosePieces(robot, body, held);
  const auto held_count = std::count(held.begin(), held.end(), true);
  notes->push_back(std::to_string(held_count) + " of " + std::to_string(count) + " nodes fixed");

  Eigen::Matrix<bool, 3, Eigen::Dynamic> fixed(3, count);
  for (int node = 0; node < count; ++node) {
    const auto n = static_cast<size_t>(node);
    fixed.col(node).setConstant(held[n] || !body.used[n]);
  }
  return fixed;
}

}  // namespace palpate::robot

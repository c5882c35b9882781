// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/fixed_region.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "components/palpate/new_robot/fixed_boxes.hpp"
#include "components/palpate/new_robot/points_text.hpp"
#include "components/palpate/new_robot/unit_guess.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

const std::array<std::string, 6> kEnds = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// Adds the middles of edges whose both ends are in the region: they are fixed with them.
std::vector<int> WithMiddles(const BodyShape& shape, const std::vector<int>& corners) {
  constexpr std::array<std::array<int, 3>, 6> kEdges = {
      {{0, 1, 4}, {1, 2, 5}, {0, 2, 6}, {0, 3, 7}, {1, 3, 8}, {2, 3, 9}}};
  std::vector<bool> inside(shape.used.size(), false);
  for (const int node : corners) inside[At(node)] = shape.used[At(node)];
  const std::vector<bool> given = inside;
  for (int cell = 0; cell < shape.mesh.CellCount(); ++cell) {
    for (const auto& [a, b, middle] : kEdges) {
      const auto& cells = shape.mesh.cells;
      if (given[At(cells(a, cell))] && given[At(cells(b, cell))]) {
        inside[At(cells(middle, cell))] = true;
      }
    }
  }
  std::vector<int> nodes;
  for (size_t node = 0; node < inside.size(); ++node) {
    if (inside[node]) nodes.push_back(static_cast<int>(node));
  }
  return nodes;
}

bool SpansTriangle(const BodyShape& shape, const std::vector<int>& nodes) {
  if (nodes.size() < 3) return false;
  const Eigen::Matrix3Xd points_m = shape.mesh.nodes_m(Eigen::all, nodes);
  const Eigen::Matrix3Xd from_first_m = points_m.colwise() - points_m.col(0);
  Eigen::Index farthest = 0;
  if (from_first_m.colwise().norm().maxCoeff(&farthest) == 0.0) return false;
  const Eigen::Vector3d axis = from_first_m.col(farthest).normalized();
  const Eigen::Matrix3Xd off_m = from_first_m - axis * (axis.transpose() * from_first_m);
  return off_m.colwise().norm().maxCoeff() > 1e-3 * shape.element_m;
}

FixedRegion RegionOf(const BodyShape& shape, std::vector<int> nodes, Decision decision) {
  FixedRegion region;
  region.nodes = std::move(nodes);
  if (!SpansTriangle(shape, region.nodes)) {
    throw InputError("fixed region " + decision.value + " holds " +
                     std::to_string(region.nodes.size()) +
                     " nodes; it takes three that span a triangle: choose a larger one with "
                     "--fixed");
  }
  region.boxes = BoxesAround(shape, region.nodes);
  region.centre_m = shape.mesh.nodes_m(Eigen::all, region.nodes).rowwise().mean();
  decision.what = "fixed";
  decision.option = "--fixed";
  decision.value += fmt::format(", {} nodes", region.nodes.size());
  region.decision = std::move(decision);
  return region;
}

/// Nodes within the flatness of the end of the mesh along an axis.
std::vector<int> NodesAtEnd(const BodyShape& shape, const Eigen::Vector3d& direction,
                            double depth_m) {
  double end_m = direction.dot(shape.centroid_m);
  for (int node = 0; node < shape.mesh.NodeCount(); ++node) {
    if (!shape.used[At(node)]) continue;
    end_m = std::max(end_m, direction.dot(shape.mesh.nodes_m.col(node)));
  }
  std::vector<int> nodes;
  for (int node = 0; node < shape.mesh.NodeCount(); ++node) {
    const bool near = direction.dot(shape.mesh.nodes_m.col(node)) >= end_m - depth_m;
    if (shape.used[At(node)] && near) nodes.push_back(node);
  }
  return nodes;
}

std::vector<int> NodesOfNodeGroup(const fem::NodeGroup& group) {
  std::vector<int> nodes;
  for (const std::vector<int>& element : group.elements) {
    nodes.insert(nodes.end(), element.begin(), element.end());
  }
  return nodes;
}

std::vector<int> NodesOfCells(const fem::TetMesh& mesh, const std::vector<int>& cells) {
  const Eigen::MatrixXi nodes = mesh.cells(Eigen::all, cells);
  return {nodes.data(), nodes.data() + nodes.size()};
}

std::optional<std::vector<int>> NodesOfGroup(const SourceMesh& source, const std::string& name) {
  for (const fem::NodeGroup& group : source.groups) {
    if (group.name == name) return NodesOfNodeGroup(group);
  }
  for (const fem::CellGroup& group : source.mesh.groups) {
    if (group.name == name) return NodesOfCells(source.mesh, group.cells);
  }
  return std::nullopt;
}

std::vector<int> NodesInBox(const BodyShape& shape, const Eigen::Matrix3Xd& corners_m) {
  const double margin_m = shape.flatness_m();
  const geometry::Box box = {corners_m.rowwise().minCoeff().array() - margin_m,
                             corners_m.rowwise().maxCoeff().array() + margin_m};
  std::vector<int> nodes;
  for (int node = 0; node < shape.mesh.NodeCount(); ++node) {
    if (shape.used[At(node)] && box.Contains(shape.mesh.nodes_m.col(node))) nodes.push_back(node);
  }
  return nodes;
}

std::vector<int> NodesOfWord(const std::string& word, const SourceMesh& source,
                             const BodyShape& shape, double metres_per_unit) {
  if (const auto nodes = NodesOfGroup(source, word)) return WithMiddles(shape, *nodes);
  const auto end = std::find(kEnds.begin(), kEnds.end(), word);
  if (end != kEnds.end()) {
    const auto index = end - kEnds.begin();
    const Eigen::Vector3d direction =
        (index % 2 == 0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(index / 2);
    return NodesAtEnd(shape, direction, shape.flatness_m());
  }
  if (word.find(',') != std::string::npos) {
    const Eigen::Matrix3Xd corners_m = metres_per_unit * ParsePoints(word, "--fixed " + word);
    if (corners_m.cols() != 2) throw InputError("--fixed " + word + ": a box has two corners");
    return NodesInBox(shape, corners_m);
  }
  std::vector<std::string> names(kEnds.begin(), kEnds.end());
  for (const fem::NodeGroup& group : source.groups) names.push_back(group.name);
  for (const fem::CellGroup& group : source.mesh.groups) names.push_back(group.name);
  throw InputError("--fixed " + word + ": there is no such group or end" + DidYouMean(word, names) +
                   "; " + FixedChoices(source));
}

/// Groups whose name says that they are fixed; those of surfaces and nodes before volumes, whose
/// name "base" may be a part that moves.
std::optional<FixedRegion> NamedRegion(const SourceMesh& source, const BodyShape& shape) {
  const std::vector<std::string> surely = {
      "fixed",  "fix",   "clamp",  "clamped", "clamping", "encastre", "dirichlet",
      "anchor", "glued", "ground", "mount",   "mounting", "fixation"};
  const std::vector<std::string> probably = {"base", "bottom", "root", "foot",    "feet",
                                             "sole", "soles",  "wall", "support", "socket"};
  const auto of_group = [&](const std::string& name, const std::vector<int>& nodes) {
    return RegionOf(shape, WithMiddles(shape, nodes),
                    {.what = {},
                     .value = "group '" + name + "'",
                     .trust = Trust::kNamed,
                     .why = "the mesh file names a group so"});
  };
  for (const auto* words : {&surely, &probably}) {
    for (const fem::NodeGroup& group : source.groups) {
      const std::vector<int> nodes = NodesOfNodeGroup(group);
      if (!NamesOneOf(group.name, *words) || !SpansTriangle(shape, nodes)) continue;
      return of_group(group.name, nodes);
    }
    if (words == &probably) break;
    for (const fem::CellGroup& group : source.mesh.groups) {
      if (!NamesOneOf(group.name, surely)) continue;
      return of_group(group.name, NodesOfCells(source.mesh, group.cells));
    }
  }
  return std::nullopt;
}

std::string Describe(const FlatFace& face) {
  const Eigen::Vector3d& n = face.normal;
  Eigen::Index axis = 0;
  const double along = n.cwiseAbs().maxCoeff(&axis);
  const std::string area = fmt::format("{:.3g} mm2", 1e6 * face.area_m2);
  if (along < 0.999) {
    return fmt::format("flat face about {} ({})", PointText_mm(face.centre_m), area);
  }
  return fmt::format("flat face at {} = {:.4g} mm ({})", "xyz"[axis], 1e3 * face.centre_m(axis),
                     area);
}

FixedRegion OfFace(const BodyShape& shape, const FlatFace& face, Trust trust,
                   const std::string& why) {
  return RegionOf(shape, face.nodes,
                  {.what = {}, .value = Describe(face), .trust = trust, .why = why});
}

double DistanceToPulls_m(const FlatFace& face, const std::vector<Eigen::Vector3d>& pulls_m) {
  double sum_m = 0.0;
  for (const Eigen::Vector3d& pull_m : pulls_m) {
    sum_m += std::abs(face.normal.dot(pull_m - face.centre_m));
  }
  return sum_m / static_cast<double>(pulls_m.size());
}

/// Which of the two ends of a long body is fixed.
FixedRegion ChooseEnd(const BodyShape& shape, const FlatFace& a, const FlatFace& b,
                      const std::vector<Eigen::Vector3d>& pulls_m, const Eigen::Vector3d& up) {
  constexpr double kClearly = 1.5;
  if (!pulls_m.empty()) {
    const double to_a_m = DistanceToPulls_m(a, pulls_m), to_b_m = DistanceToPulls_m(b, pulls_m);
    if (kClearly * to_a_m < to_b_m || kClearly * to_b_m < to_a_m) {
      return OfFace(shape, to_a_m < to_b_m ? a : b, Trust::kLikely,
                    "the end from which the cables are pulled");
    }
  }
  if (a.area_m2 > kClearly * b.area_m2) {
    return OfFace(shape, a, Trust::kLikely,
                  fmt::format("the larger flat end of the long body, the other one has {:.3g} mm2",
                              1e6 * b.area_m2));
  }
  const auto at_origin = [&](const FlatFace& face) {
    return std::abs(face.normal.dot(face.centre_m)) <= shape.flatness_m();
  };
  if (at_origin(a) != at_origin(b)) {
    return OfFace(shape, at_origin(a) ? a : b, Trust::kUnsure,
                  "both flat ends of the long body are alike; this one holds the origin, where "
                  "drawings begin");
  }
  const bool a_is_lower = up.dot(a.centre_m - b.centre_m) <= 0.0;
  return OfFace(shape, a_is_lower ? a : b, Trust::kUnsure,
                "both flat ends of the long body are alike; this one is not above the other");
}

std::optional<FixedRegion> EndOfLongBody(const BodyShape& shape,
                                         const std::vector<Eigen::Vector3d>& pulls_m,
                                         const Eigen::Vector3d& up) {
  constexpr double kAlong = 0.9;
  std::vector<FlatFace> ends;
  for (const FlatFace& face : shape.flat_faces) {
    if (std::abs(face.normal.dot(shape.axes.col(0))) > kAlong) ends.push_back(face);
  }
  if (ends.empty()) return std::nullopt;
  if (ends.size() == 1) {
    return OfFace(shape, ends[0], Trust::kLikely, "the only flat end of the long body");
  }
  return ChooseEnd(shape, ends[0], ends[1], pulls_m, up);
}

std::optional<FixedRegion> LowestFace(const BodyShape& shape, const Eigen::Vector3d& up) {
  constexpr double kDown = -0.94;
  const auto lowest = std::find_if(shape.flat_faces.begin(), shape.flat_faces.end(),
                                   [&](const FlatFace& f) { return f.normal.dot(up) < kDown; });
  if (lowest == shape.flat_faces.end()) return std::nullopt;
  const bool largest = lowest == shape.flat_faces.begin();
  return OfFace(shape, *lowest, largest ? Trust::kLikely : Trust::kUnsure,
                largest ? "the lowest face, and the largest flat one" : "the lowest flat face");
}

/// Without a flat end: what lies within an element of the lower end of the longest axis.
FixedRegion Slab(const BodyShape& shape, const Eigen::Vector3d& up) {
  const Eigen::Vector3d axis = shape.axes.col(0);
  const double side = up.dot(axis) > 0.0 ? -1.0 : 1.0;
  return RegionOf(shape, NodesAtEnd(shape, side * axis, shape.element_m),
                  {.what = {},
                   .value = "the lower end of the longest axis",
                   .trust = Trust::kUnsure,
                   .why = "the body has no flat end; this is all within " +
                          LengthText(shape.element_m) + " of its end"});
}

}  // namespace

std::string FixedChoices(const SourceMesh& source) {
  std::string text =
      "an end of the mesh along an axis (x_min, x_max, y_min, ...), a box "
      "\"x,y,z;x,y,z\"";
  std::vector<std::string> names;
  for (const fem::NodeGroup& group : source.groups) {
    if (group.dimension != 1) names.push_back(group.name);
  }
  for (const fem::CellGroup& group : source.mesh.groups) names.push_back(group.name);
  return text + (names.empty() ? "; the mesh has no groups" : ", or a group: " + Listed(names));
}

FixedRegion FixedByWords(const std::vector<std::string>& words, const SourceMesh& source,
                         const BodyShape& shape, double metres_per_unit) {
  std::set<int> nodes;
  std::string value;
  for (const std::string& word : words) {
    const std::vector<int> own = NodesOfWord(word, source, shape, metres_per_unit);
    nodes.insert(own.begin(), own.end());
    value += (value.empty() ? "" : " and ") + word;
  }
  return RegionOf(shape, {nodes.begin(), nodes.end()},
                  {.what = {}, .value = value, .trust = Trust::kGiven, .why = "as you said"});
}

FixedRegion GuessFixed(const SourceMesh& source, const BodyShape& shape,
                       const std::vector<Eigen::Vector3d>& pull_points_m,
                       const Eigen::Vector3d& up) {
  if (auto named = NamedRegion(source, shape)) return *named;
  if (shape.is_long()) {
    if (auto end = EndOfLongBody(shape, pull_points_m, up)) return *end;
  }
  if (auto lowest = LowestFace(shape, up)) return *lowest;
  if (!shape.flat_faces.empty()) {
    return OfFace(shape, shape.flat_faces[0], Trust::kUnsure, "the largest flat face");
  }
  return Slab(shape, up);
}

}  // namespace palpate::command

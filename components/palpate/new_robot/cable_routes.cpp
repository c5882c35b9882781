// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/cable_routes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "components/palpate/new_robot/points_text.hpp"
#include "components/palpate/new_robot/unit_guess.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/embedding.hpp"

namespace palpate::command {

namespace {

/// A guide reaches a quarter of an element around its eyelet, and at most the robot file's default.
double GuideRadius_m(const BodyShape& shape) {
  constexpr double kDefault_m = 0.0015;
  return std::min(kDefault_m, 0.25 * shape.element_m);
}

Eigen::Matrix3Xd PointsOfName(const std::string& name, const SourceMesh& source,
                              const BodyShape& shape, const std::string& what) {
  std::vector<std::string> names;
  for (const fem::NodeGroup& group : source.groups) {
    if (group.dimension != 0) continue;
    names.push_back(group.name);
    if (group.name != name) continue;
    Eigen::Matrix3Xd points_m(3, ToIndex(group.elements.size()));
    for (size_t k = 0; k < group.elements.size(); ++k) {
      points_m.col(ToIndex(k)) = shape.mesh.nodes_m.col(group.elements[k].front());
    }
    return points_m;
  }
  throw InputError(what + ": '" + Excerpt(name) + "' is neither a point x,y,z nor a point of the " +
                   "mesh file" + DidYouMean(name, names) +
                   (names.empty() ? "; it names none" : "; it names " + Listed(names)));
}

bool StartsAsNumber(const std::string& text) {
  return text.find_first_of("0123456789") != std::string::npos &&
         text.find(',') != std::string::npos;
}

void CheckName(const std::string& name, const std::string& what) {
  const bool bad = name.empty() || name.find_first_of(",;\"'=\n") != std::string::npos;
  if (bad) throw InputError(what + ": write NAME=x,y,z;x,y,z;... with the pull point first");
}

/// Takes the unit from behind the last point, "x,y,z;x,y,z m", in metres; `standard`: none is
/// there.
double TakeUnit(std::vector<std::string>* pieces, double standard, const std::string& what) {
  std::string& last = pieces->back();
  const size_t blank = last.find_last_of(" \t");
  if (blank == std::string::npos || !StartsAsNumber(last)) return standard;
  const std::string word = last.substr(blank + 1);
  if (word.find_first_of("0123456789.,") != std::string::npos) return standard;  // "1, 2, 3"
  last.erase(blank);
  if (word == "m" || word == "cm" || word == "mm") return MetresPerUnit(word);
  throw InputError(what + ": '" + Excerpt(word) + "' is no unit: m, cm or mm");
}

void RefuseEqualNeighbours(const CableRoute& route, const std::string& what) {
  for (Eigen::Index k = 1; k < route.path_m.cols(); ++k) {
    if (route.path_m.col(k) == route.path_m.col(k - 1)) {
      throw InputError(what + fmt::format(": points {} and {} are the same", k, k + 1));
    }
  }
}

}  // namespace

CableRoute ParseCable(const std::string& text, const SourceMesh& source, const BodyShape& shape,
                      double metres_per_unit) {
  const std::string what = "--cable " + Excerpt(text);
  const size_t equals = text.find('=');
  CableRoute route;
  route.name = SplitText(text.substr(0, equals), '\n').front();
  CheckName(route.name, what);
  if (equals == std::string::npos) CheckName("", what);
  std::vector<Eigen::Vector3d> points_m;
  std::vector<std::string> pieces = SplitText(text.substr(equals + 1), ';');
  const double metres_per_number = TakeUnit(&pieces, metres_per_unit, what);
  for (const std::string& piece : pieces) {
    if (piece.empty()) continue;
    if (StartsAsNumber(piece)) {
      points_m.emplace_back(metres_per_number * ParsePoint(piece, what));
      continue;
    }
    const Eigen::Matrix3Xd named_m = PointsOfName(piece, source, shape, what);
    for (const auto& point_m : named_m.colwise()) {
      points_m.emplace_back(point_m);
    }
  }
  if (points_m.size() < 2) {
    throw InputError(what +
                     ": a cable has at least two points: where it is pulled from, and where "
                     "it is attached to the body");
  }
  route.path_m.resize(3, ToIndex(points_m.size()));
  for (size_t k = 0; k < points_m.size(); ++k) route.path_m.col(ToIndex(k)) = points_m[k];
  RefuseEqualNeighbours(route, what);
  route.guide_radius_m = GuideRadius_m(shape);
  route.why = "as you said";
  return route;
}

namespace {

const std::vector<std::string>& CableWords() {
  static const std::vector<std::string> words = {
      "cable",  "cables", "tendon", "tendons", "wire", "wires",  "string", "strings",
      "thread", "rope",   "ropes",  "bowden",  "pull", "eyelet", "eyelets"};
  return words;
}

bool IsNumber(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

/// "cable_up_2" is of cable "up"; "tendon1_2" of "tendon1"; `several`: a number at the end counts
/// the points of the cable.
std::string CableOfName(const std::string& name, bool several) {
  std::vector<std::string> words = WordsOfName(name);
  const auto is_cable = [](const std::string& word) {
    return std::find(CableWords().begin(), CableWords().end(), word) != CableWords().end();
  };
  const auto texts = std::count_if(words.begin(), words.end(), [&](const std::string& word) {
    return !IsNumber(word) && !is_cable(word);
  });
  if (several && words.size() > 1 && IsNumber(words.back())) words.pop_back();
  std::string cable;
  for (const std::string& word : words) {
    if (is_cable(word) && texts > 0) continue;
    cable += (cable.empty() || IsNumber(word) ? "" : "_") + word;
  }
  return cable;
}

/// Points of elements in the order in which they hang together, from an end on.
std::vector<int> ChainOf(const std::vector<std::vector<int>>& lines) {
  std::vector<std::pair<int, int>> left;
  for (const auto& line : lines) {
    if (line.size() >= 2) left.emplace_back(line[0], line[1]);
  }
  const auto uses = [&](int node) {
    return std::count_if(left.begin(), left.end(), [node](const std::pair<int, int>& line) {
      return line.first == node || line.second == node;
    });
  };
  std::vector<int> chain;
  for (const auto& [a, b] : left) {
    if (uses(a) == 1 || uses(b) == 1) {
      chain.push_back(uses(a) == 1 ? a : b);
      break;
    }
  }
  while (!chain.empty()) {
    const auto next = std::find_if(left.begin(), left.end(), [&](const auto& line) {
      return line.first == chain.back() || line.second == chain.back();
    });
    if (next == left.end()) break;
    chain.push_back(next->first == chain.back() ? next->second : next->first);
    left.erase(next);
  }
  return chain;
}

/// Begins nearest to the fixed region.
void Orient(const Eigen::Vector3d& fixed_m, Eigen::Matrix3Xd* path_m) {
  const double first_m = (path_m->col(0) - fixed_m).norm();
  const double last_m = (path_m->col(path_m->cols() - 1) - fixed_m).norm();
  if (last_m < first_m) *path_m = path_m->rowwise().reverse().eval();
}

std::vector<CableRoute> NamedCables(const SourceMesh& source, const BodyShape& shape,
                                    const Eigen::Vector3d& fixed_m) {
  std::vector<std::pair<std::string, std::vector<int>>> found;
  const auto add = [&](const std::string& cable, const std::vector<int>& nodes) {
    auto same = std::find_if(found.begin(), found.end(),
                             [&](const auto& entry) { return entry.first == cable; });
    if (same == found.end()) same = found.insert(found.end(), {cable, {}});
    same->second.insert(same->second.end(), nodes.begin(), nodes.end());
  };
  std::vector<const fem::NodeGroup*> groups;
  for (const fem::NodeGroup& group : source.groups) groups.push_back(&group);
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto* a, const auto* b) { return a->name < b->name; });
  for (const fem::NodeGroup* group : groups) {
    if (group->dimension > 1 || !NamesOneOf(group->name, CableWords())) continue;
    std::vector<int> nodes;
    for (const auto& element : group->elements) nodes.push_back(element.front());
    if (group->dimension == 1) nodes = ChainOf(group->elements);
    add(CableOfName(group->name, group->dimension == 0 && nodes.size() == 1), nodes);
  }
  std::vector<CableRoute> routes;
  for (const auto& [cable, nodes] : found) {
    if (nodes.size() < 2) continue;
    CableRoute route{.name = cable,
                     .path_m = shape.mesh.nodes_m(Eigen::all, nodes),
                     .guide_radius_m = GuideRadius_m(shape),
                     .trust = Trust::kNamed,
                     .why = "points or curves of the mesh file are named so"};
    Orient(fixed_m, &route.path_m);
    routes.push_back(std::move(route));
  }
  return routes;
}

/// Steps of about the body's width, at least three and at most twelve.
int StepsAlong(const BodyShape& shape, double length_m) {
  constexpr int kFewest = 3, kMost = 12;
  const double step_m = std::max(shape.extents_m(1), 2.0 * shape.element_m);
  return std::clamp(static_cast<int>(std::lround(length_m / step_m)), kFewest, kMost);
}

Eigen::Matrix3Xd StraightPath_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                                int steps) {
  Eigen::Matrix3Xd path_m(3, steps + 1);
  for (int k = 0; k <= steps; ++k) path_m.col(k) = from_m + (to_m - from_m) * k / steps;
  return path_m;
}

std::vector<CableRoute> CablesOfChannels(const BodyShape& shape,
                                         const std::vector<Channel>& channels,
                                         const Eigen::Vector3d& fixed_m) {
  std::vector<CableRoute> routes;
  for (const Channel& channel : channels) {
    Eigen::Matrix3Xd ends_m(3, 2);
    ends_m << channel.start_m, channel.end_m;
    Orient(fixed_m, &ends_m);
    const Eigen::Vector3d along = (ends_m.col(1) - ends_m.col(0)).normalized();
    // The last eyelet's guide lies in the body whole.
    const double guide_m = 1.5 * channel.radius_m;
    const Eigen::Vector3d last_m = ends_m.col(1) - guide_m * along;
    const double length_m = (last_m - ends_m.col(0)).norm();
    routes.push_back(
        {.name = fmt::format("cable_{}", routes.size() + 1),
         .path_m = StraightPath_m(ends_m.col(0), last_m, StepsAlong(shape, length_m)),
         .guide_radius_m = guide_m,
         .channel_radius_m = channel.radius_m,
         .trust = Trust::kLikely,
         .why = fmt::format("a straight channel of {} across and {} long",
                            LengthText(2.0 * channel.radius_m), LengthText(length_m))});
  }
  return routes;
}

}  // namespace

std::vector<CableRoute> GuessCables(const SourceMesh& source, const BodyShape& shape,
                                    const std::vector<Channel>& channels,
                                    const Eigen::Vector3d& fixed_m) {
  std::vector<CableRoute> named = NamedCables(source, shape, fixed_m);
  return named.empty() ? CablesOfChannels(shape, channels, fixed_m) : named;
}

void AddEyelets(const BodyShape& shape, CableRoute* route) {
  if (route->path_m.cols() != 2) return;
  constexpr int kSamples = 60;
  const fem::PointLocator locator(shape.mesh);
  const Eigen::Vector3d last_m = route->path_m.col(1);
  const Eigen::Matrix3Xd line_m = StraightPath_m(route->path_m.col(0), last_m, kSamples);
  const auto is_inside = [&](int k) {
    return locator.Distance_m(line_m.col(k)) <= shape.flatness_m();
  };
  int entry = 0;
  while (entry < kSamples && !is_inside(entry)) ++entry;
  // The attachment may lie on the surface, or just before it.
  for (int k = entry; k < kSamples - 1; ++k) {
    if (!is_inside(k)) return;
  }
  const double length_m = (last_m - line_m.col(entry)).norm();
  if (length_m < 2.0 * shape.element_m) return;
  const int steps = StepsAlong(shape, length_m);
  Eigen::Matrix3Xd path_m = StraightPath_m(line_m.col(entry), last_m, steps);
  path_m.col(0) = route->path_m.col(0);
  route->path_m = path_m;
  route->why +=
      fmt::format("; the line runs in the body, so {} eyelets were added along it", steps - 1);
}

void RefuseFarPoints(const BodyShape& shape, const CableRoute& route, double metres_per_unit) {
  const fem::PointLocator locator(shape.mesh);
  const auto in_file = [&](const Eigen::Vector3d& point_m) {
    return fmt::format("{:.5g},{:.5g},{:.5g}", point_m.x() / metres_per_unit,
                       point_m.y() / metres_per_unit, point_m.z() / metres_per_unit);
  };
  // A guide that does not touch the body holds on to nothing. Half an element: the surface of the
  // mesh is that far from a curved one at most.
  const double reach_m =
      std::max(route.guide_radius_m, route.channel_radius_m > 0.0 ? 0.0 : 0.5 * shape.element_m);
  for (Eigen::Index k = 0; k < route.path_m.cols(); ++k) {
    const Eigen::Vector3d point_m = route.path_m.col(k);
    const double distance_m = locator.Distance_m(point_m);
    const double allowed_m = k == 0 ? 2.0 * shape.diagonal_m : reach_m;
    if (distance_m <= allowed_m) continue;
    const Eigen::Vector3d nearest_m = locator.surface().Closest(point_m).position_m;
    throw InputError(fmt::format(
        "cable {}: {} {}, at {}, lies {} outside the body; allowed are {}. The nearest point of "
        "the body is {}; coordinates are in the unit of the mesh file",
        route.name, k == 0 ? "pull point" : "eyelet", in_file(point_m), PointText_mm(point_m),
        LengthText(distance_m), LengthText(allowed_m), in_file(nearest_m)));
  }
}

}  // namespace palpate::command

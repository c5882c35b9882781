// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/new_robot/marker_guess.hpp"

#include <algorithm>
#include <string>

#include "libs/core/index.hpp"
#include "libs/geometry/surface_sampling.hpp"

namespace palpate::command {

std::vector<robot::MarkerSettings> NamedMarkers(const SourceMesh& source, const BodyShape& shape) {
  const std::vector<std::string> words = {"marker", "markers", "fiducial", "fiducials", "led"};
  std::vector<robot::MarkerSettings> markers;
  for (const fem::NodeGroup& group : source.groups) {
    if (group.dimension != 0 || !NamesOneOf(group.name, words)) continue;
    for (size_t k = 0; k < group.elements.size(); ++k) {
      const std::string number = group.elements.size() > 1 ? "_" + std::to_string(k + 1) : "";
      markers.push_back({.name = group.name + number,
                         .position_m = shape.mesh.nodes_m.col(group.elements[k].front()),
                         .where = {}});
    }
  }
  return markers;
}

std::vector<int> FreeFaces(const BodyShape& shape, const FixedRegion& fixed,
                           const std::vector<Channel>& channels) {
  std::vector<bool> is_out(At(shape.boundary.FaceCount()), true);
  for (const int face : shape.outer_faces) is_out[At(face)] = false;
  for (const Channel& channel : channels) {
    for (const int face : channel.faces) is_out[At(face)] = true;
  }
  std::vector<bool> is_fixed(shape.used.size(), false);
  for (const int node : fixed.nodes) is_fixed[At(node)] = true;
  std::vector<int> faces;
  for (int face = 0; face < shape.boundary.FaceCount(); ++face) {
    const auto nodes = shape.boundary.faces.col(face);
    const bool holds_fixed =
        std::any_of(nodes.begin(), nodes.end(), [&](int node) { return is_fixed[At(node)]; });
    if (!is_out[At(face)] && !holds_fixed) faces.push_back(face);
  }
  return faces;
}

std::vector<robot::MarkerSettings> SpreadMarkers(const BodyShape& shape, const FixedRegion& fixed,
                                                 const std::vector<Channel>& channels, int count) {
  const std::vector<int> faces = FreeFaces(shape, fixed, channels);
  std::vector<robot::MarkerSettings> markers;
  if (count == 0 || faces.empty()) return markers;
  geometry::TriangleSurface free = shape.surface;
  free.triangles = shape.surface.triangles(Eigen::all, faces);
  const geometry::SurfaceSamples spread = geometry::SpreadEvenly(free, count);
  for (int k = 0; k < count; ++k) {
    markers.push_back({.name = "m" + std::to_string(k + 1),
                       .position_m = spread.positions_m.col(k),
                       .where = {}});
  }
  return markers;
}

}  // namespace palpate::command

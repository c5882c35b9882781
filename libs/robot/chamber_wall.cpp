// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/chamber_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/stl_reader.hpp"
#include "libs/geometry/closed_surface.hpp"
#include "libs/geometry/rigid_transform.hpp"

namespace palpate::robot {

namespace {

/// How far a vertex of a surface file may lie from the wall: of the body's diagonal.
constexpr double kReachOfDiagonal = 0.01;
/// Least volume, as a share of the cube over the diagonal of the chamber.
constexpr double kLeastVolume = 1e-9;

std::string PlaceText(const Eigen::Vector3d& place_m) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "(%.4g, %.4g, %.4g) mm", 1e3 * place_m.x(),
                1e3 * place_m.y(), 1e3 * place_m.z());
  return text.data();
}

/// Refusals name the chamber and the place in the robot file.
class WallMaker {
 public:
  WallMaker(const ChamberSettings& chamber, const MeshSettings& placement,
            const fem::PointLocator& locator, const std::vector<fem::NodeGroup>& groups)
      : chamber_(chamber), placement_(placement), locator_(locator), groups_(groups) {}

  fem::MovingSurface Make() const {
    if (!chamber_.surface.file.empty()) return OfFile();
    return OfFaces(chamber_.surface.inner_skin > 0 ? InnerSkin() : GroupFaces());
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(chamber_.surface_where, "chamber " + chamber_.name + ": " + message);
  }

  std::vector<int> InnerSkin() const {
    const std::vector<std::vector<int>> skins =
        fem::InnerSkins(locator_.mesh(), locator_.boundary());
    const auto wanted = At(chamber_.surface.inner_skin);
    if (wanted <= skins.size()) return skins[wanted - 1];
    Fail("the mesh has " +
         (skins.empty() ? std::string("no closed inner surface")
                        : std::to_string(skins.size()) + " closed inner surfaces") +
         ", inner_skin: " + std::to_string(wanted) +
         " is none of them; leave the chamber out of the mesh as a hollow that nothing opens");
  }

  const fem::NodeGroup& Group() const {
    std::vector<std::string> names;
    for (const fem::NodeGroup& group : groups_) {
      if (group.dimension != 2) continue;
      if (group.name == chamber_.surface.physical_group) return group;
      names.push_back(group.name);
    }
    const std::string& wanted = chamber_.surface.physical_group;
    Fail(
        "the mesh has no group of triangles '" + wanted + "'" + DidYouMean(wanted, names) +
        (names.empty() ? "; it has none (Gmsh: Physical Surface)" : "; there is " + Listed(names)));
  }

  /// Faces of the boundary with the corners of the group's triangles.
  std::vector<int> GroupFaces() const {
    std::map<std::array<int, 3>, int> face_of_corners;
    const Eigen::Matrix3Xi corners = locator_.boundary().CornerTriangles();
    for (int face = 0; face < corners.cols(); ++face) {
      face_of_corners[Sorted({corners(0, face), corners(1, face), corners(2, face)})] = face;
    }
    std::vector<int> faces;
    for (const std::vector<int>& element : Group().elements) {
      if (element.size() != 3 && element.size() != 6) Fail("its group holds more than triangles");
      const auto found = face_of_corners.find(Sorted({element[0], element[1], element[2]}));
      if (found == face_of_corners.end()) {
        const Eigen::Matrix3Xd& nodes_m = locator_.mesh().nodes_m;
        Fail("the triangle of nodes " + std::to_string(element[0]) + ", " +
             std::to_string(element[1]) + ", " + std::to_string(element[2]) + " near " +
             PlaceText(nodes_m.col(element[0])) +
             " has material on both sides, or on none: a wall of a chamber has it on one; leave "
             "the chamber itself out of the mesh");
      }
      faces.push_back(found->second);
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

  static std::array<int, 3> Sorted(std::array<int, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  fem::MovingSurface OfFaces(const std::vector<int>& faces) const {
    fem::MovingSurface wall = WallOfFaces(locator_.boundary(), faces);
    CheckWall(wall, "it is an outer surface of the body: a chamber lies inside it");
    return wall;
  }

  fem::MovingSurface OfFile() const {
    geometry::TriangleSurface surface =
        fem::ReadStl(chamber_.surface.file, placement_.metres_per_unit);
    const Eigen::Matrix3d R = geometry::RotationFromFixedXyz_deg(placement_.rotate_xyz_deg);
    surface.vertices_m = ((R * surface.vertices_m).colwise() + placement_.translate_m).eval();
    const geometry::Box body = geometry::BoundingBox(locator_.mesh().nodes_m);
    fem::MovingSurface wall;
    wall.faces = surface.triangles;
    for (Eigen::Index v = 0; v < surface.vertices_m.cols(); ++v) {
      const Eigen::Vector3d place_m = surface.vertices_m.col(v);
      const double distance_m = locator_.surface().Closest(place_m).distance_m;
      if (distance_m > kReachOfDiagonal * body.Diagonal_m()) {
        Fail("the vertex of its file at " + PlaceText(place_m) + " lies " +
             FormatNumber(1e3 * distance_m) +
             " mm from every wall of the mesh; is the file in the unit and frame of the mesh, and "
             "is the chamber left out of it?");
      }
      wall.points.push_back(locator_.Embed(place_m).weights);
    }
    CheckWall(wall,
              "its triangles are turned inside out: their normals must point into the "
              "material, away from the chamber");
    return wall;
  }

  void CheckWall(const fem::MovingSurface& wall, const std::string& inside_out) const {
    geometry::TriangleSurface flat{Eigen::Matrix3Xd(3, ToIndex(wall.points.size())),
                                   wall.faces.topRows<3>()};
    const Eigen::VectorXd rest_m = locator_.mesh().nodes_m.reshaped();
    for (std::size_t p = 0; p < wall.points.size(); ++p) {
      flat.vertices_m.col(ToIndex(p)) = wall.points[p].Position(rest_m);
    }
    RefuseOpen(flat);
    const double volume_m3 = fem::EnclosedVolume(wall).Volume_m3(rest_m);
    const double diagonal_m = geometry::BoundingBox(flat.vertices_m).Diagonal_m();
    if (std::abs(volume_m3) < kLeastVolume * std::pow(diagonal_m, 3)) {
      Fail("its surface encloses no volume");
    }
    if (volume_m3 < 0.0) Fail(inside_out);
    if (const auto cutting = geometry::FindCuttingTriangles(flat)) {
      Fail("its triangles " + std::to_string((*cutting)[0]) + " and " +
           std::to_string((*cutting)[1]) + " near " + PlaceText(flat.Corner((*cutting)[0], 0)) +
           " cut each other: repair the surface");
    }
  }

  void RefuseOpen(const geometry::TriangleSurface& flat) const {
    const auto edge = geometry::FindUnmatchedEdge(flat.triangles);
    if (!edge) return;
    const std::string between = "the edge from " +
                                PlaceText(flat.vertices_m.col(edge->vertices[0])) + " to " +
                                PlaceText(flat.vertices_m.col(edge->vertices[1]));
    if (edge->other >= 0) {
      Fail("its triangles " + std::to_string(edge->triangle) + " and " +
           std::to_string(edge->other) + " at " + between +
           " are turned opposite ways: orient the surface alike");
    }
    Fail("its surface is open at " + between +
         ": close it, also where the supply enters (a thin lid of material)");
  }

  const ChamberSettings& chamber_;
  const MeshSettings& placement_;
  const fem::PointLocator& locator_;
  const std::vector<fem::NodeGroup>& groups_;
};

}  // namespace

fem::MovingSurface WallOfFaces(const fem::BoundarySurface& boundary,
                               const std::vector<int>& faces) {
  constexpr std::array<int, 6> kTurned{0, 2, 1, 5, 4, 3};
  fem::MovingSurface wall;
  wall.faces.resize(boundary.faces.rows(), ToIndex(faces.size()));
  std::map<int, int> point_of_node;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (Eigen::Index k = 0; k < wall.faces.rows(); ++k) {
      const int node = boundary.faces(kTurned[At(k)], faces[f]);
      const auto [entry, is_new] =
          point_of_node.try_emplace(node, static_cast<int>(wall.points.size()));
      if (is_new) wall.points.push_back({{node}, {1.0}});
      wall.faces(k, ToIndex(f)) = entry->second;
    }
  }
  return wall;
}

fem::MovingSurface ChamberWall(const ChamberSettings& chamber, const MeshSettings& placement,
                               const fem::PointLocator& locator,
                               const std::vector<fem::NodeGroup>& groups) {
  return WallMaker(chamber, placement, locator, groups).Make();
}

}  // namespace palpate::robot

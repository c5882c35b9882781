// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/robot_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/shape_functions.hpp"
#include "libs/geometry/box.hpp"
#include "libs/geometry/surface_sampling.hpp"
#include "libs/robot/body_mesh.hpp"
#include "libs/robot/chamber.hpp"
#include "libs/robot/chamber_wall.hpp"
#include "libs/robot/fibre_paths.hpp"

namespace palpate::robot {

namespace {

constexpr double kCableReach_m = 0.020;
constexpr double kCableReachOfDiagonal = 0.05;

std::string Rounded(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string Millimetres(double length_m) { return Rounded(length_m * 1e3, 3) + " mm"; }

/// Whether the surface is in the way in nearly all directions from a point outside the mesh.
bool IsInHollow(const fem::PointLocator& locator, const Eigen::Vector3d& point_m) {
  constexpr double kNearlyAll = 0.9;
  const geometry::TriangleSurface& surface = locator.surface().surface();
  int blocked = 0;
  int directions = 0;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d direction(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (direction.isZero()) continue;
    ++directions;
    blocked += geometry::RayMeets(surface, point_m, direction) ? 1 : 0;
  }
  return blocked >= kNearlyAll * directions;
}

/// Places points of the robot file on the body, and says where they lie off it.
class PointPlacer {
 public:
  PointPlacer(const fem::PointLocator& locator, RobotBody* body)
      : locator_(locator),
        notes_(&body->notes),
        warnings_(&body->warnings),
        diagonal_m_(geometry::BoundingBox(locator.mesh().nodes_m).Diagonal_m()) {}

  fem::BodyPoint Eyelet(const CableSettings& cable, Eigen::Index index) const {
    const bool is_last = index + 1 == cable.path_m.cols();
    const std::string name = "cable " + cable.name + ": " +
                             (is_last ? "attachment" : "point " + std::to_string(index + 1));
    const fem::BodyPoint point = locator_.EmbedBall(cable.path_m.col(index), cable.guide_radius_m);
    const double reach_m = std::min(kCableReach_m, kCableReachOfDiagonal * diagonal_m_);
    if (point.distance_m > reach_m) {
      throw InputError(cable.where, name + " lies " + Millimetres(point.distance_m) +
                                        " from the body; allowed are " + Millimetres(reach_m) +
                                        " (20 mm, or 5 % of the body's diagonal where that is "
                                        "less); is the path in metres?");
    }
    // Where the guide reaches the wall, the hollow is the channel that the cable runs in.
    const bool off_the_wall = point.distance_m > std::max(0.0, cable.guide_radius_m);
    if (off_the_wall && IsInHollow(locator_, point.rest_m)) {
      warnings_->push_back(name + " lies in a hollow, " + Millimetres(point.distance_m) +
                           " off the nearest wall: it moves as if it were fixed to that wall; is "
                           "path_m meant to be in the material?");
      return point;
    }
    NoteDistance(name, point);
    return point;
  }

  fem::BodyPoint StandOff(const std::string& name, const Eigen::Vector3d& position_m,
                          const SourceLocation& where) const {
    const fem::BodyPoint point = locator_.Embed(position_m);
    if (point.distance_m > diagonal_m_) {
      throw InputError(where, name + " lies " + Millimetres(point.distance_m) +
                                  " from the body; allowed is its diagonal, " +
                                  Millimetres(diagonal_m_) + "; is the position in metres?");
    }
    NoteDistance(name, point);
    return point;
  }

 private:
  void NoteDistance(const std::string& name, const fem::BodyPoint& point) const {
    if (point.distance_m <= 0.0) return;
    notes_->push_back(name + " " + Millimetres(point.distance_m) +
                      " outside the mesh, extrapolated in element " + std::to_string(point.cell));
  }

  const fem::PointLocator& locator_;
  std::vector<std::string>* notes_;
  std::vector<std::string>* warnings_;
  double diagonal_m_;
};

/// Adds a note where elements lock (docs/near_incompressibility.md).
void NoteLocking(const RobotDescription& robot, std::vector<std::string>* notes) {
  const fem::Material& material = robot.material;
  if (material.poissons_ratio < kNearlyIncompressible) return;
  const std::string ratio = "Poisson's ratio " + FormatNumber(material.poissons_ratio);
  if (robot.element == fem::ElementType::kTet4) {
    notes->push_back(ratio +
                     ": tet4 locks, the body is 20 % to 20 times too stiff; element: tet10 "
                     "with volumetric: mean_dilatation does not");
  } else if (material.volumetric == fem::Volumetric::kPointwise) {
    notes->push_back(
        ratio +
        ": tet10 with pointwise dilatation locks, the body is 4 to 30 % too "
        "stiff; volumetric: mean_dilatation does not, where the material model has it");
  }
}

/// Adds a warning for a modulus that no solid has: a number in another unit.
void WarnOfUnit(const std::string& part, double youngs_modulus_Pa,
                std::vector<std::string>* warnings) {
  constexpr double kSoftestSolid_Pa = 1e3;
  if (youngs_modulus_Pa >= kSoftestSolid_Pa) return;
  const bool is_MPa = youngs_modulus_Pa < 10.0;
  warnings->push_back(part + ": youngs_modulus_Pa: " + FormatNumber(youngs_modulus_Pa) +
                      " Pa is softer than any solid: is this " + (is_MPa ? "MPa" : "kPa") +
                      "? Then write " +
                      std::to_string(std::llround(youngs_modulus_Pa * (is_MPa ? 1e6 : 1e3))));
}

Eigen::Vector3d Centroid_m(const fem::TetMesh& mesh, int cell) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (int corner = 0; corner < 4; ++corner) sum_m += mesh.nodes_m.col(mesh.cells(corner, cell));
  return sum_m / 4.0;
}

std::vector<int> CellsOf(const RegionSettings& region, const fem::TetMesh& mesh) {
  if (!region.mesh_group.empty()) {
    std::vector<std::string> names;
    for (const fem::CellGroup& group : mesh.groups) {
      if (group.name == region.mesh_group) return group.cells;
      names.push_back(group.name);
    }
    throw InputError(region.where,
                     "the mesh has no group '" + region.mesh_group + "'" +
                         DidYouMean(region.mesh_group, names) +
                         (names.empty() ? "; it has none" : "; there is " + Listed(names)));
  }
  std::vector<int> cells;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    if (region.box.Contains(Centroid_m(mesh, cell))) cells.push_back(cell);
  }
  return cells;
}

void AssignMaterials(const RobotDescription& robot, RobotBody* body) {
  body->materials.push_back(robot.material);
  WarnOfUnit("material", robot.material.youngs_modulus_Pa, &body->warnings);
  body->nominal_poissons_ratio = robot.material.poissons_ratio;
  body->material_of_cell.assign(static_cast<size_t>(body->mesh.CellCount()), 0);
  for (const RegionSettings& region : robot.regions) {
    const int index = static_cast<int>(body->materials.size());
    fem::Material material = robot.material;
    if (region.youngs_modulus_Pa) material.youngs_modulus_Pa = *region.youngs_modulus_Pa;
    if (region.youngs_modulus_Pa) {
      WarnOfUnit("region " + region.name, *region.youngs_modulus_Pa, &body->warnings);
    }
    body->materials.push_back(material);
    body->region_names.push_back(region.name);
    for (const int cell : CellsOf(region, body->mesh)) body->material_of_cell[At(cell)] = index;
  }
  for (size_t k = 0; k < robot.regions.size(); ++k) {
    const auto& of_cell = body->material_of_cell;
    if (std::find(of_cell.begin(), of_cell.end(), static_cast<int>(k) + 1) == of_cell.end()) {
      throw InputError(
          robot.regions[k].where,
          "region '" + robot.regions[k].name + "' has no element: " +
              (robot.regions[k].mesh_group.empty() ? "no centroid lies in its box, or " : "") +
              "later regions take all");
    }
  }
}

Eigen::VectorXd NodeMass_kg(const MassSettings& mass, const BodyMesh& body) {
  const Eigen::VectorXd unit_density = Eigen::VectorXd::Ones(body.mesh.CellCount());
  const Eigen::VectorXd node_volume_m3 = fem::ConsistentNodalMass_kg(body.mesh, unit_density);
  const double volume_m3 = node_volume_m3.sum();
  const double total_kg = mass.total_kg ? *mass.total_kg : mass.density_kg_m3.value() * volume_m3;
  if (mass.distribution == MassDistribution::kVolume)
    return node_volume_m3 * (total_kg / volume_m3);
  const auto used_count = std::count(body.used.begin(), body.used.end(), true);
  Eigen::VectorXd equal_kg = Eigen::VectorXd::Zero(body.mesh.NodeCount());
  for (int node = 0; node < body.mesh.NodeCount(); ++node) {
    if (body.used[At(node)]) {
      equal_kg(node) = total_kg / static_cast<double>(used_count);
    }
  }
  return equal_kg;
}

/// Of `feature_points: {region: ...}`; all materials where none is named.
bool IsOfRegion(const std::vector<std::string>& regions, const std::string& region, int material) {
  return region.empty() || (material > 0 && regions[At(material - 1)] == region);
}

void FindContactFaces(const RobotDescription& robot, RobotBody* body) {
  const std::vector<int> outer = fem::OuterFaces(body->mesh, body->boundary);
  for (const int face : outer) {
    const int material = body->material_of_cell[At(body->boundary.cells(face))];
    if (IsOfRegion(body->region_names, robot.feature_point_region, material)) {
      body->contact_faces.push_back(face);
    }
  }
  if (body->contact_faces.empty() && !robot.feature_point_region.empty()) {
    throw InputError(robot.feature_points_where,
                     "region '" + robot.feature_point_region + "' has no outer surface");
  }
}

void PlaceFeaturePoints(const RobotDescription& robot, const fem::PointLocator& locator,
                        const PointPlacer& placer, RobotBody* body) {
  FindContactFaces(robot, body);
  const geometry::TriangleSurface& surface = locator.surface().surface();
  if (robot.feature_points_m.cols() == 0) {
    const geometry::SurfaceSamples spread =
        geometry::SpreadEvenly(ContactSurface(*body), robot.feature_point_count);
    for (const auto& position_m : spread.positions_m.colwise()) {
      body->feature_points.push_back(locator.Embed(position_m));
    }
    body->feature_normals = spread.normals;
    return;
  }
  body->feature_points_are_given = true;
  body->feature_normals.resize(3, robot.feature_points_m.cols());
  for (Eigen::Index k = 0; k < robot.feature_points_m.cols(); ++k) {
    const Eigen::Vector3d position_m = robot.feature_points_m.col(k);
    body->feature_points.push_back(placer.StandOff("feature point " + std::to_string(k + 1),
                                                   position_m, robot.feature_points_where));
    body->feature_normals.col(k) =
        geometry::TriangleNormal(surface, locator.surface().Closest(position_m).triangle);
  }
}

void PlacePoints(const RobotDescription& robot, const fem::PointLocator& locator, RobotBody* body) {
  const PointPlacer placer(locator, body);
  for (const CableSettings& settings : robot.cables) {
    BodyCable cable{settings.name,          settings.path_m.col(0),        {},
                    settings.max_tension_N, settings.friction_coefficient, settings.guide_radius_m};
    cable.play_m = settings.play_m;
    for (Eigen::Index k = 1; k < settings.path_m.cols(); ++k) {
      cable.eyelets.push_back(placer.Eyelet(settings, k));
    }
    body->cables.push_back(std::move(cable));
  }
  for (const MarkerSettings& marker : robot.markers) {
    body->markers.push_back(
        {marker.name, placer.StandOff("marker " + marker.name, marker.position_m, marker.where)});
  }
  PlaceFeaturePoints(robot, locator, placer, body);
}

/// Corners of a wall's faces on the mesh, each sorted; empty of a wall that a file gives, whose
/// vertices are not nodes.
std::set<std::array<int, 3>> FacesOnNodes(const fem::MovingSurface& wall) {
  std::set<std::array<int, 3>> faces;
  for (const auto& face : wall.faces.colwise()) {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const fem::InterpolationWeights& point = wall.points[At(face[ToIndex(k)])];
      if (point.nodes.size() != 1) return {};
      corners[k] = point.nodes.front();
    }
    std::sort(corners.begin(), corners.end());
    faces.insert(corners);
  }
  return faces;
}

/// Refuses a chamber whose wall has a face of an earlier one: a face has one hollow on its free
/// side, so both would be the same hollow, with two pressures. Hollows on both sides of a membrane
/// have a wall each.
void RequireWallOfItsOwn(const ChamberSettings& settings, const fem::MovingSurface& wall,
                         const RobotBody& body) {
  const std::set<std::array<int, 3>> own = FacesOnNodes(wall);
  for (const BodyChamber& other : body.chambers) {
    for (const std::array<int, 3>& face : FacesOnNodes(other.wall)) {
      if (!own.contains(face)) continue;
      const Eigen::Vector3d centre_mm = 1e3 * body.mesh.nodes_m(Eigen::all, face).rowwise().mean();
      throw InputError(settings.surface_where,
                       "chamber '" + settings.name + "' has the wall of chamber '" + other.name +
                           "', as at (" + FormatNumber(std::round(1e2 * centre_mm.x()) / 1e2) +
                           ", " + FormatNumber(std::round(1e2 * centre_mm.y()) / 1e2) + ", " +
                           FormatNumber(std::round(1e2 * centre_mm.z()) / 1e2) +
                           ") mm; a hollow is one chamber, and hollows beside each other need a "
                           "membrane with elements between them");
    }
  }
}

void PlaceChambers(const RobotDescription& robot, const fem::PointLocator& locator,
                   const std::vector<fem::NodeGroup>& groups, RobotBody* body) {
  const Eigen::VectorXd rest_m = body->mesh.nodes_m.reshaped();
  for (const ChamberSettings& settings : robot.chambers) {
    BodyChamber chamber{settings.name, ChamberWall(settings, robot.mesh, locator, groups), 0.0,
                        settings.dead_volume_m3, settings.max_pressure_Pa};
    RequireWallOfItsOwn(settings, chamber.wall, *body);
    chamber.volume_m3 = fem::EnclosedVolume(chamber.wall).Volume_m3(rest_m);
    body->notes.push_back("chamber " + chamber.name + ": " +
                          std::to_string(chamber.wall.faces.cols()) + " faces around " +
                          Rounded(1e6 * chamber.volume_m3, 4) + " cm3");
    body->chambers.push_back(std::move(chamber));
  }
}

void PlaceFibres(const RobotDescription& robot, const fem::PointLocator& locator, RobotBody* body) {
  if (robot.fibres.empty()) return;
  const double inextensible_N = InextensibleStiffness_N(body->mesh, body->materials);
  for (const FibreSettings& settings : robot.fibres) {
    BodyFibre fibre = LayFibre(settings, locator, inextensible_N);
    if (fibre.embedded.off_m > 0.0) {
      body->notes.push_back("fibre " + fibre.name + " " + Millimetres(fibre.embedded.off_m) +
                            " outside the mesh at its farthest, extrapolated");
    }
    body->fibres.push_back(std::move(fibre));
  }
}

}  // namespace

std::vector<fem::EmbeddedFibre> EmbeddedFibres(const std::vector<BodyFibre>& fibres) {
  std::vector<fem::EmbeddedFibre> embedded;
  for (const BodyFibre& fibre : fibres) embedded.push_back(fibre.embedded);
  return embedded;
}

std::vector<ActuatorTraits> ActuatorsOf(const RobotBody& body) {
  std::vector<ActuatorTraits> actuators;
  for (const BodyCable& cable : body.cables) {
    actuators.push_back({.name = cable.name, .most_force_N = cable.max_tension_N});
  }
  for (const BodyChamber& chamber : body.chambers) {
    const double area_m2 = PistonArea_m2(chamber.volume_m3);
    actuators.push_back({.kind = ActuatorKind::kChamber,
                         .name = chamber.name,
                         .least_force_N = kVacuum_Pa * area_m2,
                         .most_force_N = chamber.max_pressure_Pa * area_m2,
                         .area_m2 = area_m2});
  }
  return actuators;
}

geometry::TriangleSurface ContactSurface(const RobotBody& body) {
  geometry::TriangleSurface surface = fem::RestSurface(body.mesh, body.boundary);
  if (!body.contact_faces.empty()) {
    surface.triangles = surface.triangles(Eigen::all, body.contact_faces).eval();
  }
  return surface;
}

RobotBody BuildRobotBody(const RobotDescription& robot) {
  RobotBody body;
  body.name = robot.name;
  const BodyMesh read = ReadBodyMesh(robot, &body.notes);
  body.mesh_hash = read.hash;
  body.mesh = read.mesh;
  body.fixed = HoldNodes(robot, read, &body.notes);
  AssignMaterials(robot, &body);
  body.creep = robot.creep;
  body.softening = robot.softening;
  NoteLocking(robot, &body.notes);
  body.node_mass_kg = NodeMass_kg(robot.mass, read);
  body.gravity_m_s2 = robot.gravity_m_s2;
  const fem::PointLocator locator(read.mesh);
  body.boundary = locator.boundary();
  PlacePoints(robot, locator, &body);
  PlaceChambers(robot, locator, read.node_groups, &body);
  PlaceFibres(robot, locator, &body);
  return body;
}

}  // namespace palpate::robot

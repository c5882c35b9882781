// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/robot_description.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "libs/core/config_reader.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/kernels/kernel.hpp"
#include "libs/robot/robot_file_keys.hpp"

namespace palpate::robot {

namespace {

/// Names become columns of CSV files and parts of topic names.
std::string ReadName(const ConfigNode& node) {
  const std::string name = ReadText(node);
  const bool has_bad_character = std::any_of(name.begin(), name.end(), [](char c) {
    return c == ',' || c == ';' || c == '"' || c == '\'' || static_cast<unsigned char>(c) < 0x20;
  });
  if (name.empty() || has_bad_character || name.front() == ' ' || name.back() == ' ') {
    Refuse(node,
           "must be a name without commas, semicolons, quotes, control characters or blanks "
           "at its ends, not '" +
               name + "'");
  }
  return name;
}

/// Reads the name of one item of a list; refuses one that stands there already.
std::string ReadUniqueName(const ConfigNode& node, std::set<std::string>* seen) {
  const std::string name = ReadName(node);
  if (!seen->insert(name).second) Refuse(node, "the name '" + name + "' is given twice");
  return name;
}

const std::vector<ConfigNode>& Items(const ConfigNode& node, const std::string& of_what) {
  if (node.kind != ConfigNode::Kind::kList) Refuse(node, "must be a list of " + of_what);
  return node.items;
}

Box ReadBox(const ConfigNode& node) {
  const Eigen::Matrix3Xd corners_m = ReadPoints(node);
  if (corners_m.cols() != 2) {
    Refuse(node,
           "must be two corners [[x, y, z], [x, y, z]], not " + std::to_string(corners_m.cols()));
  }
  if ((corners_m.col(0).array() > corners_m.col(1).array()).any()) {
    Refuse(node, "the first corner must be the lower one in x, y and z");
  }
  return {corners_m.col(0), corners_m.col(1)};
}

MeshSettings ReadMeshSettings(const ConfigNode& node) {
  static const std::map<std::string, double> units{{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}};
  MapReader map(node, MeshKeys());
  MeshSettings mesh;
  map.Read("file", &mesh.file);
  mesh.where = map.Require("file").where;
  std::string unit;
  map.Read("unit", &unit);
  mesh.metres_per_unit = units.at(unit);
  map.Read("rotate_xyz_deg", &mesh.rotate_xyz_deg);
  const ConfigNode* metres = map.Optional("translate_m");
  const ConfigNode* millimetres = map.Optional("translate_mm");
  if (metres != nullptr && millimetres != nullptr) {
    Refuse(*millimetres, "translate_m is given too: give one of them");
  }
  map.Finish();
  map.Read("translate_m", &mesh.translate_m);
  if (millimetres != nullptr) mesh.translate_m = ReadVector3(*millimetres) / 1000.0;
  return mesh;
}

double ReadPoissonsRatio(const ConfigNode& node) {
  const double ratio = ReadNumber(node);
  if (ratio > kLargestPoissonsRatio) {
    Refuse(node, "must be " + DescribeRule(kPoissonsRatio) + ", not " + node.text + ": give " +
                     FormatNumber(kLargestPoissonsRatio) +
                     " for an incompressible body, nothing moves differently beyond it");
  }
  return ReadNumber(node, kPoissonsRatio);
}

fem::Volumetric ReadVolumetric(MapReader* map, fem::ElementType element,
                               const fem::Material& material) {
  const bool can_average = fem::kernels::SupportsMeanDilatation(material.model);
  bool average = can_average && element == fem::ElementType::kTet10 &&
                 material.poissons_ratio >= kNearlyIncompressible;
  if (const ConfigNode* node = map->Optional("volumetric")) {
    std::string volumetric;
    map->Read("volumetric", &volumetric);
    average = volumetric == "mean_dilatation";
    if (average && !can_average) {
      Refuse(*node, "material '" + std::string(fem::ToString(material.model)) +
                        "' has no volumetric energy of its own to average: give pointwise, or "
                        "another model such as stable_neo_hookean");
    }
  }
  return average ? fem::Volumetric::kMeanDilatation : fem::Volumetric::kPointwise;
}

/// The ratios belong to the Yeoh material, and to no other.
void ReadYeohRatios(MapReader* map, fem::Material* material) {
  if (material->model != fem::MaterialModel::kYeoh) {
    for (const char* key : {"c20_over_c10", "c30_over_c10"}) {
      if (const ConfigNode* ratio = map->Optional(key)) {
        Refuse(*ratio, "belongs to the material 'yeoh', not to '" +
                           std::string(fem::ToString(material->model)) + "'");
      }
    }
    return;
  }
  map->Read("c20_over_c10", &material->c20_over_c10);
  map->Read("c30_over_c10", &material->c30_over_c10);
  if (!fem::IsYeohMonotone(material->c20_over_c10, material->c30_over_c10)) {
    Refuse(map->Require("c30_over_c10"),
           "must be more than a third of the square of a negative c20_over_c10: the "
           "material would lose its stiffness at large strains");
  }
}

fem::PronyTerm ReadCreep(const ConfigNode& node) {
  MapReader map(node, CreepKeys());
  fem::PronyTerm term;
  map.Read("share", &term.g);
  map.Read("time_s", &term.tau_s);
  map.Finish();
  return term;
}

fem::MullinsLaw ReadSoftening(const ConfigNode& node) {
  MapReader map(node, SofteningKeys());
  fem::MullinsLaw law;
  map.Read("r", &law.r);
  map.Read("m_J_m3", &law.m_J_m3);
  map.Finish();
  return law;
}

void ReadMaterial(const ConfigNode& node, RobotDescription* robot) {
  MapReader map(node, MaterialKeys());
  fem::Material& material = robot->material;
  std::string model;
  map.Read("model", &model);
  fem::ParseMaterialModel(model, &material.model);
  map.Read("youngs_modulus_Pa", &material.youngs_modulus_Pa);
  material.poissons_ratio = ReadPoissonsRatio(map.Require("poissons_ratio"));
  material.volumetric = ReadVolumetric(&map, robot->element, material);
  ReadYeohRatios(&map, &material);
  if (const ConfigNode* terms = map.Optional("creep")) {
    for (const ConfigNode& item : Items(*terms, "creep terms"))
      robot->creep.push_back(ReadCreep(item));
  }
  if (const ConfigNode* law = map.Optional("softening")) robot->softening = ReadSoftening(*law);
  map.Finish();
}

MassSettings ReadMass(const ConfigNode& node) {
  MapReader map(node, MassKeys());
  MassSettings mass;
  const ConfigNode* total = map.Optional("total_kg");
  const ConfigNode* density = map.Optional("density_kg_m3");
  if (total != nullptr && density != nullptr) {
    Refuse(*density, "total_kg is given too: give one of them");
  }
  std::string distribution;
  map.Read("distribution", &distribution);
  if (distribution == "per_node") mass.distribution = MassDistribution::kPerNode;
  map.Finish();
  if (total == nullptr && density == nullptr) Refuse(node, "needs total_kg or density_kg_m3");
  map.Read("total_kg", &mass.total_kg);
  map.Read("density_kg_m3", &mass.density_kg_m3);
  return mass;
}

void ReadFixed(const ConfigNode& node, RobotDescription* robot) {
  for (const ConfigNode& item : Items(node, "boxes")) {
    MapReader map(item, FixedKeys());
    const ConfigNode& box = map.Require("box_m");
    map.Finish();
    robot->fixed.push_back(ReadBox(box));
    robot->fixed_where.push_back(box.where);
  }
  if (robot->fixed.empty())
    Refuse(node, "a body that nothing holds has no equilibrium: give a box");
}

/// A polyline none of whose pieces has no length.
Eigen::Matrix3Xd ReadPolyline(const ConfigNode& node, const std::string& needs) {
  const Eigen::Matrix3Xd path_m = ReadPoints(node);
  if (path_m.cols() < 2) Refuse(node, needs + ", not " + std::to_string(path_m.cols()));
  for (Eigen::Index k = 1; k < path_m.cols(); ++k) {
    if (path_m.col(k) == path_m.col(k - 1)) {
      Refuse(node.items[At(k)], "is the same point as the one before it");
    }
  }
  return path_m;
}

CableSettings ReadCable(const ConfigNode& node, std::set<std::string>* names) {
  MapReader map(node, CableKeys());
  CableSettings cable;
  cable.where = node.where;
  cable.name = ReadUniqueName(map.Require("name"), names);
  cable.path_m = ReadPolyline(map.Require("path_m"),
                              "a cable needs at least 2 points (where it is pulled from, and "
                              "points on the body)");
  map.Read("max_tension_N", &cable.max_tension_N);
  map.Read("guide_radius_m", &cable.guide_radius_m);
  map.Read("friction_coefficient", &cable.friction_coefficient);
  map.Read("play_m", &cable.play_m);
  map.Finish();
  return cable;
}

ChamberSurface ReadChamberSurface(const ConfigNode& node) {
  MapReader map(node, ChamberSurfaceKeys());
  ChamberSurface surface;
  map.Read("inner_skin", &surface.inner_skin);
  map.Read("physical_group", &surface.physical_group);
  map.Read("file", &surface.file);
  map.Finish();
  const int given = (surface.inner_skin > 0 ? 1 : 0) + (surface.physical_group.empty() ? 0 : 1) +
                    (surface.file.empty() ? 0 : 1);
  if (given != 1) Refuse(node, "needs one of inner_skin, physical_group and file");
  return surface;
}

ChamberSettings ReadChamber(const ConfigNode& node, std::set<std::string>* names) {
  MapReader map(node, ChamberKeys());
  ChamberSettings chamber;
  chamber.where = node.where;
  chamber.name = ReadUniqueName(map.Require("name"), names);
  const ConfigNode& surface = map.Require("surface");
  chamber.surface = ReadChamberSurface(surface);
  chamber.surface_where = surface.where;
  map.Read("dead_volume_m3", &chamber.dead_volume_m3);
  map.Read("max_pressure_Pa", &chamber.max_pressure_Pa);
  map.Finish();
  return chamber;
}

Winding ReadWinding(const ConfigNode& node, Winding::Kind kind) {
  const bool is_helix = kind == Winding::Kind::kHelix;
  MapReader map(node, is_helix ? HelixKeys() : RingKeys());
  Winding winding;
  winding.kind = kind;
  const ConfigNode& axis = map.Require("axis_m");
  const Eigen::Matrix3Xd ends_m = ReadPolyline(axis, "an axis needs 2 points");
  if (ends_m.cols() != 2) Refuse(axis, "an axis needs 2 points, not more");
  winding.axis_m = ends_m;
  const double length_m = (ends_m.col(1) - ends_m.col(0)).norm();
  map.Read("radius_m", &winding.radius_m);
  const ConfigNode* spacing = map.Optional(is_helix ? "pitch_m" : "spacing_m");
  const ConfigNode* number = map.Optional(is_helix ? "turns" : "count");
  if ((spacing != nullptr) == (number != nullptr)) {
    Refuse(node, is_helix ? "needs either pitch_m or turns" : "needs either spacing_m or count");
  }
  map.Read(is_helix ? "pitch_m" : "spacing_m", &winding.spacing_m);
  if (number != nullptr && is_helix) {
    double turns = 0.0;
    map.Read("turns", &turns);
    winding.spacing_m = length_m / turns;
  } else if (number != nullptr) {
    int count = 0;
    map.Read("count", &count);
    winding.spacing_m = count > 1 ? length_m / (count - 1) : 2.0 * length_m;
  }
  if (is_helix) {
    std::string hand;
    map.Read("hand", &hand);
    winding.left_handed = hand == "left";
  }
  map.Finish();
  if (length_m > kMaxRings * winding.spacing_m) {
    Refuse(spacing != nullptr ? *spacing : *number,
           "would make more than " + std::to_string(kMaxRings) + " turns; is it in metres?");
  }
  return winding;
}

FibreSettings ReadFibre(const ConfigNode& node, std::set<std::string>* names) {
  MapReader map(node, FibreKeys());
  FibreSettings fibre;
  fibre.name = ReadUniqueName(map.Require("name"), names);
  const ConfigNode* path = map.Optional("path_m");
  const ConfigNode* helix = map.Optional("helix");
  const ConfigNode* rings = map.Optional("rings");
  map.Read("axial_stiffness_N", &fibre.axial_stiffness_N);
  map.Finish();
  const int given = (path != nullptr) + (helix != nullptr) + (rings != nullptr);
  if (given != 1) Refuse(node, "needs one of path_m, helix and rings");
  if (path != nullptr) fibre.path_m = ReadPolyline(*path, "a fibre needs at least 2 points");
  if (helix != nullptr) fibre.winding = ReadWinding(*helix, Winding::Kind::kHelix);
  if (rings != nullptr) fibre.winding = ReadWinding(*rings, Winding::Kind::kRings);
  fibre.where = path != nullptr ? path->where : helix != nullptr ? helix->where : rings->where;
  return fibre;
}

RegionSettings ReadRegion(const ConfigNode& node, std::set<std::string>* names) {
  MapReader map(node, RegionKeys());
  RegionSettings region;
  region.where = node.where;
  region.name = ReadUniqueName(map.Require("name"), names);
  const ConfigNode* box = map.Optional("box_m");
  const ConfigNode* group = map.Optional("mesh_group");
  map.Read("mesh_group", &region.mesh_group);
  map.Read("youngs_modulus_Pa", &region.youngs_modulus_Pa);
  map.Finish();
  if ((box != nullptr) == (group != nullptr)) {
    Refuse(node, "needs either box_m, or mesh_group for a group of elements of the mesh file");
  }
  if (box != nullptr) region.box = ReadBox(*box);
  if (group != nullptr) region.where = group->where;
  return region;
}

MarkerSettings ReadMarker(const ConfigNode& node, std::set<std::string>* names) {
  MapReader map(node, MarkerKeys());
  MarkerSettings marker;
  marker.where = node.where;
  marker.name = ReadUniqueName(map.Require("name"), names);
  map.Read("position_m", &marker.position_m);
  map.Finish();
  return marker;
}

void RequireRegion(const ConfigNode& node, const RobotDescription& robot) {
  std::vector<std::string> known;
  for (const RegionSettings& region : robot.regions) known.push_back(region.name);
  if (std::find(known.begin(), known.end(), robot.feature_point_region) != known.end()) return;
  Refuse(node, "there is no region '" + robot.feature_point_region + "'" +
                   DidYouMean(robot.feature_point_region, known) +
                   (known.empty() ? "; the robot file has none" : "; there is " + Listed(known)));
}

void ReadFeaturePoints(const ConfigNode& node, RobotDescription* robot) {
  robot->feature_points_where = node.where;
  const ConfigNode* positions = &node;
  if (node.kind == ConfigNode::Kind::kMap) {
    MapReader map(node, FeaturePointKeys());
    const ConfigNode* count = map.Optional("count");
    positions = map.Optional("positions_m");
    const ConfigNode* region = map.Optional("region");
    map.Read("region", &robot->feature_point_region);
    map.Finish();
    if (count != nullptr && positions != nullptr) {
      Refuse(node, "needs either count or positions_m");
    }
    if (positions != nullptr && region != nullptr) {
      Refuse(*region, "restricts points that are spread; leave it out beside positions_m");
    }
    if (count == nullptr && positions == nullptr && region == nullptr) {
      Refuse(node, "needs count, positions_m or region");
    }
    if (region != nullptr) RequireRegion(*region, *robot);
    if (count != nullptr) map.Read("count", &robot->feature_point_count);
  }
  if (positions == nullptr) return;
  robot->feature_points_m = ReadPoints(*positions);
  if (robot->feature_points_m.cols() == 0) Refuse(*positions, "needs at least one point");
  robot->feature_point_count = static_cast<int>(robot->feature_points_m.cols());
}

/// Reads every item of an optional list by `read_item(item, names seen so far)`; none has one of
/// `names`.
template <typename Item, typename ReadItem>
std::vector<Item> ReadList(MapReader* map, const std::string& key, ReadItem read_item,
                           std::set<std::string> names = {}) {
  std::vector<Item> list;
  const ConfigNode* node = map->Optional(key);
  if (node == nullptr) return list;
  for (const ConfigNode& item : Items(*node, key)) list.push_back(read_item(item, &names));
  return list;
}

}  // namespace

RobotDescription ReadRobotFile(const std::filesystem::path& file, const ConfigLoader& load) {
  const ConfigNode root = load(file);
  MapReader map(root, RobotFileKeys());
  RobotDescription robot;
  robot.file = file;
  robot.name = ReadName(map.Require("name"));
  robot.mesh = ReadMeshSettings(map.Require("mesh"));
  std::string element;
  map.Read("element", &element);
  if (element == "tet4") robot.element = fem::ElementType::kTet4;
  ReadMaterial(map.Require("material"), &robot);
  robot.mass = ReadMass(map.Require("mass"));
  map.Read("gravity_m_s2", &robot.gravity_m_s2);
  ReadFixed(map.Require("fixed"), &robot);
  robot.cables = ReadList<CableSettings>(&map, "cables", ReadCable);
  std::set<std::string> cable_names;
  for (const CableSettings& cable : robot.cables) cable_names.insert(cable.name);
  robot.chambers = ReadList<ChamberSettings>(&map, "chambers", ReadChamber, cable_names);
  robot.fibres = ReadList<FibreSettings>(&map, "fibres", ReadFibre);
  robot.regions = ReadList<RegionSettings>(&map, "regions", ReadRegion);
  robot.markers = ReadList<MarkerSettings>(&map, "markers", ReadMarker);
  if (const ConfigNode* points = map.Optional("feature_points")) ReadFeaturePoints(*points, &robot);
  map.Finish();
  return robot;
}

}  // namespace palpate::robot

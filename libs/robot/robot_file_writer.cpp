// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <string>

#include "libs/core/check.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/robot/robot_description.hpp"

namespace palpate::robot {

namespace {

std::string Point(const Eigen::Vector3d& point) {
  return "[" + FormatNumber(point.x()) + ", " + FormatNumber(point.y()) + ", " +
         FormatNumber(point.z()) + "]";
}

std::string Points(const Eigen::Matrix3Xd& points) {
  std::string text;
  for (const auto& point : points.colwise()) text += (text.empty() ? "" : ", ") + Point(point);
  return "[" + text + "]";
}

std::string BoxText(const Box& box) {
  return "box_m: [" + Point(box.lower_m) + ", " + Point(box.upper_m) + "]";
}

std::string UnitOf(double metres_per_unit) {
  if (metres_per_unit == 1.0) return "m";
  if (metres_per_unit == 1e-2) return "cm";
  PALPATE_CHECK(metres_per_unit == 1e-3, metres_per_unit);
  return "mm";
}

std::string PathText(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const std::filesystem::path base = folder.empty() ? "." : folder;
  return Quoted(std::filesystem::absolute(file)
                    .lexically_normal()
                    .lexically_proximate(std::filesystem::absolute(base).lexically_normal())
                    .generic_string());
}

std::string MeshText(const MeshSettings& mesh, const std::filesystem::path& folder) {
  return "mesh:\n  file: " + PathText(mesh.file, folder) +
         "\n  unit: " + UnitOf(mesh.metres_per_unit) +
         "\n  rotate_xyz_deg: " + Point(mesh.rotate_xyz_deg) +
         "\n  translate_m: " + Point(mesh.translate_m) + "\n";
}

std::string MaterialText(const RobotDescription& robot) {
  const fem::Material& material = robot.material;
  std::string text = "material:\n  model: " + std::string(fem::ToString(material.model)) +
                     "\n  youngs_modulus_Pa: " + FormatNumber(material.youngs_modulus_Pa) +
                     "\n  poissons_ratio: " + FormatNumber(material.poissons_ratio) +
                     "\n  volumetric: " + std::string(fem::ToString(material.volumetric)) + "\n";
  if (material.model == fem::MaterialModel::kYeoh) {
    text += "  c20_over_c10: " + FormatNumber(material.c20_over_c10) +
            "\n  c30_over_c10: " + FormatNumber(material.c30_over_c10) + "\n";
  }
  if (!robot.creep.empty()) text += "  creep:\n";
  for (const fem::PronyTerm& term : robot.creep) {
    text +=
        "    - {share: " + FormatNumber(term.g) + ", time_s: " + FormatNumber(term.tau_s) + "}\n";
  }
  if (robot.softening) {
    text += "  softening: {r: " + FormatNumber(robot.softening->r) +
            ", m_J_m3: " + FormatNumber(robot.softening->m_J_m3) + "}\n";
  }
  return text;
}

std::string MassText(const MassSettings& mass) {
  PALPATE_CHECK(mass.total_kg.has_value() != mass.density_kg_m3.has_value());
  const std::string amount = mass.total_kg ? "total_kg: " + FormatNumber(*mass.total_kg)
                                           : "density_kg_m3: " + FormatNumber(*mass.density_kg_m3);
  const bool per_node = mass.distribution == MassDistribution::kPerNode;
  return "mass: {" + amount + ", distribution: " + (per_node ? "per_node" : "volume") + "}\n";
}

std::string CableText(const CableSettings& cable) {
  std::string text = "  - name: " + Quoted(cable.name) + "\n    path_m: " + Points(cable.path_m) +
                     "\n    max_tension_N: " + FormatNumber(cable.max_tension_N) +
                     "\n    guide_radius_m: " + FormatNumber(cable.guide_radius_m) + "\n";
  if (cable.friction_coefficient > 0.0) {
    text += "    friction_coefficient: " + FormatNumber(cable.friction_coefficient) + "\n";
  }
  if (cable.play_m > 0.0) text += "    play_m: " + FormatNumber(cable.play_m) + "\n";
  return text;
}

std::string ChamberText(const ChamberSettings& chamber, const std::filesystem::path& folder) {
  const ChamberSurface& surface = chamber.surface;
  std::string wall = "inner_skin: " + std::to_string(surface.inner_skin);
  if (!surface.physical_group.empty()) wall = "physical_group: " + Quoted(surface.physical_group);
  if (!surface.file.empty()) wall = "file: " + PathText(surface.file, folder);
  return "  - name: " + Quoted(chamber.name) + "\n    surface: {" + wall +
         "}\n    dead_volume_m3: " + FormatNumber(chamber.dead_volume_m3) +
         "\n    max_pressure_Pa: " + FormatNumber(chamber.max_pressure_Pa) + "\n";
}

std::string FibreText(const FibreSettings& fibre) {
  std::string text = "  - name: " + Quoted(fibre.name) + "\n";
  if (const auto& winding = fibre.winding) {
    const bool is_helix = winding->kind == Winding::Kind::kHelix;
    text += std::string("    ") + (is_helix ? "helix" : "rings") +
            ": {axis_m: " + Points(winding->axis_m) +
            ", radius_m: " + FormatNumber(winding->radius_m) +
            (is_helix ? ", pitch_m: " : ", spacing_m: ") + FormatNumber(winding->spacing_m) +
            (winding->left_handed ? ", hand: left}\n" : "}\n");
  } else {
    text += "    path_m: " + Points(fibre.path_m) + "\n";
  }
  if (fibre.axial_stiffness_N) {
    text += "    axial_stiffness_N: " + FormatNumber(*fibre.axial_stiffness_N) + "\n";
  }
  return text;
}

std::string RegionText(const RegionSettings& region) {
  std::string text = "  - {name: " + Quoted(region.name) + ", " +
                     (region.mesh_group.empty() ? BoxText(region.box)
                                                : "mesh_group: " + Quoted(region.mesh_group));
  if (region.youngs_modulus_Pa) {
    text += ", youngs_modulus_Pa: " + FormatNumber(*region.youngs_modulus_Pa);
  }
  return text + "}\n";
}

std::string FeaturePointsText(const RobotDescription& robot) {
  if (robot.feature_points_m.cols() > 0) {
    return "feature_points: {positions_m: " + Points(robot.feature_points_m) + "}\n";
  }
  const std::string region =
      robot.feature_point_region.empty() ? "" : ", region: " + Quoted(robot.feature_point_region);
  return "feature_points: {count: " + std::to_string(robot.feature_point_count) + region + "}\n";
}

}  // namespace

std::string FormatRobotFile(const RobotDescription& robot, const std::filesystem::path& folder) {
  std::string text = "name: " + Quoted(robot.name) + "\n" + MeshText(robot.mesh, folder);
  text += robot.element == fem::ElementType::kTet4 ? "element: tet4\n" : "element: tet10\n";
  text += MaterialText(robot) + MassText(robot.mass);
  text += "gravity_m_s2: " + Point(robot.gravity_m_s2) + "\nfixed:\n";
  for (const Box& box : robot.fixed) text += "  - {" + BoxText(box) + "}\n";
  if (!robot.cables.empty()) text += "cables:\n";
  for (const CableSettings& cable : robot.cables) text += CableText(cable);
  if (!robot.chambers.empty()) text += "chambers:\n";
  for (const ChamberSettings& chamber : robot.chambers) text += ChamberText(chamber, folder);
  if (!robot.fibres.empty()) text += "fibres:\n";
  for (const FibreSettings& fibre : robot.fibres) text += FibreText(fibre);
  if (!robot.regions.empty()) text += "regions:\n";
  for (const RegionSettings& region : robot.regions) text += RegionText(region);
  if (!robot.markers.empty()) text += "markers:\n";
  for (const MarkerSettings& marker : robot.markers) {
    text +=
        "  - {name: " + Quoted(marker.name) + ", position_m: " + Point(marker.position_m) + "}\n";
  }
  return text + FeaturePointsText(robot);
}

void WriteRobotFile(const RobotDescription& robot, const std::filesystem::path& file) {
  WriteFile(file, FormatRobotFile(robot, file.parent_path()));
}

}  // namespace palpate::robot

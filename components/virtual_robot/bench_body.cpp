// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/virtual_robot/bench_body.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "components/virtual_robot/material_effects.hpp"
#include "components/virtual_robot/rest_shape.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/embedding.hpp"
#include "libs/fem/kernels/kernel.hpp"
#include "libs/fem/refined_mesh.hpp"
#include "libs/fem/shape_functions.hpp"
#include "libs/geometry/box.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/robot/body_mesh.hpp"
#include "libs/robot/chamber_wall.hpp"

namespace palpate::virtual_robot {

namespace {

constexpr int kMostRefinements = 2;

fem::ElementType ElementNamed(const std::string& name) {
  if (name == "tet4") return fem::ElementType::kTet4;
  if (name == "tet10") return fem::ElementType::kTet10;
  throw InputError("body.element '" + name + "': tet4 or tet10 is expected");
}

void CheckMaterial(const fem::Material& material) {
  if (material.model == fem::MaterialModel::kLinear) {
    throw InputError("the virtual robot turns and bends: material linear is not for it");
  }
  if (!(material.poissons_ratio >= 0.0 &&
        material.poissons_ratio <= robot::kLargestPoissonsRatio)) {
    throw InputError("the virtual robot's Poisson's ratio " +
                     FormatNumber(material.poissons_ratio) + " is not within 0 to " +
                     FormatNumber(robot::kLargestPoissonsRatio));
  }
  if (!(material.youngs_modulus_Pa > 0.0)) {
    throw InputError("the virtual robot's Young's modulus must be greater than 0");
  }
  if (material.model == fem::MaterialModel::kYeoh &&
      !fem::IsYeohMonotone(material.c20_over_c10, material.c30_over_c10)) {
    throw InputError("the virtual robot's Yeoh material softens to nothing when it is stretched");
  }
}

/// Averaged where the element would lock, as robot files do.
void ChooseVolumetric(fem::ElementType element, fem::Material* material) {
  const bool averaged = element == fem::ElementType::kTet10 &&
                        material->poissons_ratio >= robot::kNearlyIncompressible &&
                        fem::kernels::SupportsMeanDilatation(material->model);
  material->volumetric = averaged ? fem::Volumetric::kMeanDilatation : fem::Volumetric::kPointwise;
}

/// What the scenario writes over the robot file.
robot::RobotDescription WithTruth(robot::RobotDescription robot, const scenario::BodyTruth& truth) {
  if (!truth.mesh_file.empty()) robot.mesh.file = truth.mesh_file;
  if (!truth.element.empty()) robot.element = ElementNamed(truth.element);
  fem::Material& material = robot.material;
  if (!truth.material_model.empty()) {
    if (!fem::ParseMaterialModel(truth.material_model, &material.model)) {
      throw InputError("body.material_model '" + truth.material_model + "' is not known" +
                       DidYouMean(truth.material_model, fem::MaterialModelNames()));
    }
    material.c20_over_c10 = 0.0;
    material.c30_over_c10 = 0.0;
  }
  if (material.model == fem::MaterialModel::kYeoh && truth.c20_over_c10 != 0.0) {
    material.c20_over_c10 = truth.c20_over_c10;
  }
  if (material.model == fem::MaterialModel::kYeoh && truth.c30_over_c10 != 0.0) {
    material.c30_over_c10 = truth.c30_over_c10;
  }
  if (truth.youngs_modulus_Pa) {
    const double ratio = *truth.youngs_modulus_Pa / material.youngs_modulus_Pa;
    material.youngs_modulus_Pa = *truth.youngs_modulus_Pa;
    for (robot::RegionSettings& region : robot.regions) {
      if (region.youngs_modulus_Pa) *region.youngs_modulus_Pa *= ratio;
    }
  }
  if (truth.poissons_ratio) material.poissons_ratio = *truth.poissons_ratio;
  CheckMaterial(material);
  ChooseVolumetric(robot.element, &material);
  return robot;
}

/// The corners of the cells as a mesh of its own; nodes that none of them names are left out.
fem::TetMesh Corners(const fem::TetMesh& mesh) {
  std::vector<int> new_number(static_cast<size_t>(mesh.NodeCount()), -1);
  fem::TetMesh corners{.nodes_m = mesh.nodes_m, .cells = mesh.cells.topRows<4>(), .groups = {}};
  Eigen::Index count = 0;
  for (int& node : corners.cells.reshaped()) {
    int& number = new_number[At(node)];
    if (number < 0) {
      number = static_cast<int>(count);
      corners.nodes_m.col(count++) = mesh.nodes_m.col(node);
    }
    node = number;
  }
  corners.nodes_m.conservativeResize(3, count);
  return corners;
}

/// The wall on a finer mesh: faces of its boundary that lie on the wall. The triangles of a surface
/// file stay as they are.
fem::MovingSurface FinerWall(const fem::MovingSurface& wall, const fem::TetMesh& coarse,
                             const fem::PointLocator& locator) {
  const Eigen::VectorXd rest_m = coarse.nodes_m.reshaped();
  const bool is_of_mesh =
      std::all_of(wall.points.begin(), wall.points.end(),
                  [](const fem::InterpolationWeights& point) { return point.nodes.size() == 1; });
  if (!is_of_mesh) {
    fem::MovingSurface moved = wall;
    for (fem::InterpolationWeights& point : moved.points) {
      point = locator.Embed(point.Position(rest_m)).weights;
    }
    return moved;
  }
  geometry::TriangleSurface flat{Eigen::Matrix3Xd(3, std::ssize(wall.points)),
                                 wall.faces.topRows<3>()};
  for (std::size_t p = 0; p < wall.points.size(); ++p) {
    flat.vertices_m.col(ToIndex(p)) = wall.points[p].Position(rest_m);
  }
  const geometry::SurfaceIndex index(flat);
  const double same_m = 1e-9 * geometry::BoundingBox(coarse.nodes_m).Diagonal_m();
  const Eigen::MatrixXi& all = locator.boundary().faces;
  std::vector<int> faces;
  for (int face = 0; face < all.cols(); ++face) {
    Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) middle_m += locator.mesh().nodes_m.col(all(k, face)) / 3.0;
    if (index.Closest(middle_m).distance_m < same_m) faces.push_back(face);
  }
  return robot::WallOfFaces(locator.boundary(), faces);
}

/// Cuts the cells, and puts cables, markers and supports on the finer mesh.
void Refine(const robot::RobotDescription& robot, int times, robot::RobotBody* body) {
  fem::TetMesh mesh = Corners(body->mesh);
  for (int k = 0; k < times; ++k) {
    mesh = fem::RefineUniformly(mesh);
    std::vector<int> material_of_part;
    for (const int material : body->material_of_cell) {
      material_of_part.insert(material_of_part.end(), 8, material);
    }
    body->material_of_cell = std::move(material_of_part);
  }
  if (robot.element == fem::ElementType::kTet10) mesh = fem::MakeQuadratic(mesh);
  std::vector<bool> all_used(static_cast<size_t>(mesh.NodeCount()), true);
  body->fixed =
      robot::HoldNodes(robot, {mesh, body->mesh_hash, std::move(all_used), {}}, &body->notes);
  const fem::PointLocator locator(mesh);
  for (size_t c = 0; c < body->cables.size(); ++c) {
    const robot::CableSettings& settings = robot.cables[c];
    for (size_t e = 0; e < body->cables[c].eyelets.size(); ++e) {
      body->cables[c].eyelets[e] =
          locator.EmbedBall(settings.path_m.col(ToIndex(e) + 1), settings.guide_radius_m);
    }
  }
  for (robot::BodyMarker& marker : body->markers) {
    marker.point = locator.Embed(marker.point.rest_m);
  }
  for (robot::BodyChamber& chamber : body->chambers) {
    chamber.wall = FinerWall(chamber.wall, body->mesh, locator);
  }
  for (robot::BodyFibre& fibre : body->fibres) {
    fem::EmbeddedFibre finer{.points = {}, .axial_stiffness_N = fibre.embedded.axial_stiffness_N};
    for (const Eigen::Matrix3Xd& path_m : fibre.paths_m) fem::AddPolyline(locator, path_m, &finer);
    fibre.embedded = std::move(finer);
  }
  body->boundary = locator.boundary();
  body->mesh = std::move(mesh);
}

double Density_kg_m3(const robot::MassSettings& mass, const fem::TetMesh& mesh) {
  if (mass.density_kg_m3) return *mass.density_kg_m3;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(mesh.CellCount());
  return mass.total_kg.value() / fem::ConsistentNodalMass_kg(mesh, ones).sum();
}

void CheckTruth(const scenario::BodyTruth& truth) {
  if (truth.refine < 0 || truth.refine > kMostRefinements) {
    throw InputError("body.refine " + std::to_string(truth.refine) + " is not within 0 to " +
                     std::to_string(kMostRefinements));
  }
  for (const scenario::PronyTerm& term : truth.prony) {
    if (!(term.g > 0.0) || !(term.tau_s > 0.0)) {
      throw InputError("body.prony: g and tau_s must be greater than 0");
    }
  }
}

}  // namespace

std::vector<std::string> BenchBody::CableNames() const {
  std::vector<std::string> names;
  for (const robot::BodyCable& cable : cables) names.push_back(cable.name);
  return names;
}

std::vector<std::string> BenchBody::MarkerNames() const {
  std::vector<std::string> names;
  for (const robot::BodyMarker& marker : markers) names.push_back(marker.name);
  return names;
}

BenchBody MakeBenchBody(const robot::RobotDescription& robot, const scenario::BodyTruth& truth,
                        const Effects& effects) {
  CheckTruth(truth);
  const robot::RobotDescription changed = WithTruth(robot, truth);
  robot::RobotBody made = robot::BuildRobotBody(changed);
  if (truth.refine > 0) Refine(changed, truth.refine, &made);
  BenchBody body;
  body.density_kg_m3 = Density_kg_m3(changed.mass, made.mesh);
  body.nominal = std::move(made.mesh);
  body.mesh = body.nominal;
  body.boundary = std::move(made.boundary);
  body.materials = std::move(made.materials);
  body.material_of_cell = std::move(made.material_of_cell);
  body.region_names = std::move(made.region_names);
  body.prony = truth.prony.empty() ? made.creep : truth.prony;
  body.softening = made.softening;
  body.fixed = std::move(made.fixed);
  body.gravity_m_s2 = made.gravity_m_s2;
  body.cables = std::move(made.cables);
  body.chambers = std::move(made.chambers);
  body.fibres = std::move(made.fibres);
  body.markers = std::move(made.markers);
  ApplyMaterialEffects(effects, &body);
  for (fem::Material& material : body.materials) {
    CheckMaterial(material);
    ChooseVolumetric(changed.element, &material);
  }
  ApplyRestShapeEffects(effects, &body);
  body.mesh_hash = robot::HashMesh(body.mesh, changed.element);
  return body;
}

}  // namespace palpate::virtual_robot

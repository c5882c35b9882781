// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/robot/robot_file_keys.hpp"

#include "libs/robot/robot_description.hpp"

namespace palpate::robot {

namespace {

constexpr NumberRule kAboveOne{.min = 1.0, .min_open = true};

}  // namespace

const KeyTable& MeshKeys() {
  static const KeyTable keys{
      .title = "mesh",
      .about = "The tetrahedral mesh of the undeformed body, and its place in the robot frame.",
      .keys = {{"file", value::File(), kRequired,
                "Mesh: `.msh`, `.vtk`, `.vtu`, `.inp` or `.mesh`; 4-node or 10-node tetrahedra."},
               {"unit", value::Choice({"m", "cm", "mm"}), kRequired,
                "Unit of the coordinates in the mesh file."},
               {"rotate_xyz_deg", value::Vector3(), Default(MeshSettings{}.rotate_xyz_deg),
                "Rotation about the fixed x axis, then y, then z."},
               {"translate_m", value::Vector3(), Default(MeshSettings{}.translate_m),
                "Translation after the rotation."},
               {"translate_mm", value::Vector3(), kOptional, "The same in millimetres."}},
      .at_most_one = {{"translate_m", "translate_mm"}}};
  return keys;
}

const KeyTable& CreepKeys() {
  static const KeyTable keys{
      .title = "creep term",
      .about =
          "One Prony term: at once the body is stiffer by `share`, which relaxes with `time_s`.",
      .keys = {{"share", value::Real(kPositive), kRequired,
                "By which the instantaneous modulus is larger, as a share of "
                "`youngs_modulus_Pa`."},
               {"time_s", value::Real(kPositive), kRequired, "Relaxation time."}}};
  return keys;
}

const KeyTable& SofteningKeys() {
  static const KeyTable keys{
      .title = "softening",
      .about =
          "Mullins effect (Ogden and Roxburgh). Moduli of an element are times 1 - erf((W_max - W) "
          "/ "
          "`m_J_m3`) / `r`. W is its energy density, W_max the largest so far.",
      .keys = {
          {"r", value::Real(kAboveOne), kRequired, "The modulus falls by up to the share 1 / `r`."},
          {"m_J_m3", value::Real(kPositive), kRequired,
           "Energy density below the largest at which most of it has softened."}}};
  return keys;
}

const KeyTable& MaterialKeys() {
  const Presence yeoh = RequiredFor("`model: yeoh`");
  static const KeyTable keys{
      .title = "material",
      .about = "Elasticity of the body. Regions may have a Young's modulus of their own.",
      .keys = {{"model", value::Choice(fem::MaterialModelNames()), kRequired,
                "Constitutive law, see the table of material models."},
               {"youngs_modulus_Pa", value::Real(kPositive), kRequired,
                "Young's modulus at small strain."},
               {"poissons_ratio", value::Real(kPoissonsRatio), kRequired,
                "Poisson's ratio. Give 0.4999 for an incompressible body."},
               {"volumetric", value::Choice({"pointwise", "mean_dilatation"}), kOptional,
                "Volume change in an element. `mean_dilatation` averages it over the element, "
                "against locking. Absent: `mean_dilatation` for `tet10` from a Poisson's "
                "ratio of 0.48 on where the model has it, else `pointwise`."},
               {"c20_over_c10", value::Real(), yeoh, "Ratio of Yeoh's constants C20 and C10."},
               {"c30_over_c10", value::Real(kNonNegative), yeoh,
                "Ratio of Yeoh's constants C30 and C10. It must exceed a third of the square of a "
                "negative `c20_over_c10`."},
               {"creep", value::ListOfMaps(CreepKeys()), kOptional,
                "Creep of body and regions, followed from frame to frame. Absent: none."},
               {"softening", value::Map(SofteningKeys()), kOptional,
                "Softening by strain of body and regions, followed from frame to frame. Absent: "
                "none."}}};
  return keys;
}

const KeyTable& MassKeys() {
  static const KeyTable keys{
      .title = "mass",
      .about = "The mass of the body, on which gravity acts.",
      .keys = {{"total_kg", value::Real(kPositive), kOptional, "Mass of the whole body."},
               {"density_kg_m3", value::Real(kPositive), kOptional, "Density of the body."},
               {"distribution", value::Choice({"volume", "per_node"}), Default("volume"),
                "`volume`: in proportion to the volume of the elements. `per_node`: every node of "
                "the mesh has the same mass."}},
      .exactly_one = {{"total_kg", "density_kg_m3"}}};
  return keys;
}

const KeyTable& FixedKeys() {
  static const KeyTable keys{
      .title = "fixed region",
      .about = "Nodes that do not move: all that lie in the box, bounds included.",
      .keys = {{"box_m", value::Points(2, 2), kRequired,
                "Lower and upper corner `[[x, y, z], [x, y, z]]`, robot frame. At least one node "
                "must lie in it."}}};
  return keys;
}

const KeyTable& CableKeys() {
  static const KeyTable keys{
      .title = "cable",
      .about = "A cable that an actuator pulls in. It slides through eyelets on the body.",
      .keys = {
          {"name", value::Text(), kRequired,
           "Unique name, as in `actuation.csv`. No commas, semicolons, quotes or blanks at the "
           "ends."},
          {"path_m", value::Points(2), kRequired,
           "Route at rest, robot frame. First point: where the cable is pulled from, fixed to the "
           "ground. Others: eyelets on the body. The cable is attached to the last one."},
          {"max_tension_N", value::Real(kPositive), Default(CableSettings{}.max_tension_N),
           "Largest tension of the actuator."},
          {"guide_radius_m", value::Real(kNonNegative), Default(CableSettings{}.guide_radius_m),
           "Radius over which the force of an eyelet is spread. 0: the point alone."},
          {"friction_coefficient", value::Real(kNonNegative),
           Default(CableSettings{}.friction_coefficient),
           "Coulomb friction of the cable in its eyelets. Force estimation follows where it sticks "
           "or slides; elsewhere the actuator pulls the cable in."},
          {"play_m", value::Real(kNonNegative), Default(CableSettings{}.play_m),
           "Play (backlash) of the actuator, full width; it begins in its middle. Force estimation "
           "follows it."}}};
  return keys;
}

const KeyTable& ChamberSurfaceKeys() {
  static const KeyTable keys{
      .title = "chamber surface",
      .about = "The wall of a chamber, a closed surface.",
      .keys = {{"inner_skin", value::WholeNumber(1, kMaxInnerSkin), kOptional,
                "The n-th closed inner surface of the mesh, in the order of its elements. "
                "`palpate info ROBOT` lists them."},
               {"physical_group", value::Text(), kOptional,
                "Name of a group of triangles in the mesh file (a physical surface of Gmsh)."},
               {"file", value::File(), kOptional,
                "Closed surface as `.stl`, in the unit of the mesh, and placed as the mesh is. Its "
                "vertices lie on the wall."}},
      .exactly_one = {{"inner_skin", "physical_group", "file"}}};
  return keys;
}

const KeyTable& ChamberKeys() {
  static const KeyTable keys{
      .title = "chamber",
      .about = "A closed chamber in the body that a pump or a valve fills.",
      .keys = {
          {"name", value::Text(), kRequired,
           "Unique name, as in `actuation.csv`; no cable has it. No commas, semicolons, "
           "quotes or blanks at the ends."},
          {"surface", value::Map(ChamberSurfaceKeys()), kRequired, "Its wall."},
          {"dead_volume_m3", value::Real(kNonNegative), Default(ChamberSettings{}.dead_volume_m3),
           "Volume between chamber and valve: of the tube."},
          {"max_pressure_Pa", value::Real(kPositive), Default(ChamberSettings{}.max_pressure_Pa),
           "Largest pressure of the supply, above ambient."}}};
  return keys;
}

const KeyTable& HelixKeys() {
  static const KeyTable keys{
      .title = "helix",
      .about = "A thread wound round an axis.",
      .keys = {{"axis_m", value::Points(2, 2), kRequired,
                "Where the winding begins and ends on its axis, robot frame."},
               {"radius_m", value::Real(kPositive), kRequired, "Radius of the winding."},
               {"pitch_m", value::Real(kPositive), kOptional,
                "How far the thread gets along the axis in one turn."},
               {"turns", value::Real(kPositive), kOptional, "Number of turns from end to end."},
               {"hand", value::Choice({"right", "left"}), Default("right"),
                "Right: it turns as a usual screw. Two helices of either hand are a braid."}},
      .exactly_one = {{"pitch_m", "turns"}}};
  return keys;
}

const KeyTable& RingKeys() {
  static const KeyTable keys{
      .title = "rings",
      .about = "Closed rings round an axis.",
      .keys = {{"axis_m", value::Points(2, 2), kRequired,
                "The first ring is at the first point, robot frame. The last is at the second "
                "point or before it."},
               {"radius_m", value::Real(kPositive), kRequired, "Radius of the rings."},
               {"spacing_m", value::Real(kPositive), kOptional, "Distance from ring to ring."},
               {"count", value::WholeNumber(1, kMaxRings), kOptional,
                "Number of rings, evenly from end to end."}},
      .exactly_one = {{"spacing_m", "count"}}};
  return keys;
}

const KeyTable& FibreKeys() {
  static const KeyTable keys{
      .title = "fibre",
      .about =
          "A line in the body that keeps its length: a thread, or rings. It moves with the "
          "material, and resists tension and compression alike.",
      .keys = {{"name", value::Text(), kRequired, "Unique name."},
               {"path_m", value::Points(2), kOptional, "Polyline at rest, robot frame."},
               {"helix", value::Map(HelixKeys()), kOptional, "A thread round an axis."},
               {"rings", value::Map(RingKeys()), kOptional, "Rings round an axis."},
               {"axial_stiffness_N", value::Real(kPositive), kOptional,
                "Young's modulus times cross-section of the thread, or of each ring. Absent: it is "
                "inextensible; `palpate info ROBOT` gives the stiffness that stands for this."}},
      .exactly_one = {{"path_m", "helix", "rings"}}};
  return keys;
}

const KeyTable& RegionKeys() {
  static const KeyTable keys{
      .title = "region",
      .about =
          "A named part of the body: the elements whose centroid lies in the box, or those of a "
          "group of the mesh file. A later region wins over an earlier one.",
      .keys = {{"name", value::Text(), kRequired, "Unique name."},
               {"box_m", value::Points(2, 2), kOptional,
                "Lower and upper corner `[[x, y, z], [x, y, z]]`, robot frame."},
               {"mesh_group", value::Text(), kOptional,
                "Name of a group of elements in the mesh file, as `palpate info MESH` lists them: "
                "a physical volume, an element set, or `NAME=VALUE` of cell data."},
               {"youngs_modulus_Pa", value::Real(kPositive), kOptional,
                "Young's modulus of this region. Absent: that of the body."}},
      .exactly_one = {{"box_m", "mesh_group"}}};
  return keys;
}

const KeyTable& MarkerKeys() {
  static const KeyTable keys{
      .title = "marker",
      .about = "A point that motion capture measures, or the centre of a fiducial.",
      .keys = {{"name", value::Text(), kRequired, "Unique name, as in `markers.csv`."},
               {"position_m", value::Vector3(), kRequired,
                "Position on the undeformed body, before gravity acts; robot frame. It may be "
                "off the surface."}}};
  return keys;
}

const KeyTable& FeaturePointKeys() {
  static const KeyTable keys{.title = "feature points",
                             .about =
                                 "Points of the surface at which contacts are searched and images "
                                 "are compared. At least one key.",
                             .keys = {{"count", value::WholeNumber(1, kMaxFeaturePoints), kOptional,
                                       "Number of points, spread evenly over the outer surface: "
                                       "walls of closed cavities are left out."},
                                      {"positions_m", value::Points(1), kOptional,
                                       "The points themselves, robot frame, undeformed body."},
                                      {"region", value::Text(), kOptional,
                                       "Name in `regions`: only the surface of this region. Not "
                                       "beside `positions_m`."}},
                             .at_most_one = {{"count", "positions_m"}, {"positions_m", "region"}}};
  return keys;
}

const KeyTable& RobotFileKeys() {
  const RobotDescription defaults;
  static const KeyTable keys{
      .title = "robot file",
      .about =
          "Description of a soft robot that cables or chambers drive. Lengths are in the robot "
          "frame.",
      .keys = {{"name", value::Text(), kRequired,
                "Name of the robot. No commas, semicolons, quotes or blanks at the ends."},
               {"mesh", value::Map(MeshKeys()), kRequired, "Mesh of the undeformed body."},
               {"element", value::Choice({"tet4", "tet10"}), Default("tet10"),
                "Finite element. `tet10` makes 10-node elements of a 4-node mesh."},
               {"material", value::Map(MaterialKeys()), kRequired, "Elasticity of the body."},
               {"mass", value::Map(MassKeys()), kRequired, "Mass of the body."},
               {"gravity_m_s2", value::Vector3(), Default(defaults.gravity_m_s2),
                "Acceleration of gravity, robot frame."},
               {"fixed", value::ListOfMaps(FixedKeys(), 1), kRequired,
                "Regions that do not move. Each connected piece of the mesh needs three fixed "
                "nodes that span a triangle."},
               {"cables", value::ListOfMaps(CableKeys()), kOptional, "Cables. Absent: none."},
               {"chambers", value::ListOfMaps(ChamberKeys()), kOptional,
                "Chambers under pressure. Absent: none."},
               {"fibres", value::ListOfMaps(FibreKeys()), kOptional,
                "Fibres and stiff rings in the body. Absent: none."},
               {"regions", value::ListOfMaps(RegionKeys()), kOptional,
                "Named parts of the body. Absent: none."},
               {"markers", value::ListOfMaps(MarkerKeys()), kOptional, "Markers. Absent: none."},
               {"feature_points", value::Either({value::Map(FeaturePointKeys()), value::Points(1)}),
                kOptional,
                "Where contacts are searched: a map, or the list of the points. Absent: " +
                    std::to_string(defaults.feature_point_count) + " points."}}};
  return keys;
}

}  // namespace palpate::robot

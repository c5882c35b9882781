// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/scenario/scenario_keys.hpp"

#include <map>
#include <numbers>
#include <string>

#include "libs/core/check.hpp"
#include "libs/geometry/pose_text.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "libs/scenario/effect_places.hpp"
#include "libs/scenario/scenario.hpp"

namespace palpate::scenario {

namespace {

constexpr NumberRule kToolLength{.min = 0.0, .max = 2.0, .min_open = true};
constexpr NumberRule kFriction{.min = 0.0, .max = 10.0};
constexpr NumberRule kShare{.min = 0.0, .max = 1.0};
constexpr NumberRule kCorrelation{.min = 0.0, .max = 1.0, .max_open = true};
constexpr NumberRule kGrazing{.min = 0.0, .max = std::numbers::pi / 2.0, .min_open = true};
constexpr NumberRule kRate{.min = 0.0, .max = 1000.0, .min_open = true};
constexpr NumberRule kPoisson{.min = 0.0, .max = 0.4999};
constexpr NumberRule kTimeStep{.min = 0.0, .max = 1.0, .min_open = true};
constexpr NumberRule kDuration{.min = 0.0, .max = 86400.0, .min_open = true};
constexpr NumberRule kCommand{.min = -0.5, .max = 0.5};
constexpr NumberRule kPressure{.min = -101325.0, .max = 1e6};
constexpr NumberRule kSensorGain{.min = -0.5, .max = 0.5};
constexpr NumberRule kSensorZero{.min = -50e3, .max = 50e3};
constexpr NumberRule kSupplyTime{.min = 0.0, .max = 100.0};
constexpr NumberRule kLeakRatio{.min = 0.0, .max = 10.0};
constexpr NumberRule kMass{.min = 0.0, .max = 10.0};
constexpr NumberRule kPatchRadius{.min = 0.0, .max = 1.0};
constexpr NumberRule kTilt{.min = -180.0, .max = 180.0};
constexpr NumberRule kClutter{.min = 0.0, .max = 10.0};
constexpr NumberRule kLight{.min = 0.0, .max = 10.0, .min_open = true};
const Presence kOfRobotFile{.kind = Presence::Kind::kOptional, .text = "robot file", .json = {}};

Key ColorKey(const std::string& name, const Presence& presence, const std::string& meaning) {
  return {name, value::Vector3(kShare), presence, meaning + " `[red, green, blue]`."};
}

/// `T_robot_camera`, or `eye_m` and `target_m`.
void AddPoseKeys(std::vector<Key>* keys, const std::string& meaning) {
  keys->push_back({"T_robot_camera", value::Map(geometry::PoseKeys()), kOptional,
                   meaning + " Optical frame of the depth camera: p_robot = T p_camera."});
  keys->push_back(
      {"eye_m", value::Vector3(), kOptional,
       "In place of `T_robot_camera`: position of the camera, robot frame. Its x axis is level."});
  keys->push_back({"target_m", value::Vector3(), RequiredFor("`eye_m`"),
                   "With `eye_m`: a point on the optical axis."});
}

KeyTable MakeEffectKeys(const EffectKind& kind) {
  const ValueType place = IsOfTwo(kind.place)
                              ? value::List(value::Text(), 2)
                              : value::Either({value::Text(), value::List(value::Text(), 1)});
  KeyTable table{.title = "effect " + std::string(kind.id),
                 .about = std::string(kind.what),
                 .keys = {{"id", value::Choice({std::string(kind.id)}), kRequired, "The effect."},
                          {"where", place, kOptional,
                           "`" + DescribePlace(kind.place) + "`. Absent: drawn by the seed."}}};
  for (const EffectParameter& parameter : kind.parameters) {
    const NumberRule rule{.min = parameter.min, .max = parameter.max};
    table.keys.push_back({std::string(parameter.name),
                          value::Either({value::Real(rule), value::Numbers(rule, 2, 2)}),
                          parameter.required ? kRequired : Default(parameter.healthy),
                          "A number, or a range `[lower, upper]` from which the seed draws."});
  }
  return table;
}

ValueType AnyEffect() {
  std::vector<ValueType> kinds;
  for (const EffectKind& kind : EffectCatalogue()) kinds.push_back(value::Map(EffectKeys(kind)));
  return value::Either(std::move(kinds));
}

}  // namespace

const KeyTable& BodyMaterialKeys() {
  static const KeyTable keys{
      .title = "material of the body",
      .about = "Elasticity of the virtual robot where it differs from the robot file.",
      .keys = {{"model",
                value::Choice({"linear", "corotational", "neo_hookean", "st_venant_kirchhoff",
                               "yeoh", "stable_neo_hookean"}),
                kOfRobotFile, "Constitutive law."},
               {"youngs_modulus_Pa", value::Real(kPositive), kOfRobotFile, "Young's modulus."},
               {"poissons_ratio", value::Real(kPoisson), kOfRobotFile, "Poisson's ratio."},
               {"c20_over_c10", value::Real(), OnlyFor("`model: yeoh`"),
                "Ratio of Yeoh's constants C20 and C10. Absent: 0."},
               {"c30_over_c10", value::Real(), OnlyFor("`model: yeoh`"),
                "Ratio of Yeoh's constants C30 and C10. Absent: 0."}}};
  return keys;
}

const KeyTable& PronyKeys() {
  static const KeyTable keys{
      .title = "Prony term",
      .about =
          "One term of linear viscoelasticity. The instantaneous modulus is (1 + sum of g) "
          "times the nominal, long-term one.",
      .keys = {{"g", value::Real(kPositive), kRequired, "Relative modulus of the term."},
               {"tau_s", value::Real(kPositive), kRequired, "Relaxation time."}}};
  return keys;
}

const KeyTable& BodyKeys() {
  static const KeyTable keys{
      .title = "body",
      .about = "The virtual robot's body where it differs from the robot file.",
      .keys = {{"mesh_file", value::File(), kOfRobotFile,
                "Mesh. Unit and placement are those of the mesh of the robot file."},
               {"refine", value::WholeNumber(0, 2), Default(BodyTruth{}.refine),
                "How often each tetrahedron is cut in eight."},
               {"element", value::Choice({"tet4", "tet10"}), kOfRobotFile, "Finite element."},
               {"material", value::Map(BodyMaterialKeys()), kOfRobotFile, "Elasticity."},
               {"prony", value::ListOfMaps(PronyKeys()), kOptional,
                "Viscoelasticity. Absent: `material.creep` of the robot file."}}};
  return keys;
}

const KeyTable& MotionKeys() {
  const Motion defaults;
  static const KeyTable keys{
      .title = "motion",
      .about = "How the virtual robot moves. Damping is Rayleigh's: C = alpha M + beta K.",
      .keys = {{"mode", value::Choice({"quasi_static", "dynamic"}), Default("quasi_static"),
                "`quasi_static` leaves inertia and damping out."},
               {"time_step_s", value::Real(kTimeStep), Default(defaults.time_step_s),
                "Largest time step."},
               {"rayleigh_mass_1_s", value::Real(kNonNegative), Default(defaults.rayleigh_mass_1_s),
                "alpha."},
               {"rayleigh_stiffness_s", value::Real(kNonNegative),
                Default(defaults.rayleigh_stiffness_s), "beta."}}};
  return keys;
}

const KeyTable& SupplyKeys() {
  const ChamberSupply defaults;
  static const KeyTable keys{
      .title = "supply",
      .about =
          "Supply of a chamber. A regulator holds the reading of its sensor at the command. A "
          "first-order valve leads to the chamber, which may leak.",
      .keys = {{"chamber", value::Text(), kRequired, "Chamber of the robot file."},
               {"valve_time_constant_s", value::Real(kSupplyTime),
                Default(defaults.valve_time_constant_s),
                "Time constant of the valve without a leak. 0: no delay."},
               {"leak_ratio", value::Real(kLeakRatio), Default(defaults.leak_ratio),
                "Conductance of the chamber's leak over that of its valve."},
               {"sensor_gain", value::Real(kSensorGain), Default(defaults.sensor_gain),
                "The supply has (1 + this) times the pressure that the sensor reads,"},
               {"sensor_zero_Pa", value::Real(kSensorZero), Default(defaults.sensor_zero_Pa),
                "and so much more."},
               {"sensor_noise_Pa", value::Real(kNonNegative), Default(defaults.sensor_noise_Pa),
                "Standard deviation of a reading."}}};
  return keys;
}

const KeyTable& EffectKeys(const EffectKind& kind) {
  static const std::map<std::string_view, KeyTable> tables = [] {
    std::map<std::string_view, KeyTable> all;
    for (const EffectKind& each : EffectCatalogue()) all.emplace(each.id, MakeEffectKeys(each));
    return all;
  }();
  const auto found = tables.find(kind.id);
  PALPATE_CHECK(found != tables.end(), kind.id);
  return found->second;
}

const KeyTable& ToolKeys() {
  const Tool defaults;
  static const KeyTable keys{
      .title = "tool",
      .about = "A rigid body that moves along a path. The origin of its frame is its centre.",
      .keys = {
          {"name", value::Text(), kRequired, "Unique name."},
          {"shape", value::Choice({"sphere", "cylinder", "plate", "hand"}), kRequired,
           "The axis of a cylinder is z. A hand is visible and touches nothing."},
          {"radius_m", value::Real(kToolLength), RequiredFor("sphere, cylinder"), "Radius."},
          {"length_m", value::Real(kToolLength), RequiredFor("cylinder"), "Length."},
          {"size_m", value::Vector3(kToolLength), RequiredFor("plate"), "Edges along x, y, z."},
          {"friction_coefficient", value::Real(kFriction),
           OnlyFor("sphere, cylinder, plate", Default(defaults.friction_coefficient)),
           "Coulomb friction on the robot."},
          ColorKey("color_rgb", Default(defaults.color_rgb), "Colour")}};
  return keys;
}

const KeyTable& DepthNoiseKeys() {
  const DepthNoise defaults;
  static const KeyTable keys{
      .title = "depth noise",
      .about = "Noise of the depth image.",
      .keys = {
          {"sensor", value::Choice({"none", "stereo", "time_of_flight"}), Default("stereo"),
           "Kind of camera. Stereo needs `depth.baseline_m`."},
          {"subpixel_px", value::Real(kNonNegative), Default(defaults.subpixel_px),
           "Standard deviation of the disparity."},
          {"correlation_px", value::Real({.min = 0.0, .max = 100.0}),
           Default(defaults.correlation_px), "Correlation length of that noise in the image."},
          {"temporal_correlation", value::Real(kCorrelation),
           Default(defaults.temporal_correlation), "Its correlation between frames."},
          {"disparity_step_px", value::Real(kNonNegative), Default(defaults.disparity_step_px),
           "Step of the disparity."},
          {"periodic_bias_px", value::Real(kNonNegative), Default(defaults.periodic_bias_px),
           "Amplitude of the bias of sub-pixel interpolation."},
          {"low_frequency_bias", value::Real({.min = 0.0, .max = 0.5}),
           Default(defaults.low_frequency_bias),
           "Smooth relative bias of the depth over the image, RMS."},
          {"edge_hole_ratio", value::Real(kShare), Default(defaults.edge_hole_ratio),
           "Share of pixels along depth edges without depth."},
          {"flying_pixel_ratio", value::Real(kShare), Default(defaults.flying_pixel_ratio),
           "Share of pixels along depth edges between front and back."},
          {"grazing_angle_rad", value::Real(kGrazing), Default(defaults.grazing_angle_rad),
           "Angle to the normal of the surface beyond which holes grow."},
          {"range_sigma_m", value::Real(kNonNegative), Default(defaults.range_sigma_m),
           "Time of flight: standard deviation at 1 m on white. It grows with 1 / amplitude."}}};
  return keys;
}

const KeyTable& CameraSpecKeys() {
  static const KeyTable keys = [] {
    KeyTable table{.title = "camera",
                   .about = "The camera as its data sheet has it, its pose and its noise.",
                   .keys = {{"file", value::File(), kOptional,
                             "A camera.yaml, in place of `depth` and `color` here."}}};
    for (Key key : rgbd::CameraFileKeys().keys) {
      key.presence = key.presence.MustBeThere() ? RequiredFor("no `file`") : OnlyFor("no `file`");
      table.keys.push_back(key);
    }
    AddPoseKeys(&table.keys, "Pose, required unless `eye_m` is given.");
    table.keys.push_back(
        {"rate_hz", value::Real(kRate), Default(CameraSpec{}.rate_hz), "Rate of the frames."});
    table.keys.push_back({"noise", value::Map(DepthNoiseKeys()), kOptional,
                          "Noise of the depth image. Absent: the defaults of its keys."});
    return table;
  }();
  return keys;
}

const KeyTable& FurtherCameraKeys() {
  static const KeyTable keys = [] {
    const FurtherCamera defaults;
    KeyTable table{.title = "further camera",
                   .about = "A camera beside `camera`, with the keys of that one.",
                   .keys = {{"name", value::Text(), kRequired,
                             "Name of its folder in a recording (docs/experiment.md)."},
                            {"delay_s", value::Real(kNonNegative), Default(defaults.delay_s),
                             "Time of its first frame in a recording."},
                            {"clock_offset_s", value::Real(), Default(defaults.clock_offset_s),
                             "Its stamps less the time."}}};
    for (const Key& key : CameraSpecKeys().keys) table.keys.push_back(key);
    return table;
  }();
  return keys;
}

const KeyTable& StageKeys() {
  const Stage defaults;
  static const KeyTable keys{
      .title = "stage",
      .about = "What is drawn besides robot and tools.",
      .keys = {
          {"table_height_m", value::Real(), Default(defaults.table_height_m),
           "Top of the table, robot frame, z up."},
          {"table_size_m", value::Numbers(kPositive, 2, 2), Default(defaults.table_size_m),
           "`[along x, along y]`."},
          ColorKey("table_color_rgb", Default(defaults.table_color_rgb), "Table"),
          {"background_distance_m", value::Real(kNonNegative),
           Default(defaults.background_distance_m),
           "Distance of the wall behind from the axis of the robot. 0: no wall."},
          ColorKey("background_color_rgb", Default(defaults.background_color_rgb), "Wall"),
          ColorKey("robot_color_rgb", Default(defaults.robot_color_rgb), "Robot"),
          {"marker_radius_m", value::Real(kNonNegative), Default(defaults.marker_radius_m),
           "Radius of the fiducials at the markers of the robot. 0: none."},
          ColorKey("marker_color_rgb", kOptional,
                   "All fiducials. Absent: a hue for each, as far apart as possible."),
          {"light", value::Real(kLight), Default(defaults.light), "Brightness of the lamps."}}};
  return keys;
}

const KeyTable& MarkerSpecKeys() {
  const MarkerSpec defaults;
  static const KeyTable keys{
      .title = "markers",
      .about =
          "Markers that are measured. Without `frame`, motion capture measures all of them "
          "without bias, in the frame of the camera where there is one.",
      .keys = {{"frame", value::Choice({"camera"}), kOptional,
                "The depth camera measures the markers, with its errors, in its frame. Visible "
                "are markers whose surface it views at rest from less than `grazing_angle_rad`. "
                "It takes no images then."},
               {"sigma_m", value::Either({value::Real(kPositive), value::Vector3(kPositive)}),
                Default(defaults.sigma_m), "Standard deviation: one number, or `[x, y, z]`."},
               {"rate_hz", value::Real(kRate), Default(defaults.rate_hz), "Rate."},
               {"missing_share", value::Real(kShare), Default(defaults.missing_share),
                "Share of the positions that are not seen, each frame and marker by itself."}}};
  return keys;
}

const KeyTable& CommandRowKeys() {
  static const KeyTable keys{
      .title = "row of commands",
      .about =
          "Commands at one time: linear between rows, held outside. Each row names the actuators "
          "of the first. A cable in no row is free, a chamber open to the air.",
      .keys = {{"t_s", value::Real(kNonNegative), kRequired,
                "Time from the beginning of the recording. It must rise, up to `duration_s`."}},
      .open_keys = {{"<cable>.displacement_m", value::OrNull(value::Real(kCommand)), kOptional,
                     "Displacement of the actuator. `~`: the cable is free."},
                    {"<chamber>.pressure_Pa", value::OrNull(value::Real(kPressure)), kOptional,
                     "Pressure above ambient. `~`: the chamber is open to the air."}}};
  return keys;
}

const KeyTable& WaypointKeys() {
  static const KeyTable keys{
      .title = "waypoint",
      .about =
          "Pose of a tool at one time: straight and by the shortest arc between waypoints, "
          "held outside.",
      .keys = {{"t_s", value::Real(kNonNegative), kRequired,
                "Time from the beginning of the recording. It must rise, up to `duration_s`."},
               {"position_m", value::Vector3(), kRequired, "Centre of the tool, robot frame."},
               {"rotation_xyz_deg", value::Vector3(), Default(Eigen::Vector3d::Zero().eval()),
                "Rotation about the fixed x axis, then y, then z."}}};
  return keys;
}

const KeyTable& ToolPathKeys() {
  static const KeyTable keys{
      .title = "path of a tool",
      .about = "A tool without a path in a recording is not there.",
      .keys = {{"tool", value::Text(), kRequired, "Name of the tool."},
               {"path", value::ListOfMaps(WaypointKeys(), 1), kRequired, "Waypoints."}}};
  return keys;
}

const KeyTable& HungWeightKeys() {
  static const KeyTable keys{
      .title = "weight",
      .about = "A known weight that hangs on the body. loads.csv lists it.",
      .keys = {
          {"t_s", value::Real(kNonNegative), kRequired,
           "It hangs from this time to the next time that is named for any weight."},
          {"position_m", value::Vector3(), kRequired, "Point of the undeformed body, robot frame."},
          {"mass_kg", value::Real(kMass), kRequired, "Mass. 0 takes all weights off."},
          {"patch_radius_m", value::Real(kPatchRadius), Default(HungWeight{}.patch_radius_m),
           "Radius of the patch of surface that carries it. 0: the point alone."}}};
  return keys;
}

const KeyTable& RecordingPlanKeys() {
  static const KeyTable keys = [] {
    const RecordingPlan defaults;
    KeyTable table{
        .title = "recording",
        .about =
            "One recording. Recordings are made in this order, in which their names must sort.",
        .keys = {
            {"name", value::Text(), kRequired,
             "Name of its folder: letters, digits, `_`, `-` and `.`, no `.` first."},
            {"kind",
             value::Choice({"rest", "ramp", "hold", "known_load", "base_tilted", "co_contraction",
                            "camera_moved", "second_speed", "repeat", "free"}),
             Default("free"), "As in recording.yaml (docs/experiment.md)."},
            {"duration_s", value::Real(kDuration), kRequired, "Duration."},
            {"commands", value::ListOfMaps(CommandRowKeys()), kOptional,
             "Commands. Absent: all cables are free, all chambers open."},
            {"tools", value::ListOfMaps(ToolPathKeys()), kOptional, "Paths of tools."},
            {"weights", value::ListOfMaps(HungWeightKeys()), kOptional, "Known weights."},
            {"base_tilt_deg", value::Numbers(kTilt, 2, 2), Default(defaults.base_tilt_deg),
             "`[a, b]`: the base is turned by R = Ry(b) Rx(a)."}}};
    AddPoseKeys(&table.keys, "Pose to which the camera was moved, known to the estimator.");
    table.keys.push_back({"notes", value::Text(), kOptional, "For people."});
    return table;
  }();
  return keys;
}

const KeyTable& ScenarioKeys() {
  const Scenario defaults;
  static const KeyTable keys{
      .title = "scenario",
      .about = "A virtual bench, and what is done on it (`palpate simulate`).",
      .keys = {
          {"name", value::Text(), kRequired, "Name of the scenario."},
          {"body", value::Map(BodyKeys()), kOptional,
           "The virtual robot's body where it differs from the robot file."},
          {"motion", value::Map(MotionKeys()), kOptional, "How it moves."},
          {"effects", value::List(AnyEffect()), kOptional,
           "Hidden effects, see the table of effects. Absent: none."},
          {"supply", value::ListOfMaps(SupplyKeys()), kOptional,
           "Supplies of chambers. A chamber that is not named has an ideal one."},
          {"clutter", value::Real(kClutter), Default(defaults.clutter),
           "Manufacturing tolerances: the standard deviation of each parameter of the "
           "catalogue, in its tolerances. 0: exactly as the robot file says."},
          {"tools", value::ListOfMaps(ToolKeys()), kOptional, "Tools. Absent: none."},
          {"camera", value::Map(CameraSpecKeys()), kOptional, "Camera. Absent: no images."},
          {"cameras", value::ListOfMaps(FurtherCameraKeys()), kOptional,
           "Cameras beside `camera`. Effects act on that one alone. Absent: none."},
          {"stage", value::Map(StageKeys()), kOptional, "What is drawn besides the robot."},
          {"markers", value::Map(MarkerSpecKeys()), kOptional, "Measured markers. Absent: none."},
          {"rest_between_s", value::Real(kNonNegative), Default(defaults.rest_between_s),
           "Rest before each recording: commands go to zero, no tool, no weight."},
          {"recordings", value::ListOfMaps(RecordingPlanKeys(), 1), kRequired, "What is done."}}};
  return keys;
}

}  // namespace palpate::scenario

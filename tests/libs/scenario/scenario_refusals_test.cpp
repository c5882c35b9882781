// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/scenario/scenario_text.hpp"

namespace palpate::scenario {
namespace {

using test_support::MessageOf;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ScenarioRefusals, UnknownAndMissingKeysOfEverySection) {
  EXPECT_THAT(RefusalWith("clutter: 0.5", "cluter: 0.5"),
              AllOf(StartsWith("bench/s.yaml:13:1"), HasSubstr("did you mean 'clutter'")));
  EXPECT_THAT(RefusalWith("name: full\n", ""), HasSubstr("key 'name' is missing"));
  EXPECT_THAT(RefusalWith("  refine: 2", "  refined: 2"), HasSubstr("did you mean 'refine'"));
  EXPECT_THAT(RefusalWith("poissons_ratio: 0.47", "poisson_ratio: 0.47"),
              AllOf(StartsWith("bench/s.yaml:5:54"), HasSubstr("did you mean 'poissons_ratio'")));
  EXPECT_THAT(RefusalWith("{g: 0.1, tau_s: 5}", "{g: 0.1, tau: 5}"), HasSubstr("tau_s"));
  EXPECT_THAT(RefusalWith("time_step_s", "step_s"), HasSubstr("unknown key 'motion.step_s'"));
  EXPECT_THAT(RefusalWith("rate_hz: 15", "rate: 15"), HasSubstr("unknown key 'camera.rate'"));
  EXPECT_THAT(RefusalWith("subpixel_px", "sub_pixel_px"), HasSubstr("did you mean 'subpixel_px'"));
  EXPECT_THAT(RefusalWith("table_height_m", "table_z_m"), HasSubstr("'stage.table_z_m'"));
  EXPECT_THAT(RefusalWith("rate_hz: 60", "rate_Hz: 60"), HasSubstr("did you mean 'rate_hz'"));
  EXPECT_THAT(RefusalWith("    notes:", "    note:"), HasSubstr("did you mean 'notes'"));
  EXPECT_THAT(RefusalWith("    duration_s: 4\n", ""), HasSubstr("'duration_s' is missing"));
  EXPECT_THAT(RefusalWith("mass_kg: 0.05, patch", "mass_g: 50, patch"),
              HasSubstr("the unit 'g' does not fit: write 'mass_kg'"));
  EXPECT_THAT(RefusalWith("position_m: [0, 0, 0.2]", "position: [0, 0, 0.2]"),
              HasSubstr("the unit is missing: write 'position_m'"));
}

TEST(ScenarioRefusals, ValuesOfTheBodyThatCannotBe) {
  EXPECT_THAT(RefusalWith("refine: 2", "refine: 3"), HasSubstr("must be 0 to 2, not 3"));
  EXPECT_THAT(RefusalWith("element: tet4", "element: hex8"), HasSubstr("one of tet4, tet10"));
  EXPECT_THAT(RefusalWith("model: yeoh", "model: yeo"), HasSubstr("did you mean 'yeoh'"));
  EXPECT_THAT(RefusalWith("model: yeoh", "model: corotational"),
              HasSubstr("go with 'model: yeoh'"));
  EXPECT_THAT(RefusalWith("91.0e3", "0"), HasSubstr("must be > 0, not 0"));
  EXPECT_THAT(RefusalWith("poissons_ratio: 0.47", "poissons_ratio: 0.5"), HasSubstr("<= 0.4999"));
  EXPECT_THAT(RefusalWith("{g: 0.1,", "{g: 0,"), HasSubstr("must be > 0"));
  EXPECT_THAT(RefusalWith("tau_s: 5}", "tau_s: -5}"), HasSubstr("must be > 0"));
  EXPECT_THAT(RefusalWith("refine: 2", "mesh_file: none.msh"),
              HasSubstr("there is no file bench/none.msh"));
  EXPECT_THAT(RefusalWith("mode: dynamic", "mode: statics"), HasSubstr("quasi_static, dynamic"));
  EXPECT_THAT(RefusalWith("time_step_s: 0.005", "time_step_s: 0"), HasSubstr("> 0 and <= 1"));
  EXPECT_THAT(RefusalWith("rayleigh_mass_1_s: 2", "rayleigh_mass_1_s: -2"), HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("rayleigh_stiffness_s: 0.002", "rayleigh_stiffness_s: -1"),
              HasSubstr(">= 0"));
}

TEST(ScenarioRefusals, Tools) {
  EXPECT_THAT(RefusalWith("shape: sphere", "shape: ball"), HasSubstr("sphere, cylinder, plate"));
  EXPECT_THAT(RefusalWith("radius_m: 0.012", "radius_m: 12"), HasSubstr("> 0 and <= 2, not 12"));
  EXPECT_THAT(RefusalWith("radius_m: 0.012, ", ""), HasSubstr("'radius_m' is missing"));
  EXPECT_THAT(RefusalWith(", length_m: 0.08", ""), HasSubstr("'length_m' is missing"));
  EXPECT_THAT(RefusalWith("size_m: [0.1, 0.08, 0.004]", "radius_m: 0.1"), HasSubstr("'size_m'"));
  EXPECT_THAT(RefusalWith("shape: hand", "shape: hand, friction_coefficient: 1"),
              HasSubstr("unknown key 'tools[3].friction_coefficient'"));
  EXPECT_THAT(RefusalWith("friction_coefficient: 0.4", "friction_coefficient: -0.4"),
              HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("[0.1, 0.2, 0.3]}", "[10, 20, 255]}"), HasSubstr("<= 1"));
  EXPECT_THAT(RefusalWith("name: rod", "name: ball"),
              AllOf(HasSubstr(":16:"), HasSubstr("two tools 'ball'")));
}

TEST(ScenarioRefusals, TheCamera) {
  const std::string pose =
      "  T_robot_camera: {translation_m: [0.1, -0.4, 0.2], rotation_xyzw: [1, 0, 0, 0]}\n";
  EXPECT_THAT(RefusalWith(pose, ""), HasSubstr("where is the camera?"));
  EXPECT_THAT(RefusalWith(pose, pose + "  eye_m: [0, 0, 1]\n"), HasSubstr("given twice"));
  EXPECT_THAT(RefusalWith(pose, "  eye_m: [0, 0, 1]\n"), HasSubstr("goes with 'target_m'"));
  EXPECT_THAT(RefusalWith(pose, "  target_m: [0, 0, 1]\n"), HasSubstr("goes with 'eye_m'"));
  EXPECT_THAT(RefusalWith(pose, "  eye_m: [0, 0, 1]\n  target_m: [0, 0, 1]\n"),
              HasSubstr("is where the camera is"));
  EXPECT_THAT(RefusalWith("rotation_xyzw: [1, 0, 0, 0]", "rotation_xyzw: [1, 1, 0, 0]"),
              HasSubstr("norm 1"));
  EXPECT_THAT(RefusalWith("rate_hz: 15", "rate_hz: 0"), HasSubstr("must be > 0"));
  EXPECT_THAT(RefusalWith("fx_px: 425", "fx_px: -425"), HasSubstr("camera.depth.fx_px"));
  EXPECT_THAT(RefusalWith("sensor: time_of_flight", "sensor: lidar"), HasSubstr("none, stereo"));
  EXPECT_THAT(RefusalWith("temporal_correlation: 0.4", "temporal_correlation: 1"),
              HasSubstr(">= 0 and < 1"));
  EXPECT_THAT(RefusalWith("edge_hole_ratio: 0.4", "edge_hole_ratio: 1.1"), HasSubstr("<= 1"));
  EXPECT_THAT(RefusalWith("flying_pixel_ratio: 0.2", "flying_pixel_ratio: -1"), HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("grazing_angle_rad: 1.1", "grazing_angle_rad: 70"), HasSubstr("<= 1.57"));
  for (const char* key :
       {"subpixel_px: 0.1", "correlation_px: 2", "disparity_step_px: 0.125",
        "periodic_bias_px: 0.02", "low_frequency_bias: 0.001", "range_sigma_m: 0.003"}) {
    const std::string text(key);
    EXPECT_THAT(RefusalWith(text, text.substr(0, text.find(' ')) + " -1"), HasSubstr(">= 0"))
        << key;
  }
  std::string no_baseline = FullWith(", baseline_m: 0.05", "");
  no_baseline.replace(no_baseline.find("time_of_flight"), 14, "stereo");
  EXPECT_THAT(RefusalOf(no_baseline), HasSubstr("needs its 'depth.baseline_m'"));
}

TEST(ScenarioRefusals, StageMarkersAndNumbersOfTheWhole) {
  EXPECT_THAT(RefusalWith("table_size_m: [0.5, 0.6]", "table_size_m: [0.5]"),
              HasSubstr("[along x, along y]"));
  EXPECT_THAT(RefusalWith("table_size_m: [0.5, 0.6]", "table_size_m: [0.5, 0]"), HasSubstr("> 0"));
  EXPECT_THAT(RefusalWith("background_distance_m: 0.7", "background_distance_m: -1"),
              HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("marker_radius_m: 0.003", "marker_radius_m: -1"), HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("light: 0.8", "light: 0"), HasSubstr("> 0"));
  EXPECT_THAT(RefusalWith("[0.0001, 0.0002, 0.0003]", "0"), HasSubstr("must be > 0, not 0"));
  EXPECT_THAT(RefusalWith("rate_hz: 60", "rate_hz: 0"), HasSubstr("must be > 0"));
  EXPECT_THAT(RefusalWith("rest_between_s: 2.5", "rest_between_s: -1"), HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("clutter: 0.5", "clutter: -0.5"), HasSubstr(">= 0"));
}

TEST(ScenarioRefusals, Recordings) {
  EXPECT_THAT(RefusalOf("name: s\nrecordings: []\n"), HasSubstr("at least one recording"));
  EXPECT_THAT(RefusalOf("name: s\nrecordings: {}\n"), HasSubstr("must be a list of recordings"));
  EXPECT_THAT(RefusalWith("name: b_push", "name: a_push"),
              AllOf(HasSubstr("s.yaml:39:"), HasSubstr("must sort after 'a_ramp'")));
  EXPECT_THAT(RefusalWith("name: b_push", "name: a_ramp"), HasSubstr("must sort after"));
  EXPECT_THAT(RefusalWith("name: b_push", "name: b/push"), HasSubstr("name of a folder"));
  EXPECT_THAT(RefusalWith("name: b_push", "name: ..b"), HasSubstr("name of a folder"));
  EXPECT_THAT(RefusalWith("kind: ramp", "kind: ramps"), HasSubstr("did you mean 'ramp'"));
  EXPECT_THAT(RefusalWith("duration_s: 3.5", "duration_s: 0"), HasSubstr("must be > 0"));
  EXPECT_THAT(RefusalWith("base_tilt_deg: [5, -10]", "base_tilt_deg: [5]"), HasSubstr("[about x"));
  EXPECT_THAT(RefusalWith("base_tilt_deg: [5, -10]", "base_tilt_deg: [500, 0]"),
              HasSubstr("<= 180"));
  EXPECT_THAT(RefusalOf("name: s\nrecordings: [{name: a, duration_s: 1, eye_m: [0, 0, 1], "
                        "target_m: [0, 0, 0]}]\n"),
              HasSubstr("no camera to move"));
}

TEST(ScenarioRefusals, Commands) {
  const std::string second = "{t_s: 2, north.displacement_m: 0.01, east.displacement_m: 0.002}";
  EXPECT_THAT(RefusalWith(second, "{t_s: 0, north.displacement_m: 0, east.displacement_m: 0}"),
              AllOf(HasSubstr("s.yaml:33:"), HasSubstr("time must rise, and 0 follows 0")));
  EXPECT_THAT(RefusalWith(second, "{t_s: 5, north.displacement_m: 0, east.displacement_m: 0}"),
              HasSubstr("must be >= 0 and <= 4, not 5"));
  EXPECT_THAT(RefusalWith(second, "{t_s: 2, north.displacement_m: 0.01}"),
              HasSubstr("'east.displacement_m' is missing: every row"));
  EXPECT_THAT(RefusalWith(second, "{t_s: 2, north.displacement_mm: 10}"),
              AllOf(HasSubstr("s.yaml:33:18"), HasSubstr("'<cable>.displacement_m', in metres")));
  EXPECT_THAT(RefusalWith(second, "{t_s: 2, north.displacement_m: 10, east.displacement_m: 0}"),
              HasSubstr("<= 0.5, not 10"));
  EXPECT_THAT(RefusalWith(second,
                          "{t_s: 2, north.displacement_m: 0, east.displacement_m: 0, "
                          "south.displacement_m: 0}"),
              HasSubstr("south.displacement_m"));
  EXPECT_THAT(RefusalWith("{t_s: 0, north.displacement_m: 0, east.displacement_m: ~}", "{t_s: 0}"),
              HasSubstr("names neither a cable nor a chamber"));
}

TEST(ScenarioRefusals, ToolPathsAndWeights) {
  EXPECT_THAT(RefusalWith("- tool: ball", "- tool: bal"), HasSubstr("did you mean 'ball'"));
  EXPECT_THAT(RefusalWith("{t_s: 2, position_m: [0, 0, 0.1]", "{t_s: 0, position_m: [0, 0, 0.1]"),
              HasSubstr("time must rise"));
  EXPECT_THAT(RefusalWith("{t_s: 2, position_m: [0, 0, 0.1]", "{t_s: 9, position_m: [0, 0, 0.1]"),
              HasSubstr("<= 3.5"));
  EXPECT_THAT(RefusalWith("    base_tilt_deg: [5, -10]",
                          "      - {tool: ball, path: [{t_s: 0, "
                          "position_m: [0, 0, 0]}]}"),
              HasSubstr("a second path of the tool 'ball'"));
  EXPECT_THAT(RefusalWith("    base_tilt_deg: [5, -10]", "      - {tool: rod, path: []}"),
              HasSubstr("at least one waypoint"));
  EXPECT_THAT(RefusalWith("{t_s: 3, position_m: [0, 0, 0.12]", "{t_s: 0, position_m: [0, 0, 0.12]"),
              HasSubstr("time must rise, and 0 follows 1"));
  EXPECT_THAT(RefusalWith("mass_kg: 0.05", "mass_kg: -0.05"), HasSubstr(">= 0"));
  EXPECT_THAT(RefusalWith("patch_radius_m: 0.01", "patch_radius_m: 10"), HasSubstr("<= 1"));
}

TEST(ScenarioRefusals, EffectsOnWhatIsNotThere) {
  std::string text = "name: s\nmarkers: {}\nrecordings: [{name: a, duration_s: 1}]\neffects: [";
  EXPECT_THAT(RefusalOf(text + "{id: depth_scale, s: 0.01}]"),
              AllOf(HasSubstr("s.yaml:4:11"), HasSubstr("the scenario has no camera")));
  EXPECT_THAT(RefusalOf("name: s\nmarkers: {frame: camera}\nrecordings: []\n"),
              AllOf(HasSubstr("s.yaml:2:"), HasSubstr("no camera that could measure them")));
  text.replace(text.find("markers: {}\n"), 12, "");
  EXPECT_THAT(RefusalOf(text + "{id: marker_misplacement, d_m: 0.01}]"),
              HasSubstr("the scenario has no markers"));
  EXPECT_THAT(RefusalWith("from_recording: 1", "from_recording: 2"), HasSubstr("the last 1"));
  EXPECT_THAT(RefusalWith("from_recording: 1", "from_recording: 0.5"), HasSubstr("whole number"));
}

TEST(ScenarioRefusals, SuppliesThatCannotBe) {
  const auto with = [](const std::string& supplies) {
    return RefusalWith("clutter: 0.5", "supply:\n" + supplies + "\nclutter: 0.5");
  };
  EXPECT_THAT(with("  - {valve_time_constant_s: 0.1}"),
              HasSubstr("key 'supply[0]': key 'chamber' is missing"));
  EXPECT_THAT(with("  - {chamber: tip, valve_time_constant_ms: 100}"),
              AllOf(StartsWith("bench/s.yaml:14:"), HasSubstr("valve_time_constant_s")));
  EXPECT_THAT(with("  - {chamber: tip, valve_time_constant_s: -0.1}"), HasSubstr("not -0.1"));
  EXPECT_THAT(with("  - {chamber: tip, leak_ratio: -1}"), HasSubstr("not -1"));
  EXPECT_THAT(with("  - {chamber: tip, sensor_gain: 2}"), HasSubstr("not 2"));
  EXPECT_THAT(with("  - {chamber: tip, sensor_noise_Pa: -2}"), HasSubstr("not -2"));
  EXPECT_THAT(with("  - {chamber: tip}\n  - {chamber: tip}"),
              AllOf(StartsWith("bench/s.yaml:15:"), HasSubstr("a second supply")));
  const Scenario scenario =
      Parse(FullWith("clutter: 0.5", "supply:\n  - {chamber: top}\nclutter: 0.5"));
  const RobotNames robot{
      .cables = {"north", "east", "west"}, .chambers = {"tip"}, .regions = {}, .markers = {}};
  EXPECT_THAT(MessageOf([&] { CheckAgainst(scenario, robot); }),
              AllOf(StartsWith("bench/s.yaml:14:"), HasSubstr("no chamber 'top'")));
}

TEST(ScenarioRefusals, EffectsOfChambersAtOtherPlaces) {
  const auto with = [](const std::string& effect) {
    return RefusalWith("  - {id: cable_friction, where: cable:north, mu: 0.3}", "  - " + effect);
  };
  EXPECT_THAT(with("{id: leak, where: cable:north, ratio: 0.1}"), HasSubstr("chamber:<name>"));
  EXPECT_THAT(with("{id: swapped_tubes, where: chamber:tip}"),
              HasSubstr("[chamber:<name>, chamber:<another name>]"));
  EXPECT_THAT(with("{id: slow_valve, where: chamber:tip, tau_s: -1}"), HasSubstr("-1"));
}

}  // namespace
}  // namespace palpate::scenario

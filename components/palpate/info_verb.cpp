// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/info_verb.hpp"

#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "components/palpate/check_output.hpp"
#include "components/palpate/find_robot.hpp"
#include "components/palpate/info/describe_files.hpp"
#include "components/palpate/info/file_kind.hpp"
#include "components/palpate/recordings/describe_recording.hpp"
#include "components/palpate/robot_scene.hpp"
#include "components/view/picture/scene.hpp"
#include "libs/app/run_main.hpp"
#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/experiment/experiment.hpp"
#include "libs/fem/boundary_surface.hpp"
#include "libs/fem/mesh_io/mesh_kind.hpp"
#include "libs/fem/mesh_report.hpp"
#include "libs/geometry/triangle_surface.hpp"
#include "libs/recording/recorded_messages.hpp"
#include "libs/robot/robot_body.hpp"
#include "libs/robot/robot_model.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

// Where contacts are searched.
void DescribeCandidates(const robot::RobotDescription& description, const robot::RobotBody& body,
                        Findings* found) {
  const auto inner = body.boundary.FaceCount() -
                     static_cast<int>(fem::OuterFaces(body.mesh, body.boundary).size());
  const std::string& region = description.feature_point_region;
  found->json["contact_candidates"] = {{"points", body.feature_points.size()},
                                       {"contact_faces", body.contact_faces.size()},
                                       {"inner_faces_left_out", inner}};
  if (!region.empty()) found->json["contact_candidates"]["region"] = region;
  found->text +=
      fmt::format("contact candidates: {} points on {} of {} faces{}{}\n",
                  body.feature_points.size(), body.contact_faces.size(), body.boundary.FaceCount(),
                  region.empty() ? "" : " (region " + region + ")",
                  inner > 0 ? fmt::format(", {} faces of closed cavities left out", inner) : "");
}

void DescribeChambers(const robot::RobotBody& body, Findings* found) {
  found->json["chambers"] = Json::array();
  for (const robot::BodyChamber& chamber : body.chambers) {
    found->json["chambers"].push_back({{"name", chamber.name},
                                       {"volume_m3", chamber.volume_m3},
                                       {"dead_volume_m3", chamber.dead_volume_m3},
                                       {"max_pressure_Pa", chamber.max_pressure_Pa},
                                       {"faces", chamber.wall.faces.cols()}});
    found->text += fmt::format("chamber {}: {:.4g} cm3 within {} faces, at most {:g} kPa\n",
                               chamber.name, 1e6 * chamber.volume_m3, chamber.wall.faces.cols(),
                               1e-3 * chamber.max_pressure_Pa);
  }
  const auto skins = fem::InnerSkins(body.mesh, body.boundary);
  found->json["inner_skins"] = Json::array();
  for (std::size_t k = 0; k < skins.size(); ++k) {
    const geometry::TriangleSurface skin{body.mesh.nodes_m,
                                         body.boundary.CornerTriangles()(Eigen::all, skins[k])};
    const double volume_m3 = -geometry::EnclosedVolume_m3(skin);
    const Eigen::Vector3d centre_m =
        skin.vertices_m(Eigen::all, skin.triangles.reshaped()).rowwise().mean();
    found->json["inner_skins"].push_back(
        {{"number", k + 1},
         {"faces", skins[k].size()},
         {"volume_m3", volume_m3},
         {"centre_m", {centre_m.x(), centre_m.y(), centre_m.z()}}});
    found->text += fmt::format(
        "inner skin {}: {} faces around {:.4g} cm3 near ({:.4g}, {:.4g}, {:.4g}) m\n", k + 1,
        skins[k].size(), 1e6 * volume_m3, centre_m.x(), centre_m.y(), centre_m.z());
  }
}

void DescribeFibres(const robot::RobotBody& body, Findings* found) {
  found->json["fibres"] = Json::array();
  for (const robot::BodyFibre& fibre : body.fibres) {
    found->json["fibres"].push_back({{"name", fibre.name},
                                     {"length_m", fibre.length_m},
                                     {"axial_stiffness_N", fibre.embedded.axial_stiffness_N},
                                     {"pieces", fibre.embedded.points.size()}});
    found->text +=
        fmt::format("fibre {}: {:.4g} m long in {} pieces, axial stiffness {:.4g} N\n", fibre.name,
                    fibre.length_m, fibre.embedded.points.size(), fibre.embedded.axial_stiffness_N);
  }
}

Findings DescribeRobot(const InfoOptions& options) {
  const auto description = robot::ReadRobotFile(FindRobotFile(options.target), app::LoadYaml);
  const robot::RobotBody body = robot::BuildRobotBody(description);
  if (!options.png.empty()) {
    view::SaveScene(options.png, MakeUndeformedScene(robot::RobotModel(body)));
  }
  const fem::MeshReport report = fem::ReportMesh(body.mesh);
  Findings found;
  found.text =
      fmt::format("robot {} ({})\n{}", body.name, description.file.string(), fem::ToText(report));
  found.json = {{"robot", body.name},           {"mesh_hash", body.mesh_hash},
                {"mesh", MeshJson(report)},     {"mass_kg", body.node_mass_kg.sum()},
                {"cables", Json::array()},      {"markers", Json::array()},
                {"regions", body.region_names}, {"feature_points", body.feature_points.size()},
                {"warnings", body.warnings},    {"notes", body.notes}};
  found.text += fmt::format("mass {:.4g} kg, E {:.4g} kPa, nu {:.3g}, mesh {}\n",
                            body.node_mass_kg.sum(), 1e-3 * body.materials[0].youngs_modulus_Pa,
                            body.materials[0].poissons_ratio, body.mesh_hash);
  for (const robot::BodyCable& cable : body.cables) {
    found.json["cables"].push_back(cable.name);
    found.text += fmt::format("cable {}: {} point(s) on the body, at most {:g} N\n", cable.name,
                              cable.eyelets.size(), cable.max_tension_N);
  }
  DescribeChambers(body, &found);
  DescribeFibres(body, &found);
  for (const robot::BodyMarker& marker : body.markers) {
    found.json["markers"].push_back(marker.name);
    found.text += fmt::format("marker {}: {:.2f} mm off the body\n", marker.name,
                              1e3 * marker.point.distance_m);
  }
  DescribeCandidates(description, body, &found);
  for (const std::string& warning : body.warnings) found.text += "warning: " + warning + "\n";
  for (const std::string& note : body.notes) {
    found.text += "note: " + note + "\n";
  }
  return found;
}

Findings DescribeExperiment(const std::filesystem::path& target) {
  const experiment::Experiment experiment = experiment::ReadExperiment(target, app::LoadYaml);
  Findings found;
  found.json = {{"experiment", target.string()}, {"recordings", Json::array()}};
  found.text = fmt::format("experiment {}: {} recording(s)\n", target.string(),
                           experiment.recordings.size());
  for (const experiment::Recording& recording : experiment.recordings) {
    const std::size_t frames = recording.markers ? recording.markers->frames.size() : 0;
    const std::size_t markers = recording.markers ? recording.markers->names.size() : 0;
    const std::size_t rows = recording.actuation ? recording.actuation->t_s.size() : 0;
    found.json["recordings"].push_back({{"name", recording.name},
                                        {"kind", experiment::ToString(recording.kind)},
                                        {"markers", markers},
                                        {"marker_frames", frames},
                                        {"actuation_rows", rows},
                                        {"loads", recording.loads.size()},
                                        {"depth_images", recording.depth_images.size()},
                                        {"clouds", recording.clouds.size()}});
    found.text += fmt::format(
        "  {}: {}, {} marker(s) in {} frames, {} row(s) of actuation, {} load(s), "
        "{} depth image(s), {} cloud(s)\n",
        recording.name, experiment::ToString(recording.kind), markers, frames, rows,
        recording.loads.size(), recording.depth_images.size(), recording.clouds.size());
  }
  return found;
}

/// Only a robot file can be drawn; `what` is what the target is.
void RefusePng(const InfoOptions& options, const std::string& what) {
  if (options.png.empty()) return;
  throw InputError("--png draws a robot; " + options.target.string() + " is " + what);
}

Findings DescribeFolder(const InfoOptions& options) {
  RefusePng(options, "a folder");
  const std::filesystem::path& folder = options.target;
  const bool experiment = std::filesystem::exists(folder / "experiment.yaml") ||
                          std::filesystem::exists(folder / "recording.yaml");
  if (!experiment && std::filesystem::exists(folder / "depth.txt")) {
    return DescribeTumFolder(folder);
  }
  return DescribeExperiment(folder);
}

Findings Describe(const InfoOptions& options) {
  const std::filesystem::path& target = options.target;
  if (const auto files = recording::MessageFilesOf(target); !files.empty()) {
    RefusePng(options, "a recording");
    RecordingDescription described = DescribeRecording(files);
    return {std::move(described.json), std::move(described.text)};
  }
  if (std::filesystem::is_directory(target)) return DescribeFolder(options);
  if (!std::filesystem::exists(target)) return DescribeRobot(options);  // a name, or misspelt
  const FileKind kind = KindOf(target);
  if (kind.family == FileKind::Family::kSettings) return DescribeRobot(options);
  if (kind.family == FileKind::Family::kMesh) RefusePng(options, "a mesh");
  RefusePng(options, kind.name.empty() ? "none" : "a " + kind.name);
  if (kind.family == FileKind::Family::kMesh) return DescribeMesh(target, options.unit);
  if (kind.family != FileKind::Family::kUnknown) return DescribeFile(target, kind);
  throw InputError(SourceLocation{target.string()},
                   "is of no kind that is known; it begins with " + BeginningOf(target) +
                       ". A robot file is YAML and ends in .yaml, a mesh in " + fem::MeshEndings() +
                       ", motion capture in .c3d, .csv, .tsv or .trc");
}

}  // namespace

int Info(const InfoOptions& options) {
  if (!options.png.empty()) CheckOutputFile(options.png);
  const Findings found = Describe(options);
  fmt::print("{}", options.json ? found.json.dump(2) + "\n" : found.text);
  return app::kExitDone;
}

app::Verb InfoVerb() {
  return {"info", "Say what a file or folder is, summarise and check it",
          [](app::Arguments& arguments) -> app::Verb::Action {
            const auto options = std::make_shared<InfoOptions>();
            arguments.Positional(
                "TARGET", &options->target,
                "Robot file, name of a robot in config/robots, mesh, motion capture, point cloud, "
                "image, experiment, recording or TUM folder, or MCAP or .db3 file or folder of "
                "them");
            arguments.Suggest("TARGET", KnownRobots());
            arguments.Choice(
                "--unit", &options->unit, {"m", "cm", "mm"},
                "Length unit of a mesh file; without it lengths are those of the file; "
                "robot files name their own");
            arguments.Option("--png FILE", &options->png,
                             "PNG file to draw: the undeformed robot with its cables, markers and "
                             "contact candidates");
            arguments.Flag("--json", &options->json, "Print JSON instead of text");
            return [options] { return Info(*options); };
          }};
}

}  // namespace palpate::command

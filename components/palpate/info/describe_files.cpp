// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/info/describe_files.hpp"

#include <fmt/core.h>

#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/captured_markers.hpp"
#include "libs/experiment/cloud/cloud_convention.hpp"
#include "libs/experiment/images/rgbd_sequence.hpp"
#include "libs/fem/mesh_io/read_mesh.hpp"
#include "libs/fem/mesh_report.hpp"

namespace palpate::command {

namespace {

using Family = FileKind::Family;
using Json = nlohmann::ordered_json;

std::string SizeText(const Eigen::Vector3d& size) {
  return fmt::format("{:.4g} x {:.4g} x {:.4g}", size.x(), size.y(), size.z());
}

/// No soft robot is so long; a mesh file does not say its unit.
std::vector<std::string> DoubtUnit(const Eigen::Vector3d& size_m, const std::string& unit) {
  constexpr double kLongestRobot_m = 10.0;
  const double length_m = size_m.maxCoeff();
  if (unit.empty()) {
    return {
        fmt::format("the file does not say its unit of length: --unit mm means {} mm, --unit m "
                    "{} m",
                    SizeText(size_m), SizeText(size_m))};
  }
  if (!(length_m > kLongestRobot_m)) return {};
  const std::string smaller = unit == "mm" ? "" : "mm";
  return {
      fmt::format("{:.4g} m long{}", length_m, smaller.empty() ? "" : ": --unit " + smaller + "?")};
}

/// Of a mesh whose unit is not known: what does not depend on it.
std::string UnitlessText(const fem::MeshReport& report) {
  return fmt::format(
      "mesh of {} nodes and {} tetrahedra of {} nodes\n"
      "  size in the file's unit    {}\n"
      "  volume in its cube         {:.6g}\n"
      "  worst quality              {:.4g} (mean ratio, cell {})\n"
      "  pieces                     {}\n"
      "  inverted cells             {}\n"
      "  degenerate cells           {}\n"
      "  duplicate cells            {}\n"
      "  duplicate nodes            {}\n",
      report.node_count, report.cell_count, report.nodes_per_cell,
      SizeText(report.max_m - report.min_m), report.volume_m3, report.worst_quality,
      report.worst_cell, report.pieces, report.inverted_cells.size(),
      report.degenerate_cells.size(), report.duplicate_cells.size(), report.duplicate_nodes.size());
}

Findings DescribeCapture(const std::filesystem::path& file) {
  // A file without a unit is described all the same: times and names do not depend on it.
  const experiment::CapturedMarkers captured =
      experiment::ReadCapture(file, {.unit_if_absent = "mm"});
  const auto& frames = captured.tracks.frames;
  Findings found;
  found.json = {{"markers", captured.tracks.names},
                {"frames", frames.size()},
                {"rate_Hz", captured.rate_Hz},
                {"notes", captured.notes}};
  found.text =
      fmt::format("  {} marker(s) in {} frames at {:g} Hz: {}\n", captured.tracks.names.size(),
                  frames.size(), captured.rate_Hz, Listed(captured.tracks.names));
  for (const std::string& note : captured.notes) found.text += "  note: " + note + "\n";
  return found;
}

Findings DescribeCloud(const std::filesystem::path& file) {
  const experiment::PointCloud cloud = experiment::ReadPointCloud(file);
  const auto convention = experiment::ConventionOf(cloud);
  const std::string note = convention ? ToText(*convention) : "holds no point";
  Findings found;
  found.json = {{"points", cloud.points_m.cols()},
                {"width", cloud.width},
                {"height", cloud.height},
                {"colored", !cloud.colors_rgb.empty()},
                {"note", note}};
  found.text = fmt::format(
      "  {} points{}, {}\n", cloud.points_m.cols(),
      cloud.organised() ? fmt::format(" ({} x {})", cloud.width, cloud.height) : std::string(),
      cloud.colors_rgb.empty() ? "without colour" : "with colour");
  if (!note.empty()) found.text += "  note: " + note + "\n";
  return found;
}

}  // namespace

nlohmann::ordered_json MeshJson(const fem::MeshReport& report) {
  return {{"nodes", report.node_count},
          {"cells", report.cell_count},
          {"nodes_per_cell", report.nodes_per_cell},
          {"volume_m3", report.volume_m3},
          {"worst_quality", report.worst_quality},
          {"min_m", {report.min_m.x(), report.min_m.y(), report.min_m.z()}},
          {"max_m", {report.max_m.x(), report.max_m.y(), report.max_m.z()}},
          {"boundary_triangles", report.boundary_triangles},
          {"free_edges", report.free_edges},
          {"pieces", report.pieces},
          {"inverted_cells", report.inverted_cells.size()},
          {"degenerate_cells", report.degenerate_cells.size()},
          {"duplicate_cells", report.duplicate_cells.size()}};
}

Findings DescribeMesh(const std::filesystem::path& file, const std::string& unit) {
  const double metres_per_unit = unit == "mm" ? 1e-3 : (unit == "cm" ? 1e-2 : 1.0);
  std::vector<std::string> notes;
  const fem::TetMesh mesh = fem::ReadMesh(file, metres_per_unit, &notes);
  const fem::MeshReport report = fem::ReportMesh(mesh);
  const std::vector<std::string> warnings = DoubtUnit(report.max_m - report.min_m, unit);
  Findings found;
  Json groups = Json::array();
  for (const fem::CellGroup& group : mesh.groups) {
    groups.push_back({{"name", group.name}, {"cells", group.cells.size()}});
  }
  found.json = {{"mesh", MeshJson(report)},
                {"unit", unit.empty() ? "unknown" : unit},
                {"groups", groups},
                {"warnings", warnings},
                {"notes", notes}};
  found.text = unit.empty() ? fmt::format("mesh {}\n{}", file.string(), UnitlessText(report))
                            : fmt::format("mesh {}, lengths read as {}\n{}", file.string(), unit,
                                          fem::ToText(report));
  for (const fem::CellGroup& group : mesh.groups) {
    found.text += fmt::format("  group '{}': {} cells\n", group.name, group.cells.size());
  }
  for (const std::string& warning : warnings) found.text += "warning: " + warning + "\n";
  for (const std::string& note : notes) found.text += "note: " + note + "\n";
  return found;
}

Findings DescribeFile(const std::filesystem::path& file, const FileKind& kind) {
  Findings found;
  if (kind.family == Family::kCapture) found = DescribeCapture(file);
  if (kind.family == Family::kCloud) found = DescribeCloud(file);
  found.json["file"] = file.string();
  found.json["kind"] = kind.name;
  found.json["advice"] = kind.advice;
  found.text = fmt::format("{}: {}; {}\n", file.string(), kind.name, kind.advice) + found.text;
  return found;
}

Findings DescribeTumFolder(const std::filesystem::path& folder) {
  const experiment::RgbdSequence images = experiment::OpenTumFolder(folder, app::LoadYaml);
  const bool colored = !images.frames.front().color.empty();
  const double duration_s =
      1e-9 * static_cast<double>(images.frames.back().t_ns - images.frames.front().t_ns);
  Findings found;
  found.json = {{"file", folder.string()},
                {"kind", "TUM RGB-D folder"},
                {"frames", images.frames.size()},
                {"colored", colored},
                {"duration_s", duration_s}};
  found.text = fmt::format(
      "{}: TUM RGB-D folder; palpate-capture --replay plays it\n"
      "  {} depth images in {:.3g} s, {}\n",
      folder.string(), images.frames.size(), duration_s,
      colored ? fmt::format("with colour ({} without a colour image near in time)", images.unpaired)
              : std::string("without colour"));
  return found;
}

}  // namespace palpate::command

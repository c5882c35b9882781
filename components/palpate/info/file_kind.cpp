// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/info/file_kind.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <optional>
#include <string_view>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace palpate::command {

namespace {

using experiment::CaptureKind;
using fem::MeshKind;
using Family = FileKind::Family;

constexpr std::size_t kHeadSize = 1024;

struct KnownFile {
  std::string_view magic;    ///< of the first bytes; empty: by the ending alone
  std::string_view endings;  ///< " .stl .STL " with blanks around; empty: by the magic alone
  std::string_view name;
  std::string_view advice;
};

constexpr std::string_view kMeshIt =
    "it holds surfaces: mesh the body with tetrahedra first, with Gmsh or Netgen";
constexpr std::string_view kExportIt =
    "export or record it as MCAP, or as images, clouds or markers of an experiment folder";
constexpr std::string_view kNoVerb = "no verb takes it";

/// Kinds that people bring and no verb takes.
constexpr std::array kOthers = std::to_array<KnownFile>({
    {"solid ", " .stl ", "STL surface", kMeshIt},
    {"", " .stl ", "STL surface", kMeshIt},
    {"", " .obj ", "Wavefront OBJ surface", kMeshIt},
    {"OFF", " .off ", "OFF surface", kMeshIt},
    {"ISO-10303-21", "", "STEP geometry", kMeshIt},
    {"", " .step .stp .iges .igs .brep ", "CAD geometry", kMeshIt},
    {"", " .geo ", "geometry for Gmsh", "mesh it first: gmsh -3 FILE"},
    {"    -1\n", " .unv ", "I-DEAS universal file", "convert the mesh to .msh or .vtu (meshio)"},
    {"", " .unv ", "I-DEAS universal file", "convert the mesh to .msh or .vtu (meshio)"},
    {"MFEM mesh", "", "MFEM mesh", "convert the mesh to .msh or .vtu (meshio)"},
    {"mesh3d", " .vol ", "Netgen mesh", "save it from Netgen as Gmsh 2 (.msh)"},
    {"", " .meshb ", "binary Medit mesh", "save it as text (.mesh)"},
    {"", " .pvtu .pvd ", "list of VTK meshes", "give the .vtu file of one piece"},
    {"\x89HDF", " .h5 .hdf5 .med .exo ", "HDF5 file", kNoVerb},
    {"", " .xdmf ", "XDMF mesh", "convert the mesh to .vtu (meshio)"},
    {"#ROSBAG V", " .bag ", "ROS 1 bag", "convert it to MCAP (mcap convert)"},
    {"", " .svo .svo2 ", "recording of a ZED camera", kExportIt},
    {"", " .zdf ", "Zivid frame", "export it as PLY, and give the cloud"},
    {"", " .mkv .mp4 .avi .mov ", "video", kExportIt},
    {"MATLAB 5.0", " .mat ", "MATLAB file",
     "write tables of it (writetable) in an experiment folder"},
    {"PK\x03\x04", " .npz .xlsx .zip .3mf ", "ZIP archive", "unpack it, or save its table as CSV"},
    {"\x93NUMPY", " .npy ", "NumPy array", "write it as the CSV of an experiment folder"},
    {"%PDF", " .pdf ", "PDF document", kNoVerb},
    {"{", " .json ", "JSON file", kNoVerb},
});

std::string ReadHead(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(kHeadSize, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (stream.bad() || (stream.fail() && !stream.eof())) {
    throw InputError(SourceLocation{file.string()}, "cannot be read");
  }
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

std::string LowerCaseEnding(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

bool IsText(std::string_view bytes) {
  return std::none_of(bytes.begin(), bytes.end(),
                      [](unsigned char c) { return c == 0 || (c < 0x20 && std::isspace(c) == 0); });
}

std::optional<FileKind> ImageOrCloud(std::string_view head, const std::string& ending) {
  FileKind kind;
  if (head.starts_with("ply\n") || head.starts_with("ply\r\n") || ending == ".ply") {
    kind = {.family = Family::kCloud, .name = "PLY point cloud", .advice = {}};
  } else if (head.starts_with("# .PCD") || ending == ".pcd") {
    kind = {.family = Family::kCloud, .name = "PCD point cloud", .advice = {}};
  } else if (head.starts_with("\x89PNG")) {
    kind = {.family = Family::kImage, .name = "PNG image", .advice = {}};
  } else if (head.starts_with("\xff\xd8\xff")) {
    kind = {.family = Family::kImage, .name = "JPEG image", .advice = {}};
  } else {
    return std::nullopt;
  }
  kind.advice = kind.family == Family::kCloud
                    ? "put clouds in clouds/ of a recording, their times as their names, beside "
                      "camera.yaml"
                    : "put images in depth/ or color/ of a recording, their times as their names, "
                      "beside camera.yaml";
  return kind;
}

std::optional<FileKind> Other(std::string_view head, const std::string& ending) {
  for (const KnownFile& known : kOthers) {
    const bool by_magic = !known.magic.empty() && head.starts_with(known.magic);
    const bool by_ending = known.magic.empty() && !ending.empty() &&
                           known.endings.find(" " + ending + " ") != std::string_view::npos;
    if (!by_magic && !by_ending) continue;
    return FileKind{.family = Family::kOther,
                    .name = std::string(known.name),
                    .advice = std::string(known.advice)};
  }
  return std::nullopt;
}

/// The first line of a table; of UTF-16 the letters that ASCII has.
std::string FirstLine(std::string_view head) {
  std::string line(head.substr(0, head.find('\n')));
  std::erase(line, '\0');
  return line;
}

/// A table that is no motion capture; no kind where the first line has one column.
FileKind OtherTable(const std::string& first_line) {
  if (first_line.find_first_of(",;\t") == std::string::npos) return {};
  if (first_line.find("fx_N") != std::string::npos &&
      first_line.find("contact") != std::string::npos) {
    return {.family = Family::kOther,
            .name = "table of forces",
            .advice =
                "palpate compare compares two of them, and palpate view shows it with "
                "--results"};
  }
  return {.family = Family::kOther,
          .name = "table",
          .advice =
              "no verb takes it alone: actuation.csv and loads.csv belong in a recording, and "
              "palpate import takes columns t_s, marker, x_m, y_m, z_m"};
}

/// An ending decides only between kinds that are text, or where the bytes say nothing.
bool EndsAsSettings(const std::string& ending) {
  return ending == ".yaml" || ending == ".yml" || ending.empty();
}

}  // namespace

FileKind KindOf(const std::filesystem::path& file) {
  const std::string head = ReadHead(file);
  const std::string ending = LowerCaseEnding(file);
  if (auto kind = ImageOrCloud(head, ending)) return *kind;
  if (EndsAsSettings(ending) && IsText(head))
    return {.family = Family::kSettings, .name = {}, .advice = {}};
  if (const MeshKind mesh = fem::KindOfMesh(file, head); mesh != MeshKind::kNone) {
    return {.family = Family::kMesh,
            .mesh = mesh,
            .name = ToString(mesh) + " mesh",
            .advice = "name it in a robot file: mesh: {file: ..., unit: mm}"};
  }
  const CaptureKind capture = experiment::KindOfCapture(file);
  const std::string first_line = FirstLine(head);
  const bool names_markers = first_line.find("marker") != std::string::npos;
  if (capture == CaptureKind::kTable && !names_markers) return OtherTable(first_line);
  if (capture != CaptureKind::kNone) {
    return {.family = Family::kCapture,
            .capture = capture,
            .name = ToString(capture),
            .advice = "palpate import makes a recording of it"};
  }
  if (auto kind = Other(head, ending)) return *kind;
  return {};
}

std::string BeginningOf(const std::filesystem::path& file) {
  const std::string head = ReadHead(file);
  if (head.empty()) return "nothing";
  return IsText(head) ? "'" + Excerpt(head) + "'" : "binary data";
}

}  // namespace palpate::command

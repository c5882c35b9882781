// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/solve_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

#include "components/palpate/robot_scene.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/text.hpp"
#include "libs/fem/mesh_io/write_vtu.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

void MakeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw RunError(
        "cannot create the folder " + folder.string() + ": " +
        (error ? error.message() : "a file has that name; remove it or give another --out"));
  }
}

void RemoveOldResults(const std::filesystem::path& folder) {
  const std::regex ours(
      "nodes_[0-9]{4,}\\.csv|body_[0-9]{4,}\\.vtu|scene_[0-9]{4,}\\.png|cables\\.csv|result\\."
      "json");
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), ours)) {
      old.push_back(entry.path());
    }
  }
  for (const std::filesystem::path& file : old) {
    std::filesystem::remove(file);
  }
}

std::string NodesText(const Eigen::VectorXd& x_m) {
  std::string text = "node,x_m,y_m,z_m\n";
  for (Eigen::Index node = 0; 3 * node < x_m.size(); ++node) {
    text += std::to_string(node);
    for (int axis = 0; axis < 3; ++axis) {
      text += "," + FormatNumber(x_m(3 * node + axis));
    }
    text += "\n";
  }
  return text;
}

fem::VtuFields DisplacementField(const robot::RobotModel& model, const Eigen::VectorXd& x_m) {
  const Eigen::Matrix3Xd& rest_m = model.body().mesh.nodes_m;
  const Eigen::Map<const Eigen::Matrix3Xd> now_m(x_m.data(), 3, x_m.size() / 3);
  return {.of_nodes = {{"displacement_m", now_m - rest_m}}, .of_cells = {}};
}

}  // namespace

SolveOutput::SolveOutput(std::filesystem::path folder, const robot::RobotModel& model,
                         const Extras& extras)
    : folder_(std::move(folder)),
      model_(model),
      extras_(extras),
      cables_text_("row,cable,displacement_m,tension_N\n") {
  MakeFolder(folder_);
  RemoveOldResults(folder_);
}

std::filesystem::path SolveOutput::RowFile(const char* stem, int row, const char* extension) const {
  return folder_ / fmt::format("{}_{:04d}.{}", stem, row, extension);
}

void SolveOutput::Add(const RowResult& result) {
  if (result.converged()) {
    WriteFile(RowFile("nodes", result.row, "csv"), NodesText(result.x_m));
    if (extras_.vtu) {
      fem::WriteVtu(RowFile("body", result.row, "vtu"), model_.body().mesh, result.x_m,
                    DisplacementField(model_, result.x_m));
    }
    if (extras_.png) {
      Draw(result);
    }
  }
  AddCables(result);
  rows_.push_back({result.row, result.t_s, result.solver, result.time_s, result.notes});
}

void SolveOutput::Draw(const RowResult& result) const {
  view::Scene scene = MakeRobotScene(model_, result.x_m);
  scene.title = fmt::format("{}, row {} (t = {:g} s)", model_.body().name, result.row, result.t_s);
  std::string cables;
  for (std::size_t c = 0; c < result.cables.size(); ++c) {
    cables +=
        fmt::format("{}{} {:.1f} mm {:.2f} N", c == 0 ? "" : ", ", model_.body().cables[c].name,
                    1e3 * result.cables[c].displacement_m, result.cables[c].tension_N);
  }
  scene.caption = {cables};
  view::SaveScene(RowFile("scene", result.row, "png"), scene);
}

void SolveOutput::AddCables(const RowResult& result) {
  for (int c = 0; c < model_.CableCount(); ++c) {
    const auto index = static_cast<std::size_t>(c);
    cables_text_ += std::to_string(result.row) + "," + model_.body().cables[index].name + ",";
    if (result.converged()) {
      const robot::CableState& cable = result.cables[index];
      cables_text_ += FormatNumber(cable.displacement_m) + "," + FormatNumber(cable.tension_N);
    } else {
      cables_text_ += ",";
    }
    cables_text_ += "\n";
  }
}

std::string SolveOutput::Finish(const std::vector<std::string>& notes) {
  Json rows = Json::array();
  int iterations = 0;
  double residual_N = 0.0;
  double time_s = 0.0;
  bool converged = true;
  for (const RowSummary& row : rows_) {
    rows.push_back({{"row", row.row},
                    {"t_s", row.t_s},
                    {"converged", row.solver.status.ok()},
                    {"status", ToString(row.solver.status.code())},
                    {"message", row.solver.status.message()},
                    {"iterations", row.solver.iterations},
                    {"load_steps", row.solver.load_steps},
                    {"load_fraction", row.solver.load_fraction},
                    {"residual_N", row.solver.residual_N},
                    {"residual_relative", row.solver.residual_relative},
                    {"time_s", row.time_s},
                    {"notes", row.notes}});
    iterations += row.solver.iterations;
    residual_N = std::max(residual_N, row.solver.residual_N);
    time_s += row.time_s;
    converged = converged && row.solver.status.ok();
  }
  const robot::RobotBody& body = model_.body();
  const Json result = {{"palpate", app::Version()},
                       {"robot", body.name},
                       {"mesh_hash", body.mesh_hash},
                       {"element", body.mesh.cells.rows() == 10 ? "tet10" : "tet4"},
                       {"converged", converged},
                       {"iterations", iterations},
                       {"residual_N", residual_N},
                       {"time_s", time_s},
                       {"rows", rows},
                       {"notes", notes}};
  const std::string text = result.dump(2) + "\n";
  WriteFile(folder_ / "cables.csv", cables_text_);
  WriteFile(folder_ / "result.json", text);
  return text;
}

}  // namespace palpate::command

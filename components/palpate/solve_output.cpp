// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/palpate/solve_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "components/palpate/robot_scene.hpp"
#include "components/palpate/solve_files.hpp"
#include "libs/app/version.hpp"
#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/core/index.hpp"
#include "libs/core/text.hpp"
#include "libs/experiment/folders.hpp"
#include "libs/fem/cell_stress.hpp"
#include "libs/fem/mesh_io/write_vtu.hpp"

namespace palpate::command {

namespace {

using Json = nlohmann::ordered_json;

std::string RowFile(const char* stem, int row, const char* extension) {
  return fmt::format("{}_{:04d}.{}", stem, row, extension);
}

std::vector<std::string> PlannedFiles(const robot::RobotModel& model, const Extras& extras,
                                      int row_count) {
  std::vector<std::string> files = {"result.json", "cables.csv"};
  if (model.ChamberCount() > 0) files.emplace_back("chambers.csv");
  if (!model.body().markers.empty()) files.emplace_back("markers.csv");
  if (extras.vtu) files.emplace_back("body.pvd");
  for (int row = 0; row < row_count; ++row) {
    files.push_back(RowFile("nodes", row, "csv"));
    if (extras.vtu) files.push_back(RowFile("body", row, "vtu"));
    if (extras.vtu && model.CableCount() > 0) files.push_back(RowFile("cables", row, "vtu"));
    if (extras.png) files.push_back(RowFile("scene", row, "png"));
  }
  return files;
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

/// Displacement and load of each node, stress and strain of each element.
fem::VtuFields BodyFields(const robot::RobotBody& body, const RowResult& result) {
  const Eigen::Map<const Eigen::Matrix3Xd> now_m(result.x_m.data(), 3, result.x_m.size() / 3);
  Eigen::Matrix3Xd load_N = Eigen::Matrix3Xd::Zero(3, now_m.cols());
  for (const robot::DeadLoad& load : result.loads) {
    for (std::size_t k = 0; k < load.weights.nodes.size(); ++k) {
      load_N.col(load.weights.nodes[k]) += load.weights.weights[k] * load.force_N;
    }
  }
  const fem::CellStress stress =
      fem::EvaluateCellStress(body.mesh, body.materials, body.material_of_cell, result.x_m);
  return {.of_nodes = {{"displacement_m", now_m - body.mesh.nodes_m}, {"load_N", load_N}},
          .of_cells = {{"von_mises_stress_Pa", stress.von_mises_Pa.transpose()},
                       {"largest_principal_strain", stress.largest_strain.transpose()}}};
}

/// Path, tension and displacement of each cable; points are undeformed, as those of the body.
void WriteCables(const std::filesystem::path& file, const robot::RobotModel& model,
                 const RowResult& result) {
  const int count = model.CableCount();
  std::vector<Eigen::Matrix3Xd> paths_m;
  Eigen::Matrix3Xd displacement_m(3, 0);
  Eigen::RowVectorXd tension_N(count);
  Eigen::RowVectorXd pulled_m(count);
  for (int c = 0; c < count; ++c) {
    const Eigen::Matrix3Xd now_m = model.cable(c).Path_m(result.x_m);
    paths_m.push_back(model.cable(c).Path_m(model.RestState().x_m));
    displacement_m.conservativeResize(3, displacement_m.cols() + now_m.cols());
    displacement_m.rightCols(now_m.cols()) = now_m - paths_m.back();
    tension_N[c] = result.actuators[At(c)].tension_N;
    pulled_m[c] = result.actuators[At(c)].displacement_m;
  }
  fem::WriteVtuLines(file, paths_m,
                     {.of_nodes = {{"displacement_m", displacement_m}},
                      .of_cells = {{"tension_N", tension_N}, {"cable_displacement_m", pulled_m}}});
}

/// An arrow for each load, the largest 0.3 of the body's diagonal long.
void AddLoads(const RowResult& result, const robot::RobotBody& body, view::Scene* scene) {
  double largest_N = 0.0;
  for (const robot::DeadLoad& load : result.loads) {
    largest_N = std::max(largest_N, load.force_N.norm());
  }
  if (!(largest_N > 0.0)) return;
  const double metres_per_newton = 0.3 * BodyDiagonal_m(body) / largest_N;
  for (const robot::DeadLoad& load : result.loads) {
    AddForce(load.weights.Position(result.x_m), load.force_N, metres_per_newton,
             view::palette::kTruth, fmt::format("{:.3g} N", load.force_N.norm()), scene);
  }
  scene->legend.push_back({view::LegendEntry::Mark::kLine, view::palette::kTruth, "loads"});
}

}  // namespace

SolveOutput::SolveOutput(std::filesystem::path folder, const robot::RobotModel& model,
                         const Extras& extras, int row_count)
    : folder_(std::move(folder)),
      model_(model),
      extras_(extras),
      cables_text_("row,cable,displacement_m,tension_N\n"),
      chambers_text_("row,chamber,pressure_Pa,volume_m3\n") {
  markers_.names = model.MarkerNames();
  MakeRoomForResults(folder_, PlannedFiles(model, extras, row_count));
  experiment::CreateFolder(folder_);
}

std::filesystem::path SolveOutput::File(const std::string& name) {
  files_.push_back(name);
  return folder_ / name;
}

void SolveOutput::Add(const RowResult& result) {
  if (result.converged()) {
    WriteFile(File(RowFile("nodes", result.row, "csv")), NodesText(result.x_m));
    if (extras_.vtu) WriteBody(result);
    if (extras_.png) Draw(result);
    AddMarkers(result);
  }
  AddActuators(result);
  rows_.push_back({result.row, result.t_s, result.solver, result.time_s, result.notes});
}

/// Points are undeformed: ParaView's Warp By Vector deforms them by displacement_m.
void SolveOutput::WriteBody(const RowResult& result) {
  const robot::RobotBody& body = model_.body();
  fem::WriteVtu(File(RowFile("body", result.row, "vtu")), body.mesh, body.mesh.nodes_m.reshaped(),
                BodyFields(body, result));
  if (model_.CableCount() == 0) return;
  WriteCables(File(RowFile("cables", result.row, "vtu")), model_, result);
}

void SolveOutput::Draw(const RowResult& result) {
  view::Scene scene = MakeRobotScene(model_, result.x_m);
  scene.title = fmt::format("{}, row {} (t = {:g} s)", model_.body().name, result.row, result.t_s);
  std::string actuators;
  for (std::size_t a = 0; a < result.actuators.size(); ++a) {
    actuators += (a == 0 ? "" : ", ") +
                 ActuatorText(model_.traits(static_cast<int>(a)), result.actuators[a]);
  }
  scene.caption = {actuators};
  AddLoads(result, model_.body(), &scene);
  view::SaveScene(File(RowFile("scene", result.row, "png")), scene);
}

void SolveOutput::AddMarkers(const RowResult& result) {
  experiment::MarkerFrame frame;
  frame.t_s = result.t_s;
  for (const robot::BodyMarker& marker : model_.body().markers) {
    frame.positions_m.emplace_back(marker.point.weights.Position(result.x_m));
  }
  markers_.frames.push_back(std::move(frame));
}

void SolveOutput::AddActuators(const RowResult& result) {
  for (int a = 0; a < model_.ActuatorCount(); ++a) {
    const robot::ActuatorTraits& traits = model_.traits(a);
    std::string displacement, force;
    if (result.converged()) {
      const robot::ActuatorState& state = result.actuators[At(a)];
      displacement = FormatNumber(traits.ReportedDisplacement(state.displacement_m));
      force = FormatNumber(traits.ReportedForce(state.tension_N));
    }
    const std::string begin = std::to_string(result.row) + "," + traits.name + ",";
    if (traits.IsChamber()) {
      chambers_text_ += begin + force + "," + displacement + "\n";
    } else {
      cables_text_ += begin + displacement + "," + force + "\n";
    }
  }
}

void SolveOutput::WriteTables() {
  WriteFile(File("cables.csv"), cables_text_);
  if (model_.ChamberCount() > 0) WriteFile(File("chambers.csv"), chambers_text_);
  if (!markers_.names.empty() && !markers_.frames.empty()) {
    experiment::WriteMarkers(markers_, File("markers.csv"));
  }
  if (!extras_.vtu) return;
  std::string steps;
  for (const RowSummary& row : rows_) {
    if (!row.solver.status.ok()) continue;
    const int parts = model_.CableCount() > 0 ? 2 : 1;
    for (int part = 0; part < parts; ++part) {
      steps +=
          fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", FormatNumber(row.t_s),
                      part, RowFile(part == 0 ? "body" : "cables", row.row, "vtu"));
    }
  }
  WriteFile(File("body.pvd"),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" "
            "version=\"0.1\">\n<Collection>\n" +
                steps + "</Collection>\n</VTKFile>\n");
}

std::string SolveOutput::Finish(const std::vector<std::string>& notes, bool interrupted) {
  WriteTables();
  Json rows = Json::array();
  int iterations = 0;
  double residual_N = 0.0;
  double time_s = 0.0;
  bool converged = !interrupted;
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
  const std::filesystem::path file = File("result.json");
  const robot::RobotBody& body = model_.body();
  const Json result = {{"palpate", app::Version()},
                       {"robot", body.name},
                       {"mesh_hash", body.mesh_hash},
                       {"element", body.mesh.cells.rows() == 10 ? "tet10" : "tet4"},
                       {"converged", converged},
                       {"interrupted", interrupted},
                       {"iterations", iterations},
                       {"residual_N", residual_N},
                       {"time_s", time_s},
                       {"rows", rows},
                       {"warnings", body.warnings},
                       {"notes", notes},
                       {"files", files_}};
  const std::string text = result.dump(2) + "\n";
  WriteFile(file, text);
  return text;
}

}  // namespace palpate::command

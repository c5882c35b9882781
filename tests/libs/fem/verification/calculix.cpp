// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/verification/calculix.hpp"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace palpate::fem::verification {

namespace {

namespace fs = std::filesystem;

/// A folder that lives as long as this object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "palpate_ccx_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no folder " + pattern);
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string EndOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  const std::string all = text.str();
  return all.substr(all.size() - std::min<size_t>(all.size(), 1000));
}

void WriteMesh(const TetMesh& mesh, std::ostream& out) {
  out << "*NODE, NSET=NALL\n";
  for (int n = 0; n < mesh.NodeCount(); ++n) {
    out << n + 1 << ',' << mesh.nodes_m(0, n) << ',' << mesh.nodes_m(1, n) << ','
        << mesh.nodes_m(2, n) << '\n';
  }
  // C3D10 numbers its mid-edge nodes 01 12 02 03 13 23, as we do.
  out << "*ELEMENT, ELSET=BODY, TYPE=C3D" << mesh.cells.rows() << '\n';
  for (int c = 0; c < mesh.CellCount(); ++c) {
    out << c + 1;
    for (Eigen::Index k = 0; k < mesh.cells.rows(); ++k) out << ',' << mesh.cells(k, c) + 1;
    out << '\n';
  }
}

/// Pressures follow the faces, but lag behind by a share of the increment (ccx 2.20), so that these
/// are kept small. The residual may be 1e-8 of
/// the forces instead of 0.5 %.
void WritePressures(const std::vector<FacePressure>& pressures, std::ostream& out) {
  if (pressures.empty()) return;
  // Faces 1-2-3, 1-4-2, 2-4-3, 3-4-1 of a tetrahedron, by the corner that they leave out.
  constexpr std::array<int, 4> kFaceOpposite{3, 4, 2, 1};
  out << "*CONTROLS, PARAMETERS=FIELD\n1.e-8,1.e-8\n*DLOAD\n";
  for (const FacePressure& one : pressures) {
    out << one.cell + 1 << ",P" << kFaceOpposite[static_cast<size_t>(one.opposite_corner)] << ','
        << one.pressure_Pa << '\n';
  }
}

}  // namespace

std::optional<fs::path> FindCalculix() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder) / "ccx";
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return std::nullopt;
}

void WriteCalculixInput(const StaticProblem& problem, const fs::path& file) {
  std::ofstream out(file);
  out.precision(12);  // ccx reads 20 characters of a number and drops the rest
  WriteMesh(problem.mesh, out);
  const double mu = problem.material.LameMu_Pa();
  const double bulk = problem.material.LameLambda_Pa() + 2.0 / 3.0 * mu;
  out << "*MATERIAL, NAME=SOLID\n*HYPERELASTIC, NEO HOOKE\n"
      << mu / 2.0 << ',' << 2.0 / bulk
      << "\n*SOLID SECTION, ELSET=BODY, MATERIAL=SOLID\n*BOUNDARY\n";
  for (Eigen::Index n = 0; n < problem.fixed.cols(); ++n) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (problem.fixed(i, n)) out << n + 1 << ',' << i + 1 << '\n';
    }
  }
  out << (problem.pressures.empty() ? "*STEP, NLGEOM\n*STATIC\n0.25,1.\n"
                                    : "*STEP, NLGEOM, INC=1000\n*STATIC, DIRECT\n0.05,1.\n")
      << "*CLOAD\n";
  for (Eigen::Index k = 0; k < problem.external_force_N.size(); ++k) {
    const double force = problem.external_force_N[k];
    if (force != 0.0) out << k / 3 + 1 << ',' << k % 3 + 1 << ',' << force << '\n';
  }
  WritePressures(problem.pressures, out);
  out << "*NODE PRINT, NSET=NALL, FREQUENCY=1000\nU\n*END STEP\n";
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

Eigen::VectorXd ReadCalculixDisplacements(const fs::path& file, int node_count) {
  Eigen::VectorXd u_m = Eigen::VectorXd::Zero(3 * node_count);
  int found = 0;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.find("displacements") != std::string::npos) found = 0;
    std::istringstream row(line);
    int node = 0;
    Eigen::Vector3d u;
    if (row >> node >> u[0] >> u[1] >> u[2] && node >= 1 && node <= node_count) {
      u_m.segment<3>(3 * (node - 1)) = u;
      ++found;
    }
  }
  if (found != node_count) {
    throw std::runtime_error(file.string() + " has " + std::to_string(found) + " of " +
                             std::to_string(node_count) + " nodes");
  }
  return u_m;
}

Eigen::VectorXd SolveWithCalculix(const fs::path& ccx, const StaticProblem& problem) {
  const TemporaryFolder folder;
  WriteCalculixInput(problem, folder.path() / "job.inp");
  const std::string command = "cd '" + folder.path().string() + "' && OMP_NUM_THREADS=1 '" +
                              ccx.string() + "' -i job > log.txt 2>&1";
  const int exit_status = std::system(command.c_str());
  const std::string log = EndOf(folder.path() / "log.txt");
  if (exit_status != 0 || log.find("Job finished") == std::string::npos) {
    throw std::runtime_error("ccx found no solution: " + log);
  }
  return ReadCalculixDisplacements(folder.path() / "job.dat", problem.mesh.NodeCount());
}

}  // namespace palpate::fem::verification

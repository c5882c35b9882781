// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/system/independent/calculix_body.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "tests/support/test_folder.hpp"

namespace palpate::test_support {

namespace {

using Positions = CalculixBody::Positions;

constexpr int kSamples = 12;  // along each side of a face, of a pressure

// Mid-edge nodes of a tetrahedron, in CalculiX' order.
constexpr std::array<std::pair<int, int>, 6> kEdges = {
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::array<std::array<int, 3>, 4> kSides = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

std::array<double, 6> ShapeFunctions(const std::array<double, 3>& l) {
  return {l[0] * (2 * l[0] - 1), l[1] * (2 * l[1] - 1), l[2] * (2 * l[2] - 1),
          4 * l[0] * l[1],       4 * l[1] * l[2],       4 * l[2] * l[0]};
}

// CalculiX reads the first 20 characters of a number.
std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.11e", value);
  return text;
}

Positions ReadDisplacements(const std::filesystem::path& file, std::size_t count) {
  std::ifstream stream(file);
  Positions moved(count, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  std::string line;
  while (std::getline(stream, line)) {
    std::istringstream row(line);
    std::size_t node = 0;
    Eigen::Vector3d u;
    if (row >> node >> u.x() >> u.y() >> u.z() && node >= 1 && node <= count) moved[node - 1] = u;
  }
  return moved;
}

}  // namespace

CalculixBody::CalculixBody(Positions corners_mm, const std::vector<std::array<int, 4>>& tetrahedra,
                           const Material& material)
    : nodes_mm_(std::move(corners_mm)), material_(material) {
  std::map<std::pair<int, int>, int> middle;
  const auto middle_of = [&](int a, int b) {
    const auto [at, is_new] =
        middle.try_emplace(std::minmax(a, b), static_cast<int>(nodes_mm_.size()));
    if (is_new) {
      nodes_mm_.push_back(
          0.5 * (nodes_mm_[static_cast<std::size_t>(a)] + nodes_mm_[static_cast<std::size_t>(b)]));
    }
    return at->second;
  };
  std::map<std::array<int, 3>, std::pair<std::array<int, 3>, int>> sides;
  for (const std::array<int, 4>& corner : tetrahedra) {
    std::array<int, 10> cell = {};
    std::copy(corner.begin(), corner.end(), cell.begin());
    for (std::size_t e = 0; e < kEdges.size(); ++e) {
      cell[4 + e] = middle_of(corner[static_cast<std::size_t>(kEdges[e].first)],
                              corner[static_cast<std::size_t>(kEdges[e].second)]);
    }
    cells_.push_back(cell);
    for (const auto& side : kSides) {
      const std::array<int, 3> face = {corner[static_cast<std::size_t>(side[0])],
                                       corner[static_cast<std::size_t>(side[1])],
                                       corner[static_cast<std::size_t>(side[2])]};
      std::array<int, 3> key = face;
      std::sort(key.begin(), key.end());
      auto& entry = sides.try_emplace(key, face, 0).first->second;
      ++entry.second;
    }
  }
  for (const auto& [key, side] : sides) {
    if (side.second != 1) continue;
    const auto& [a, b, c] = side.first;
    faces_.push_back({a, b, c, middle_of(a, b), middle_of(b, c), middle_of(c, a)});
  }
}

CalculixBody CalculixBody::FromGmsh(const std::filesystem::path& file, const Material& material) {
  std::ifstream stream(file);
  std::string word;
  const auto seek = [&](const std::string& section) {
    while (stream >> word && word != section) {
    }
    if (!stream) throw std::runtime_error(file.string() + ": no " + section);
  };
  seek("$Nodes");
  std::size_t blocks = 0, count = 0, low = 0, high = 0;
  stream >> blocks >> count >> low >> high;
  Positions nodes;
  std::map<std::size_t, int> index_of;
  for (std::size_t b = 0; b < blocks; ++b) {
    int dimension = 0, tag = 0, parametric = 0;
    std::size_t in_block = 0;
    stream >> dimension >> tag >> parametric >> in_block;
    std::vector<std::size_t> tags(in_block);
    for (std::size_t& t : tags) stream >> t;
    for (const std::size_t t : tags) {
      Eigen::Vector3d x;
      stream >> x.x() >> x.y() >> x.z();
      index_of[t] = static_cast<int>(nodes.size());
      nodes.push_back(x);
    }
  }
  seek("$Elements");
  stream >> blocks >> count >> low >> high;
  std::vector<std::array<int, 4>> tetrahedra;
  for (std::size_t b = 0; b < blocks; ++b) {
    int dimension = 0, tag = 0, type = 0;
    std::size_t in_block = 0;
    stream >> dimension >> tag >> type >> in_block;
    if (type != 4) throw std::runtime_error(file.string() + ": not all elements are tetrahedra");
    for (std::size_t k = 0; k < in_block; ++k) {
      std::size_t t = 0, n[4];
      stream >> t >> n[0] >> n[1] >> n[2] >> n[3];
      tetrahedra.push_back({index_of[n[0]], index_of[n[1]], index_of[n[2]], index_of[n[3]]});
    }
  }
  return CalculixBody(std::move(nodes), tetrahedra, material);
}

CalculixBody CalculixBody::Bar(const Eigen::Vector3d& low_mm, const Eigen::Vector3d& high_mm,
                               const std::array<int, 3>& cells, const Material& material) {
  Positions nodes;
  const auto index = [&](int i, int j, int k) {
    return (i * (cells[1] + 1) + j) * (cells[2] + 1) + k;
  };
  for (int i = 0; i <= cells[0]; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int k = 0; k <= cells[2]; ++k) {
        const Eigen::Vector3d share(double(i) / cells[0], double(j) / cells[1],
                                    double(k) / cells[2]);
        nodes.push_back(low_mm + share.cwiseProduct(high_mm - low_mm));
      }
    }
  }
  std::vector<std::array<int, 4>> tetrahedra;
  std::array<int, 3> axes = {0, 1, 2};
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int k = 0; k < cells[2]; ++k) {
        std::sort(axes.begin(), axes.end());
        do {  // Kuhn's six: a path along the axes from one corner to the opposite one
          std::array<int, 3> at = {i, j, k};
          std::array<int, 4> cell = {index(i, j, k)};
          for (std::size_t s = 0; s < 3; ++s) {
            ++at[static_cast<std::size_t>(axes[s])];
            cell[s + 1] = index(at[0], at[1], at[2]);
          }
          const auto x = [&](int n) { return nodes[static_cast<std::size_t>(n)]; };
          const Eigen::Vector3d a = x(cell[1]) - x(cell[0]);
          if (a.cross(x(cell[2]) - x(cell[0])).dot(x(cell[3]) - x(cell[0])) < 0.0) {
            std::swap(cell[2], cell[3]);
          }
          tetrahedra.push_back(cell);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  return CalculixBody(std::move(nodes), tetrahedra, material);
}

void CalculixBody::Fix(const std::function<bool(const Eigen::Vector3d&)>& is_fixed) {
  fixed_.clear();
  for (std::size_t n = 0; n < nodes_mm_.size(); ++n) {
    if (is_fixed(nodes_mm_[n])) fixed_.push_back(static_cast<int>(n));
  }
}

Positions CalculixBody::Solve(const Loads& loads) const {
  const TestFolder folder;
  std::ofstream deck(folder / "job.inp");
  deck << "*NODE, NSET=NALL\n";
  for (std::size_t n = 0; n < nodes_mm_.size(); ++n) {
    const Eigen::Vector3d& x = nodes_mm_[n];
    deck << n + 1 << "," << Number(x.x()) << "," << Number(x.y()) << "," << Number(x.z()) << "\n";
  }
  deck << "*ELEMENT, TYPE=C3D10, ELSET=BODY\n";
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    deck << c + 1;
    for (const int node : cells_[c]) deck << "," << node + 1;
    deck << "\n";
  }
  const double mu = material_.youngs_modulus_MPa / (2.0 * (1.0 + material_.poissons_ratio));
  const double bulk = material_.youngs_modulus_MPa / (3.0 * (1.0 - 2.0 * material_.poissons_ratio));
  deck << "*MATERIAL, NAME=SOLID\n*HYPERELASTIC, NEO HOOKE\n"
       << Number(0.5 * mu) << "," << Number(2.0 / bulk) << "\n*DENSITY\n"
       << Number(material_.density_t_mm3) << "\n"
       << "*SOLID SECTION, ELSET=BODY, MATERIAL=SOLID\n*BOUNDARY\n";
  for (const int node : fixed_) deck << node + 1 << ",1,3\n";
  deck << "*STEP, NLGEOM, INC=40\n*STATIC\n0.25,1.,1e-5,1.\n*DLOAD\nBODY,GRAV,9810.,0.,0.,-1.\n";
  if (!loads.empty()) deck << "*CLOAD\n";
  for (const auto& [node, force_N] : loads) {
    for (int axis = 0; axis < 3; ++axis) {
      deck << node + 1 << "," << axis + 1 << "," << Number(force_N[axis]) << "\n";
    }
  }
  deck << "*NODE PRINT, NSET=NALL, FREQUENCY=1000\nU\n*END STEP\n";
  deck.close();
  const std::string command = "cd '" + folder.path().string() + "' && ccx -i job > log 2>&1";
  const int exit = std::system(command.c_str());
  Positions moved = ReadDisplacements(folder / "job.dat", nodes_mm_.size());
  for (std::size_t n = 0; n < moved.size(); ++n) {
    if (exit != 0 || !moved[n].allFinite()) throw std::runtime_error("ccx found no equilibrium");
    moved[n] += nodes_mm_[n];
  }
  return moved;
}

Eigen::Vector3d CalculixBody::At(const SurfacePoint& point, const Positions& positions_mm) const {
  const std::array<double, 6> shape = ShapeFunctions(point.barycentric);
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 6; ++i) {
    at += shape[i] * positions_mm[static_cast<std::size_t>(faces_[point.face][i])];
  }
  return at;
}

Eigen::Vector3d CalculixBody::NormalAt(const SurfacePoint& point,
                                       const Positions& positions_mm) const {
  constexpr double kStep = 0.05;
  const auto at = [&](double b, double c) {
    const auto& l = point.barycentric;
    return At({point.face, {l[0] - b - c, l[1] + b, l[2] + c}}, positions_mm);
  };
  return (at(kStep, 0) - at(-kStep, 0)).cross(at(0, kStep) - at(0, -kStep)).normalized();
}

double CalculixBody::AreaOf(std::size_t face) const {
  const auto x = [&](std::size_t i) {
    return nodes_mm_[static_cast<std::size_t>(faces_[face][i])];
  };
  return 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
}

void CalculixBody::Press(const SurfacePoint& point, double radius_mm,
                         const Eigen::Vector3d& force_N, Loads* loads) const {
  const Eigen::Vector3d centre = At(point, nodes_mm_);
  const Eigen::Vector3d normal = NormalAt(point, nodes_mm_);
  std::map<int, double> share;
  double sum = 0.0;
  for (std::size_t face = 0; face < faces_.size(); ++face) {
    if (NormalAt({face, {1.0 / 3, 1.0 / 3, 1.0 / 3}}, nodes_mm_).dot(normal) < 0.2) continue;
    for (int i = 0; i < kSamples; ++i) {
      for (int j = 0; j < kSamples - i; ++j) {
        const double b = (i + 1.0 / 3) / kSamples, c = (j + 1.0 / 3) / kSamples;
        const SurfacePoint sample{face, {1.0 - b - c, b, c}};
        const double off = (At(sample, nodes_mm_) - centre).squaredNorm() / (radius_mm * radius_mm);
        if (off >= 1.0) continue;
        const double weight = AreaOf(face) * std::sqrt(1.0 - off);
        const std::array<double, 6> shape = ShapeFunctions(sample.barycentric);
        for (std::size_t k = 0; k < 6; ++k) share[faces_[face][k]] += weight * shape[k];
        sum += weight;
      }
    }
  }
  if (!(sum > 0.0)) throw std::runtime_error("the pressure's radius is too small");
  for (const auto& [node, weight] : share) {
    loads->try_emplace(node, Eigen::Vector3d::Zero()).first->second += weight / sum * force_N;
  }
}

std::map<int, double> CalculixBody::WeightsInside(const Eigen::Vector3d& position_mm) const {
  double best = -std::numeric_limits<double>::infinity();
  std::map<int, double> weights;
  for (const std::array<int, 10>& cell : cells_) {
    const auto x = [&](std::size_t i) { return nodes_mm_[static_cast<std::size_t>(cell[i])]; };
    Eigen::Matrix3d edges;
    edges << x(1) - x(0), x(2) - x(0), x(3) - x(0);
    const Eigen::Vector3d l = edges.inverse() * (position_mm - x(0));
    const double least = std::min(l.minCoeff(), 1.0 - l.sum());
    if (least <= best) continue;
    best = least;
    weights = {{cell[0], 1.0 - l.sum()}, {cell[1], l[0]}, {cell[2], l[1]}, {cell[3], l[2]}};
  }
  return weights;
}

std::vector<std::array<int, 3>> CalculixBody::Triangles() const {
  std::vector<std::array<int, 3>> triangles;
  for (const auto& [a, b, c, ab, bc, ca] : faces_) {
    triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return triangles;
}

}  // namespace palpate::test_support

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/elastic_body.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>

#include "libs/core/check.hpp"
#include "libs/core/error.hpp"
#include "libs/fem/shape_functions.hpp"

namespace palpate::fem {

namespace {

using kernels::kLanes;

constexpr int kMaxNodes = 10;
using ForceBuffer = std::array<double, kMaxNodes * 3 * kLanes>;
using StiffnessBuffer = std::array<double, kernels::PairCount(kMaxNodes) * 9 * kLanes>;

size_t At(int value) { return static_cast<size_t>(value); }

/// One lane of a kernel's 3x3 block.
struct LaneBlock {
  const double* entries;
  double operator()(int row, int column) const { return entries[(row * 3 + column) * kLanes]; }
};

void ScatterForce(const kernels::Block& block, const ForceBuffer& force, int nodes, int lane,
                  Eigen::VectorXd& force_N) {
  for (int a = 0; a < nodes; ++a) {
    double* target = force_N.data() + 3 * static_cast<Eigen::Index>(block.nodes[a * kLanes + lane]);
    for (int i = 0; i < 3; ++i) target[i] += force[At((a * 3 + i) * kLanes + lane)];
  }
}

}  // namespace

int ElasticBody::Group::LanesUsed(int block) const {
  return std::min(kLanes, static_cast<int>(cells.size()) - block * kLanes);
}

kernels::Block ElasticBody::Group::View(int block) const {
  const size_t first = At(block) * kLanes;
  return {.nodes = nodes.data() + first * At(nodes_per_cell),
          .gradients = gradients.data() + first * At(points * nodes_per_cell * 3),
          .weights = weights.data() + first * At(points),
          .lambda_Pa = lambda_Pa.data() + first,
          .mu_Pa = mu_Pa.data() + first};
}

ElasticBody::ElasticBody(const TetMesh& mesh, std::vector<Material> materials,
                         const std::vector<int>& material_of_cell)
    : rest_m_(mesh.nodes_m.reshaped()), materials_(std::move(materials)) {
  PALPATE_CHECK(material_of_cell.size() == At(mesh.CellCount()), material_of_cell.size());
  std::map<std::tuple<MaterialModel, Volumetric>, std::vector<int>> cells_by_law;
  for (int cell = 0; cell < mesh.CellCount(); ++cell) {
    const Material& material = materials_.at(At(material_of_cell[At(cell)]));
    cells_by_law[{material.model, material.volumetric}].push_back(cell);
  }
  for (const auto& [law, cells] : cells_by_law) {
    groups_.push_back(MakeGroup(mesh, cells, material_of_cell));
  }
}

ElasticBody::Group ElasticBody::MakeGroup(const TetMesh& mesh, const std::vector<int>& cells,
                                          const std::vector<int>& material_of_cell) const {
  const Material& material = materials_[At(material_of_cell[At(cells.front())])];
  if (material.volumetric == Volumetric::kMeanDilatation &&
      !kernels::SupportsMeanDilatation(material.model)) {
    throw InputError("material '" + std::string(ToString(material.model)) +
                     "' has no volumetric energy of its own: mean_dilatation is not possible");
  }
  Group group;
  group.nodes_per_cell = static_cast<int>(mesh.cells.rows());
  group.points = mesh.element_type() == ElementType::kTet4 ? 1 : 4;
  group.kernel = kernels::SelectKernel(group.nodes_per_cell, material.model, material.volumetric);
  group.cells = cells;
  for (int cell : cells) group.material.push_back(material_of_cell[At(cell)]);
  const size_t lanes = (cells.size() + kLanes - 1) / kLanes * kLanes;
  group.nodes.resize(lanes * At(group.nodes_per_cell));
  group.gradients.resize(lanes * At(group.points * group.nodes_per_cell * 3));
  group.weights.resize(lanes * At(group.points));
  group.lambda_Pa.resize(lanes);
  group.mu_Pa.resize(lanes);
  for (size_t k = 0; k < lanes; ++k) {
    // Lanes left over repeat the last cell; nobody reads what they give.
    const int cell = cells[std::min(k, cells.size() - 1)];
    FillCell(mesh, cell, static_cast<int>(k) / kLanes, static_cast<int>(k) % kLanes, group);
  }
  UpdateModuli(group);
  return group;
}

void ElasticBody::FillCell(const TetMesh& mesh, int cell, int block, int lane, Group& group) const {
  const int nodes = group.nodes_per_cell;
  Eigen::Matrix3Xd corners(3, nodes);
  for (int a = 0; a < nodes; ++a) {
    corners.col(a) = mesh.nodes_m.col(mesh.cells(a, cell));
    group.nodes[At((block * nodes + a) * kLanes + lane)] = mesh.cells(a, cell);
  }
  const TetQuadrature rule = StiffnessQuadrature(mesh.element_type());
  for (int q = 0; q < group.points; ++q) {
    const Eigen::Matrix3Xd dN = ShapeGradients(mesh.element_type(), rule.points.col(q));
    const Eigen::Matrix3d jacobian = corners * dN.transpose();  // dX/dxi
    const double determinant = jacobian.determinant();
    if (!(determinant > 0.0)) {
      throw InputError("cell " + std::to_string(cell) +
                       " is inverted or degenerate at an integration point");
    }
    const Eigen::Matrix3Xd gradients = jacobian.transpose().inverse() * dN;
    for (int a = 0; a < nodes; ++a) {
      for (int i = 0; i < 3; ++i) {
        const int row = ((block * group.points + q) * nodes + a) * 3 + i;
        group.gradients[At(row) * kLanes + At(lane)] = gradients(i, a);
      }
    }
    group.weights[At((block * group.points + q) * kLanes + lane)] = determinant * rule.weights[q];
  }
}

void ElasticBody::UpdateModuli(Group& group) const {
  for (size_t k = 0; k < group.lambda_Pa.size(); ++k) {
    const Material& material =
        materials_[At(group.material[std::min(k, group.material.size() - 1)])];
    group.lambda_Pa[k] = material.LameLambda_Pa();
    group.mu_Pa[k] = material.LameMu_Pa();
  }
}

void ElasticBody::SetYoungsModulus(int material, double youngs_modulus_Pa) {
  PALPATE_CHECK(youngs_modulus_Pa > 0.0, youngs_modulus_Pa);
  materials_.at(At(material)).youngs_modulus_Pa = youngs_modulus_Pa;
  for (Group& group : groups_) UpdateModuli(group);
}

NodePairs ElasticBody::CoupledPairs() const {
  NodePairs pairs;
  for (const Group& group : groups_) {
    for (int block = 0; block < group.BlockCount(); ++block) {
      const kernels::Block view = group.View(block);
      for (int lane = 0; lane < group.LanesUsed(block); ++lane) {
        for (int a = 1; a < group.nodes_per_cell; ++a) {
          for (int b = 0; b < a; ++b) {
            pairs.emplace_back(view.nodes[a * kLanes + lane], view.nodes[b * kLanes + lane]);
          }
        }
      }
    }
  }
  return pairs;
}

void ElasticBody::BindTo(const StiffnessMatrix& stiffness) {
  for (Group& group : groups_) {
    group.slots.clear();
    group.slots.reserve(At(group.BlockCount() * kLanes * kernels::PairCount(group.nodes_per_cell)));
    for (int block = 0; block < group.BlockCount(); ++block) {
      const kernels::Block view = group.View(block);
      for (int lane = 0; lane < kLanes; ++lane) {
        for (int a = 0; a < group.nodes_per_cell; ++a) {
          for (int b = 0; b <= a; ++b) {
            group.slots.push_back(
                stiffness.Slot(view.nodes[a * kLanes + lane], view.nodes[b * kLanes + lane]));
          }
        }
      }
    }
  }
}

double ElasticBody::AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const {
  ForceBuffer force;
  std::array<double, kLanes> min_J_of_block;
  double min_J = std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) {
    for (int block = 0; block < group.BlockCount(); ++block) {
      const kernels::Block view = group.View(block);
      group.kernel(view, x_m.data(), {force.data(), nullptr, nullptr, min_J_of_block.data()});
      for (int lane = 0; lane < group.LanesUsed(block); ++lane) {
        ScatterForce(view, force, group.nodes_per_cell, lane, force_N);
        min_J = std::min(min_J, min_J_of_block[At(lane)]);
      }
    }
  }
  return min_J;
}

void ElasticBody::AddForcesOfMaterial(int material, const Eigen::VectorXd& x_m,
                                      Eigen::VectorXd& force_N) const {
  ForceBuffer force;
  for (const Group& group : groups_) {
    for (int block = 0; block < group.BlockCount(); ++block) {
      const kernels::Block view = group.View(block);
      group.kernel(view, x_m.data(), {force.data(), nullptr, nullptr, nullptr});
      for (int lane = 0; lane < group.LanesUsed(block); ++lane) {
        if (group.material[At(block * kLanes + lane)] != material) continue;
        ScatterForce(view, force, group.nodes_per_cell, lane, force_N);
      }
    }
  }
}

double ElasticBody::AddForcesAndTangent(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N,
                                        StiffnessMatrix& stiffness) const {
  ForceBuffer force;
  StiffnessBuffer tangent;
  std::array<double, kLanes> min_J_of_block;
  double min_J = std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) {
    PALPATE_CHECK(!group.slots.empty());
    const int pairs = kernels::PairCount(group.nodes_per_cell);
    for (int block = 0; block < group.BlockCount(); ++block) {
      const kernels::Block view = group.View(block);
      group.kernel(view, x_m.data(),
                   {force.data(), tangent.data(), nullptr, min_J_of_block.data()});
      for (int lane = 0; lane < group.LanesUsed(block); ++lane) {
        ScatterForce(view, force, group.nodes_per_cell, lane, force_N);
        min_J = std::min(min_J, min_J_of_block[At(lane)]);
        const BlockSlot* slot = group.slots.data() + At((block * kLanes + lane) * pairs);
        for (int pair = 0; pair < pairs; ++pair) {
          stiffness.Add(slot[pair], LaneBlock{tangent.data() + pair * 9 * kLanes + lane});
        }
      }
    }
  }
  return min_J;
}

double ElasticBody::Energy(const Eigen::VectorXd& x_m, double* min_J) const {
  std::array<double, kLanes> energy_of_block;
  std::array<double, kLanes> min_J_of_block;
  double energy = 0.0;
  *min_J = std::numeric_limits<double>::infinity();
  for (const Group& group : groups_) {
    for (int block = 0; block < group.BlockCount(); ++block) {
      group.kernel(group.View(block), x_m.data(),
                   {nullptr, nullptr, energy_of_block.data(), min_J_of_block.data()});
      for (int lane = 0; lane < group.LanesUsed(block); ++lane) {
        energy += energy_of_block[At(lane)];
        *min_J = std::min(*min_J, min_J_of_block[At(lane)]);
      }
    }
  }
  return energy;
}

}  // namespace palpate::fem

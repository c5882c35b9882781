// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/elastic_body.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <tuple>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

using kernels::kLanes;

/// Sorts cells by the last of their rows: cells inside a part that is eliminated as a whole stay
/// together, those on a boundary between parts (a separator) come after them.
void SortByRows(const Eigen::MatrixXi& cells, const std::vector<int>& row_of_node,
                std::vector<int>* order) {
  const auto last_rows = [&](int cell) {
    std::array<int, 2> last{-1, -1};
    for (const int node : cells.col(cell)) {
      const int row = row_of_node[At(node)];
      if (row > last[0]) {
        last = {row, last[0]};
      } else if (row > last[1]) {
        last[1] = row;
      }
    }
    return std::make_tuple(last[0], last[1], cell);
  };
  std::sort(order->begin(), order->end(),
            [&](int a, int b) { return last_rows(a) < last_rows(b); });
}

double SmallestOf(const std::array<double, kLanes>& values, double smallest) {
  for (const double value : values) smallest = std::min(smallest, value);
  return smallest;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

ElasticBody::ElasticBody(const TetMesh& mesh, std::vector<Material> materials,
                         const std::vector<int>& material_of_cell,
                         const std::vector<EmbeddedFibre>& fibres)
    : mesh_(mesh),
      rest_m_(mesh.nodes_m.reshaped()),
      materials_(std::move(materials)),
      material_of_cell_{material_of_cell},
      fibres_(fibres, rest_m_) {
  PALPATE_CHECK(material_of_cell.size() == At(mesh.CellCount()), material_of_cell.size());
  Share(NaturalRowOrder(mesh.NodeCount()), nullptr, 1);
}

void ElasticBody::BindTo(const StiffnessMatrix& stiffness, std::shared_ptr<ThreadTeam> team) {
  PALPATE_CHECK(stiffness.NodeCount() == NodeCount(), stiffness.NodeCount(), NodeCount());
  team_ = std::move(team);
  Share(EliminationRowOrder(mesh_.cells, stiffness), &stiffness, team_ ? team_->Size() : 1);
  fibres_.BindTo(stiffness);
}

void ElasticBody::Share(RowOrder order, const StiffnessMatrix* stiffness, int threads) {
  order_ = std::move(order);
  MakeBlocks(order_);
  shares_ = ShareOut(laws_, order_, stiffness, threads);
  bound_ = stiffness != nullptr;
  force_rows_.assign(At(ForceRowCount(NodeCount(), threads)), ForceRow{});
  results_.assign(shares_.size(), ThreadResult{});
  block_energy_J_.clear();
  for (const CellBlocks& law : laws_) {
    block_energy_J_.emplace_back(Eigen::VectorXd::Zero(law.BlockCount()));
  }
}

void ElasticBody::MakeBlocks(const RowOrder& order) {
  std::map<std::tuple<MaterialModel, Volumetric>, std::vector<int>> cells_by_law;
  for (int cell = 0; cell < mesh_.CellCount(); ++cell) {
    const Material& material = materials_.at(At(material_of_cell_[At(cell)]));
    cells_by_law[{material.model, material.volumetric}].push_back(cell);
  }
  laws_.clear();
  for (auto& [law, cells] : cells_by_law) {
    SortByRows(mesh_.cells, order.row_of_node, &cells);
    const Material& material = materials_[At(material_of_cell_[At(cells.front())])];
    laws_.emplace_back(mesh_, cells, material, order.row_of_node);
    laws_.back().SetModuli(materials_, material_of_cell_, factor_of_cell_);
  }
}

void ElasticBody::SetYoungsModulus(int material, double youngs_modulus_Pa) {
  PALPATE_CHECK(youngs_modulus_Pa > 0.0, youngs_modulus_Pa);
  materials_.at(At(material)).youngs_modulus_Pa = youngs_modulus_Pa;
  for (CellBlocks& law : laws_) law.SetModuli(materials_, material_of_cell_, factor_of_cell_);
}

void ElasticBody::SetPoissonsRatio(int material, double poissons_ratio) {
  PALPATE_CHECK(poissons_ratio > -1.0 && poissons_ratio < 0.5, poissons_ratio);
  materials_.at(At(material)).poissons_ratio = poissons_ratio;
  for (CellBlocks& law : laws_) law.SetModuli(materials_, material_of_cell_, factor_of_cell_);
}

void ElasticBody::SetCellFactors(const Eigen::VectorXd& factor) {
  PALPATE_CHECK(factor.size() == mesh_.CellCount(), factor.size(), mesh_.CellCount());
  PALPATE_CHECK((factor.array() > 0.0).all());
  factor_of_cell_ = factor;
  for (CellBlocks& law : laws_) law.SetModuli(materials_, material_of_cell_, factor_of_cell_);
}

NodePairs ElasticBody::CoupledPairs() const {
  NodePairs pairs;
  for (Eigen::Index cell = 0; cell < mesh_.cells.cols(); ++cell) {
    for (Eigen::Index a = 1; a < mesh_.cells.rows(); ++a) {
      for (Eigen::Index b = 0; b < a; ++b) {
        pairs.emplace_back(mesh_.cells(a, cell), mesh_.cells(b, cell));
      }
    }
  }
  return pairs;
}

template <typename Work>
double ElasticBody::OnEveryShare(const Work& work) const {
  const auto work_on_share = [&](int thread) {
    if (At(thread) < shares_.size()) results_[At(thread)].min_J = work(shares_[At(thread)]);
  };
  if (team_) {
    team_->Run(work_on_share);
  } else {
    work_on_share(0);
  }
  double min_J = kInfinity;
  for (const ThreadResult& result : results_) min_J = std::min(min_J, result.min_J);
  return min_J;
}

void ElasticBody::ClearRows(const AssemblyShare& share) const {
  std::fill(force_rows_.begin() + share.first_row, force_rows_.begin() + share.end_row, ForceRow{});
}

void ElasticBody::AddRows(const AssemblyShare& share, Eigen::VectorXd& force_N) const {
  for (int row = share.first_row; row < share.end_row; ++row) {
    double* target = force_N.data() + 3 * order_.node_of_row[At(row)];
    for (int i = 0; i < 3; ++i) target[i] += force_rows_[At(row)].N[i];
  }
}

double ElasticBody::AddShare(const AssemblyShare& share, const double* x_m,
                             Eigen::VectorXd& force_N, StiffnessMatrix* stiffness) const {
  std::array<double, kLanes> min_J_of_block;
  double min_J = kInfinity;
  ClearRows(share);
  if (stiffness != nullptr) stiffness->SetZero(share.first_column, share.end_column);
  double* values = stiffness == nullptr ? nullptr : stiffness->Values().data();
  for (size_t l = 0; l < laws_.size(); ++l) {
    const AssemblyShare::OfLaw& of_law = share.laws[l];
    const auto nodes = laws_[l].NodesPerCell();
    const int* force_rows = of_law.force_rows.data();
    const int* addresses = values == nullptr ? nullptr : of_law.addresses.data();
    for (const int block : of_law.blocks) {
      laws_[l].Evaluate(block, x_m,
                        {.force = force_rows_.front().N,
                         .force_rows = force_rows,
                         .stiffness = values,
                         .addresses = addresses,
                         .min_J = min_J_of_block.data()});
      min_J = SmallestOf(min_J_of_block, min_J);
      force_rows += nodes * kLanes;
      if (addresses != nullptr) addresses += kernels::PairCount(nodes) * kLanes;
    }
  }
  AddRows(share, force_N);
  return min_J;
}

double ElasticBody::AddForcesOfCells(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const {
  return OnEveryShare(
      [&](const AssemblyShare& share) { return AddShare(share, x_m.data(), force_N, nullptr); });
}

double ElasticBody::AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const {
  const double min_J = AddForcesOfCells(x_m, force_N);
  fibres_.AddForces(x_m, force_N);
  return min_J;
}

double ElasticBody::AddForcesAndSetTangent(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N,
                                           StiffnessMatrix& stiffness) const {
  PALPATE_CHECK(bound_);
  const double min_J = OnEveryShare(
      [&](const AssemblyShare& share) { return AddShare(share, x_m.data(), force_N, &stiffness); });
  fibres_.AddForces(x_m, force_N);
  fibres_.AddTangent(x_m, stiffness);
  return min_J;
}

void ElasticBody::AddForcesOfMaterial(int material, const Eigen::VectorXd& x_m,
                                      Eigen::VectorXd& force_N) const {
  OnEveryShare([&](const AssemblyShare& share) {
    AddShareOfMaterial(share, material, x_m.data(), force_N);
    return kInfinity;
  });
}

void ElasticBody::AddShareOfMaterial(const AssemblyShare& share, int material, const double* x_m,
                                     Eigen::VectorXd& force_N) const {
  constexpr int kMaxNodes = 10;
  std::array<int, kMaxNodes * kLanes> rows;
  ClearRows(share);
  for (size_t l = 0; l < laws_.size(); ++l) {
    const CellBlocks& law = laws_[l];
    const int row_count = law.NodesPerCell() * kLanes;
    const int* rows_of_block = share.laws[l].force_rows.data() - row_count;
    for (const int block : share.laws[l].blocks) {
      rows_of_block += row_count;
      bool has_material = false;
      for (int lane = 0; lane < kLanes; ++lane) {
        const int cell = law.CellAt(block, lane);
        const bool counts = cell >= 0 && material_of_cell_[At(cell)] == material;
        has_material = has_material || counts;
        for (int k = lane; k < row_count; k += kLanes) {
          rows[At(k)] = counts ? rows_of_block[k] : share.spare_row;
        }
      }
      if (!has_material) continue;
      law.Evaluate(block, x_m, {.force = force_rows_.front().N, .force_rows = rows.data()});
    }
  }
  AddRows(share, force_N);
}

double ElasticBody::EnergiesOfShare(const AssemblyShare& share, const double* x_m,
                                    double* of_cell_J) const {
  std::array<double, kLanes> energy_of_lane;
  std::array<double, kLanes> min_J_of_block;
  double min_J = kInfinity;
  for (size_t l = 0; l < laws_.size(); ++l) {
    for (const int block : share.laws[l].own_blocks) {
      laws_[l].Evaluate(block, x_m,
                        {.energy = energy_of_lane.data(), .min_J = min_J_of_block.data()});
      double energy = 0.0;
      for (int lane = 0; lane < kLanes; ++lane) {
        const int cell = laws_[l].CellAt(block, lane);
        if (cell < 0) continue;
        energy += energy_of_lane[At(lane)];
        if (of_cell_J != nullptr) of_cell_J[cell] = energy_of_lane[At(lane)];
      }
      block_energy_J_[l][block] = energy;
      min_J = SmallestOf(min_J_of_block, min_J);
    }
  }
  return min_J;
}

double ElasticBody::Energy(const Eigen::VectorXd& x_m, double* min_J) const {
  *min_J = OnEveryShare(
      [&](const AssemblyShare& share) { return EnergiesOfShare(share, x_m.data(), nullptr); });
  double energy = fibres_.Energy(x_m);
  for (const Eigen::VectorXd& of_blocks : block_energy_J_) energy += of_blocks.sum();
  return energy;
}

double ElasticBody::CellEnergies(const Eigen::VectorXd& x_m, Eigen::VectorXd* energy_J) const {
  energy_J->resize(mesh_.CellCount());
  return OnEveryShare([&](const AssemblyShare& share) {
    return EnergiesOfShare(share, x_m.data(), energy_J->data());
  });
}

}  // namespace palpate::fem

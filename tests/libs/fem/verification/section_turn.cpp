// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "tests/libs/fem/verification/section_turn.hpp"

#include <cmath>
#include <numeric>

#include "libs/core/check.hpp"
#include "tests/libs/fem/verification/grid_mesh.hpp"

namespace palpate::fem::verification {

Eigen::Vector3d SectionTurn::Section::Director(const Eigen::VectorXd& x_m) const {
  Eigen::Vector3d director = Eigen::Vector3d::Zero();
  for (size_t k = 0; k < nodes.size(); ++k) director += weights[k] * x_m.segment<3>(3 * nodes[k]);
  return director;
}

SectionTurn::SectionTurn(const TetMesh& mesh, const std::vector<double>& stations_m) {
  PALPATE_CHECK(stations_m.size() >= 2, stations_m.size());
  for (double station_m : stations_m) {
    Section section;
    section.nodes = NodesWhere(
        mesh, [&](const Eigen::Vector3d& p) { return std::abs(p[0] - station_m) < 1e-9; });
    PALPATE_CHECK(section.nodes.size() >= 2, station_m);
    for (int node : section.nodes) section.weights.push_back(mesh.nodes_m(2, node));
    const double middle = std::accumulate(section.weights.begin(), section.weights.end(), 0.0) /
                          static_cast<double>(section.weights.size());
    double squares = 0.0;
    for (double& weight : section.weights) {
      weight -= middle;
      squares += weight * weight;
    }
    PALPATE_CHECK(squares > 0.0, station_m);
    for (double& weight : section.weights) weight /= squares;
    sections_.push_back(section);
  }
}

double SectionTurn::Value(const Eigen::VectorXd& x_m) const {
  double turned = 0.0;
  for (size_t k = 1; k < sections_.size(); ++k) {
    const Eigen::Vector3d before = sections_[k - 1].Director(x_m);
    const Eigen::Vector3d after = sections_[k].Director(x_m);
    turned += std::atan2(before[2] * after[0] - before[0] * after[2],
                         before[0] * after[0] + before[2] * after[2]);
  }
  return -turned;
}

void SectionTurn::AddGradient(const Eigen::VectorXd& x_m, double factor,
                              Eigen::VectorXd& nodal) const {
  const Section& end = sections_.back();
  const Eigen::Vector3d d = end.Director(x_m);
  const double squared = d[0] * d[0] + d[2] * d[2];
  const Eigen::Vector3d gradient(-d[2] / squared, 0.0, d[0] / squared);
  for (size_t k = 0; k < end.nodes.size(); ++k) {
    nodal.segment<3>(3 * end.nodes[k]) += factor * end.weights[k] * gradient;
  }
}

NodePairs SectionTurn::CoupledPairs() const {
  NodePairs pairs;
  const std::vector<int>& nodes = sections_.back().nodes;
  for (size_t k = 1; k < nodes.size(); ++k) {
    for (size_t l = 0; l < k; ++l) pairs.emplace_back(nodes[k], nodes[l]);
  }
  return pairs;
}

void SectionTurn::BindTo(const StiffnessMatrix& stiffness) {
  slots_.clear();
  const std::vector<int>& nodes = sections_.back().nodes;
  for (size_t k = 0; k < nodes.size(); ++k) {
    for (size_t l = 0; l <= k; ++l) slots_.push_back(stiffness.Slot(nodes[k], nodes[l]));
  }
}

void SectionTurn::AddCurvature(const Eigen::VectorXd& x_m, double multiplier,
                               StiffnessMatrix& stiffness) const {
  const Section& end = sections_.back();
  const Eigen::Vector3d d = end.Director(x_m);
  const double fourth = std::pow(d[0] * d[0] + d[2] * d[2], 2);
  const double along = 2.0 * d[0] * d[2] / fourth;
  const double across = (d[2] * d[2] - d[0] * d[0]) / fourth;
  Eigen::Matrix3d curvature;
  curvature << along, 0.0, across, 0.0, 0.0, 0.0, across, 0.0, -along;
  size_t slot = 0;
  for (size_t k = 0; k < end.nodes.size(); ++k) {
    for (size_t l = 0; l <= k; ++l) {
      const Eigen::Matrix3d block = multiplier * end.weights[k] * end.weights[l] * curvature;
      stiffness.Add(slots_[slot++], block);
    }
  }
}

}  // namespace palpate::fem::verification

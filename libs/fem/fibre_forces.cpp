// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/fibre_forces.hpp"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

constexpr size_t kMostPairs = 55;  ///< of nodes of a tet10, each with itself too

}  // namespace

/// Energy k/2 (|t| - |T|)^2 of a point: its derivatives by t.
struct FibreForces::Pull {
  Pull(const Point& point, const Eigen::Vector3d& direction)
      : length(direction.norm()),
        rest_length(point.rest_direction.norm()),
        stiffness_Nm(point.stiffness_Nm) {
    // A fibre of no length has no direction: it pulls nowhere.
    if (length > 0.0) unit = direction / length;
  }

  double Stretched() const { return length - rest_length; }
  Eigen::Vector3d Force() const { return stiffness_Nm * Stretched() * unit; }
  Eigen::Matrix3d Tangent() const {
    const Eigen::Matrix3d along = unit * unit.transpose();
    const double across = length > 0.0 ? Stretched() / length : 0.0;
    return stiffness_Nm * (along + across * (Eigen::Matrix3d::Identity() - along));
  }

  double length;
  double rest_length;
  double stiffness_Nm;
  Eigen::Vector3d unit = Eigen::Vector3d::Zero();
};

FibreForces::FibreForces(const std::vector<EmbeddedFibre>& fibres, const Eigen::VectorXd& rest_m)
    : fibre_count_(static_cast<int>(fibres.size())) {
  std::map<int, std::vector<std::pair<int, const FibrePoint*>>> points_of_cell;
  for (int f = 0; f < fibre_count_; ++f) {
    PALPATE_CHECK(fibres[At(f)].axial_stiffness_N > 0.0, f);
    for (const FibrePoint& point : fibres[At(f)].points) {
      points_of_cell[point.cell].emplace_back(f, &point);
    }
  }
  for (const auto& [cell_number, points] : points_of_cell) {
    Cell cell{.nodes = points.front().second->direction.nodes,
              .slots = {},
              .first_point = points_.size(),
              .end_point = points_.size() + points.size()};
    for (const auto& [fibre, laid] : points) {
      PALPATE_CHECK(laid->direction.nodes == cell.nodes, cell_number);
      Point point{fibre, 0.0, Eigen::Vector3d::Zero(), laid->direction.weights};
      point.rest_direction = Direction(cell, point, rest_m);
      const double rest_length = point.rest_direction.norm();
      PALPATE_CHECK(rest_length > 0.0, fibre, cell_number);
      // ds = |T| laid length; energy EA/2 (|t|/|T| - 1)^2 ds.
      point.stiffness_Nm = fibres[At(fibre)].axial_stiffness_N * laid->length_m / rest_length;
      points_.push_back(std::move(point));
    }
    cells_.push_back(std::move(cell));
  }
}

Eigen::Vector3d FibreForces::Direction(const Cell& cell, const Point& point,
                                       const Eigen::VectorXd& nodal) {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (size_t a = 0; a < cell.nodes.size(); ++a) {
    direction += point.weights[a] * nodal.segment<3>(3 * cell.nodes[a]);
  }
  return direction;
}

void FibreForces::Scatter(const Cell& cell, const Point& point, const Eigen::Vector3d& pull_Nm,
                          Eigen::VectorXd& force_N) {
  for (size_t a = 0; a < cell.nodes.size(); ++a) {
    force_N.segment<3>(3 * cell.nodes[a]) += point.weights[a] * pull_Nm;
  }
}

template <typename Work>
void FibreForces::OnEveryPoint(const Work& work) const {
  for (const Cell& cell : cells_) {
    for (size_t p = cell.first_point; p < cell.end_point; ++p) work(cell, points_[p]);
  }
}

void FibreForces::AddForces(const Eigen::VectorXd& x_m, Eigen::VectorXd& force_N) const {
  OnEveryPoint([&](const Cell& cell, const Point& point) {
    Scatter(cell, point, Pull(point, Direction(cell, point, x_m)).Force(), force_N);
  });
}

double FibreForces::Energy(const Eigen::VectorXd& x_m) const {
  double energy_J = 0.0;
  OnEveryPoint([&](const Cell& cell, const Point& point) {
    const double stretched = Pull(point, Direction(cell, point, x_m)).Stretched();
    energy_J += 0.5 * point.stiffness_Nm * stretched * stretched;
  });
  return energy_J;
}

Eigen::VectorXd FibreForces::LargestStrains(const Eigen::VectorXd& x_m) const {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(fibre_count_);
  OnEveryPoint([&](const Cell& cell, const Point& point) {
    const Pull pull(point, Direction(cell, point, x_m));
    const double strain = pull.Stretched() / pull.rest_length;
    if (std::abs(strain) > std::abs(largest[point.fibre])) largest[point.fibre] = strain;
  });
  return largest;
}

void FibreForces::BindTo(const StiffnessMatrix& stiffness) {
  for (Cell& cell : cells_) {
    cell.slots.clear();
    for (size_t a = 0; a < cell.nodes.size(); ++a) {
      for (size_t b = 0; b <= a; ++b) {
        cell.slots.push_back(stiffness.Slot(cell.nodes[a], cell.nodes[b]));
      }
    }
  }
}

void FibreForces::AddTangent(const Eigen::VectorXd& x_m, StiffnessMatrix& stiffness) const {
  std::array<Eigen::Matrix3d, kMostPairs> blocks;
  for (const Cell& cell : cells_) {
    PALPATE_CHECK(!cell.slots.empty() && cell.slots.size() <= kMostPairs, cell.slots.size());
    blocks.fill(Eigen::Matrix3d::Zero());
    for (size_t p = cell.first_point; p < cell.end_point; ++p) {
      const Point& point = points_[p];
      const Eigen::Matrix3d tangent_Nm = Pull(point, Direction(cell, point, x_m)).Tangent();
      auto block = blocks.begin();
      for (size_t a = 0; a < cell.nodes.size(); ++a) {
        for (size_t b = 0; b <= a; ++b) {
          *block++ += point.weights[a] * point.weights[b] * tangent_Nm;
        }
      }
    }
    for (size_t k = 0; k < cell.slots.size(); ++k) stiffness.Add(cell.slots[k], blocks[k]);
  }
}

void FibreForces::AddAlongPositions(const Eigen::VectorXd& x_m, const Eigen::VectorXd& dx_m,
                                    double factor, Eigen::VectorXd& force_N) const {
  OnEveryPoint([&](const Cell& cell, const Point& point) {
    const Eigen::Vector3d change = Direction(cell, point, dx_m);
    if (change.isZero(0.0)) return;
    const Pull pull(point, Direction(cell, point, x_m));
    Scatter(cell, point, factor * pull.Tangent() * change, force_N);
  });
}

/// The force on t is EA ds0 / |T| (|t| - |T|) u, ds0 the laid length: by |T| its derivative is
/// -EA ds0 |t| / |T|^2 u.
void FibreForces::AddAlongRestShape(const Eigen::VectorXd& x_m, const Eigen::VectorXd& dX_m,
                                    double factor, Eigen::VectorXd& force_N) const {
  OnEveryPoint([&](const Cell& cell, const Point& point) {
    const Eigen::Vector3d change = Direction(cell, point, dX_m);
    if (change.isZero(0.0)) return;
    const Pull pull(point, Direction(cell, point, x_m));
    const double longer = point.rest_direction.dot(change) / pull.rest_length;
    const double by_rest_length_Nm = -pull.stiffness_Nm * pull.length / pull.rest_length;
    Scatter(cell, point, factor * by_rest_length_Nm * longer * pull.unit, force_N);
  });
}

}  // namespace palpate::fem

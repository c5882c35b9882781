// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/fem/enclosed_volume.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "libs/core/check.hpp"
#include "libs/core/index.hpp"

namespace palpate::fem {

namespace {

constexpr Eigen::Index kFlat = 3;
constexpr Eigen::Index kCurved = 6;
/// Terms that vanish are left with rounding of this size.
constexpr double kVanishes = 1e-14;

/// Values and both derivatives [6] of the quadratic shape functions of a triangle.
struct CurvedShape {
  Eigen::Matrix<double, 6, 1> N, by_xi, by_eta;
};

CurvedShape ShapeAt(double xi, double eta) {
  const double zeta = 1.0 - xi - eta;
  CurvedShape shape;
  shape.N << zeta * (2.0 * zeta - 1.0), xi * (2.0 * xi - 1.0), eta * (2.0 * eta - 1.0),
      4.0 * zeta * xi, 4.0 * xi * eta, 4.0 * eta * zeta;
  shape.by_xi << 1.0 - 4.0 * zeta, 4.0 * xi - 1.0, 0.0, 4.0 * (zeta - xi), 4.0 * eta, -4.0 * eta;
  shape.by_eta << 1.0 - 4.0 * zeta, 0.0, 4.0 * eta - 1.0, -4.0 * xi, 4.0 * xi, 4.0 * (zeta - eta);
  return shape;
}

struct TrianglePoint {
  double xi, eta, weight;
};

/// Radon's seven points, exact for polynomials of degree 5; weights add up to 1/2.
std::array<TrianglePoint, 7> RadonRule() {
  const double root = std::sqrt(15.0);
  const double a = (6.0 - root) / 21.0, b = (6.0 + root) / 21.0;
  const double of_a = (155.0 - root) / 2400.0, of_b = (155.0 + root) / 2400.0;
  return {{{1.0 / 3.0, 1.0 / 3.0, 9.0 / 80.0},
           {a, a, of_a},
           {1.0 - 2.0 * a, a, of_a},
           {a, 1.0 - 2.0 * a, of_a},
           {b, b, of_b},
           {1.0 - 2.0 * b, b, of_b},
           {b, 1.0 - 2.0 * b, of_b}}};
}

/// Integral of det of (N_a, N_b, N_c) against (1, d/dxi, d/deta), over three: t_abc.
double CurvedTerm(int a, int b, int c) {
  double sum = 0.0;
  for (const TrianglePoint& point : RadonRule()) {
    const CurvedShape shape = ShapeAt(point.xi, point.eta);
    Eigen::Matrix3d at;
    for (int row = 0; row < 3; ++row) {
      const int k = std::array{a, b, c}[At(row)];
      at.row(row) << shape.N[k], shape.by_xi[k], shape.by_eta[k];
    }
    sum += point.weight * at.determinant();
  }
  return sum / 3.0;
}

/// Pairs (i, j), i < j, of the points of a face, numbered row by row.
Eigen::Index LocalPair(Eigen::Index i, Eigen::Index j, Eigen::Index points) {
  return i * (2 * points - i - 1) / 2 + j - i - 1;
}

}  // namespace

std::vector<EnclosedVolume::Term> EnclosedVolume::TermsOf(Eigen::Index points_per_face) {
  if (points_per_face == kFlat) return {{0, 1, 2, 1.0 / 6.0}};
  std::vector<Term> terms;
  for (int a = 0; a < kCurved; ++a) {
    for (int b = a + 1; b < kCurved; ++b) {
      for (int c = b + 1; c < kCurved; ++c) {
        const double t = CurvedTerm(a, b, c);
        if (std::abs(t) > kVanishes) terms.push_back({a, b, c, t});
      }
    }
  }
  return terms;
}

EnclosedVolume::EnclosedVolume(MovingSurface surface) : surface_(std::move(surface)) {
  const Eigen::Index per_face = surface_.faces.rows();
  PALPATE_CHECK(per_face == kFlat || per_face == kCurved, per_face);
  PALPATE_CHECK(!surface_.points.empty());
  terms_ = TermsOf(per_face);
  FindPairs();
  FindCouplings();
  points_m_.resize(3, ToIndex(surface_.points.size()));
  per_point_m2_.resize(3, points_m_.cols());
  per_pair_m_.resize(3, ToIndex(pairs_.size()));
}

void EnclosedVolume::FindPairs() {
  const Eigen::MatrixXi& faces = surface_.faces;
  const Eigen::Index per_face = faces.rows();
  std::map<std::pair<int, int>, int> index_of_pair;
  pair_of_face_.resize(per_face * (per_face - 1) / 2, faces.cols());
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    for (Eigen::Index i = 0; i < per_face; ++i) {
      for (Eigen::Index j = i + 1; j < per_face; ++j) {
        const auto [low, high] = std::minmax(faces(i, f), faces(j, f));
        const auto [entry, is_new] =
            index_of_pair.try_emplace({low, high}, static_cast<int>(pairs_.size()));
        if (is_new) pairs_.emplace_back(low, high);
        const int turned = faces(i, f) > faces(j, f) ? 1 : 0;
        pair_of_face_(LocalPair(i, j, per_face), f) = 2 * entry->second + turned;
      }
    }
  }
}

/// Where both points hang on the same node, the block is a skew matrix and its transpose: nothing.
void EnclosedVolume::FindCouplings() {
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const InterpolationWeights& a = surface_.points[At(pairs_[p][0])];
    const InterpolationWeights& b = surface_.points[At(pairs_[p][1])];
    for (std::size_t k = 0; k < a.nodes.size(); ++k) {
      for (std::size_t l = 0; l < b.nodes.size(); ++l) {
        if (a.nodes[k] == b.nodes[l]) continue;
        couplings_.push_back({.pair = static_cast<int>(p),
                              .weight = a.weights[k] * b.weights[l],
                              .node_a = a.nodes[k],
                              .node_b = b.nodes[l],
                              .slot = {}});
      }
    }
  }
}

/// Volume and derivatives do not depend on where the origin is; near it they are rounded least.
void EnclosedVolume::Place(const Eigen::VectorXd& x_m) const {
  for (Eigen::Index p = 0; p < points_m_.cols(); ++p) {
    points_m_.col(p) = surface_.points[At(p)].Position(x_m);
  }
  const Eigen::Vector3d origin_m = points_m_.col(0);
  points_m_.colwise() -= origin_m;
}

double EnclosedVolume::Volume_m3(const Eigen::VectorXd& x_m) const {
  Place(x_m);
  double volume_m3 = 0.0;
  for (const auto& face : surface_.faces.colwise()) {
    for (const Term& term : terms_) {
      volume_m3 +=
          term.t * points_m_.col(face[term.a])
                       .dot(points_m_.col(face[term.b]).cross(points_m_.col(face[term.c])));
    }
  }
  return volume_m3;
}

void EnclosedVolume::AddGradient(const Eigen::VectorXd& x_m, double factor,
                                 Eigen::VectorXd& nodal) const {
  Place(x_m);
  per_point_m2_.setZero();
  for (const auto& face : surface_.faces.colwise()) {
    for (const Term& term : terms_) {
      const Eigen::Vector3d a = points_m_.col(face[term.a]);
      const Eigen::Vector3d b = points_m_.col(face[term.b]);
      const Eigen::Vector3d c = points_m_.col(face[term.c]);
      per_point_m2_.col(face[term.a]) += term.t * b.cross(c);
      per_point_m2_.col(face[term.b]) += term.t * c.cross(a);
      per_point_m2_.col(face[term.c]) += term.t * a.cross(b);
    }
  }
  for (Eigen::Index p = 0; p < per_point_m2_.cols(); ++p) {
    const InterpolationWeights& point = surface_.points[At(p)];
    for (std::size_t k = 0; k < point.nodes.size(); ++k) {
      nodal.segment<3>(3 * point.nodes[k]) += factor * point.weights[k] * per_point_m2_.col(p);
    }
  }
}

NodePairs EnclosedVolume::CoupledPairs() const {
  NodePairs pairs;
  for (const Coupling& coupling : couplings_) {
    pairs.emplace_back(coupling.node_a, coupling.node_b);
  }
  return pairs;
}

void EnclosedVolume::BindTo(const StiffnessMatrix& stiffness) {
  for (Coupling& coupling : couplings_) {
    coupling.slot = stiffness.Slot(coupling.node_a, coupling.node_b);
  }
}

/// The block of a pair is d2V / dx_i dx_j = -[s]x, the matrix of a cross product with
/// s = sum t x_k over the terms of both points; signs go with the order of the term.
void EnclosedVolume::AddCurvature(const Eigen::VectorXd& x_m, double factor,
                                  StiffnessMatrix& stiffness) const {
  Place(x_m);
  per_pair_m_.setZero();
  const Eigen::Index per_face = surface_.faces.rows();
  const auto add = [&](Eigen::Index face, int i, int j, double t, int third) {
    const int place = pair_of_face_(LocalPair(i, j, per_face), face);
    per_pair_m_.col(place / 2) +=
        (place % 2 == 0 ? t : -t) * points_m_.col(surface_.faces(third, face));
  };
  for (Eigen::Index f = 0; f < surface_.faces.cols(); ++f) {
    for (const Term& term : terms_) {
      add(f, term.a, term.b, term.t, term.c);
      add(f, term.b, term.c, term.t, term.a);
      add(f, term.a, term.c, -term.t, term.b);
    }
  }
  for (const Coupling& coupling : couplings_) {
    const Eigen::Vector3d s = factor * coupling.weight * per_pair_m_.col(coupling.pair);
    Eigen::Matrix3d block;
    block << 0.0, s.z(), -s.y(), -s.z(), 0.0, s.x(), s.y(), -s.x(), 0.0;
    stiffness.Add(coupling.slot, block);
  }
}

}  // namespace palpate::fem

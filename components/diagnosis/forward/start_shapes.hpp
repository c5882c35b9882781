// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "components/diagnosis/forward/drive_distance.hpp"
#include "components/diagnosis/forward/simulation.hpp"

namespace palpate::diagnosis {

struct StartShapesTuning {
  /// Of DriveDistance, over which samples move alike. Either way off, more iterations are needed.
  double length = 0.5;
  /// Variance of what all samples move by, in terms of what each moves by about that. Larger: far
  /// samples tell more.
  double alike = 0.1;
  /// Variance of what one sample moves by otherwise. Larger: near samples tell less.
  double own = 1e-4;
  /// Of DriveDistance: what is nearer moves by the same. Commands that are held are read with about
  /// so much noise. Larger: starts of samples that differ err more.
  double same = 2e-3;
  /// Of the body's diagonal: a node that moves by less is no reason to begin elsewhere. Robots that
  /// differ by so little err alike then, so that their difference does not. Larger: more
  /// iterations.
  double least = 4e-4;
};

/// Where the balance of a sample is sought first, from the samples that came to balance before:
/// only how many iterations it takes depends on that.
class StartShapes {
 public:
  explicit StartShapes(const DriveDistance& distance, const StartShapesTuning& tuning = {})
      : distance_(distance), tuning_(tuning) {}

  /// Of a sample without a shape: that of the sample from which it is nearest, unless the
  /// undeformed body is nearer. Of one that has the shape of another robot: that, moved as one of
  /// the same drive has moved, or else as the others have (Gaussian process regression over their
  /// drive, Rasmussen and Williams 2006, eq. 2.23). False: it stays as it is.
  bool Begin(std::size_t s, const std::vector<SimulatedSample>& samples, HeldShape* shape) const;

  /// Sample `s` came to balance in `now`; `was` is its shape before Begin, which may be none.
  void Learn(std::size_t s, const HeldShape& was, const HeldShape& now);

 private:
  double Covariance(std::size_t a, std::size_t b) const;
  /// Of a sample, from one robot to another.
  struct Move {
    std::size_t sample = 0;
    fem::StaticState was;
    fem::StaticState now;
    Eigen::VectorXd nodes_m;  ///< moved by
  };
  const Move* OfSameDrive(std::size_t s) const;
  Eigen::VectorXd MovedBy_m(std::size_t s) const;

  const DriveDistance& distance_;
  StartShapesTuning tuning_;
  std::vector<std::size_t> balanced_;
  std::vector<Move> moves_;
};

}  // namespace palpate::diagnosis

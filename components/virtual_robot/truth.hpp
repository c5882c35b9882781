// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/virtual_robot/bench.hpp"
#include "components/virtual_robot/virtual_robot.hpp"
#include "libs/fem/interpolation_weights.hpp"
#include "libs/geometry/closest_point.hpp"
#include "libs/scenario/random.hpp"

namespace palpate::virtual_robot {

/// The truth of a bench: readings, forces, markers.
class Truth {
 public:
  /// Each marker_misplacement moves its marker by `d_m` on the body, in a direction that the seed
  /// draws, as it does the noise of the pressure sensors. `bench` must outlive this.
  Truth(const Bench& bench, const Effects& effects, std::uint64_t seed);

  /// After the bench has moved.
  void Update();
  const std::vector<CableReading>& cables() const { return readings_; }
  std::vector<TrueForce> Forces() const;
  Eigen::Matrix3Xd MarkerPositions_m() const;

 private:
  const Bench& bench_;
  geometry::SurfaceIndex rest_surface_;
  std::vector<fem::InterpolationWeights> markers_;
  std::vector<CableReading> readings_;
  std::vector<scenario::Random> sensor_noise_;  ///< [chambers]
};

}  // namespace palpate::virtual_robot

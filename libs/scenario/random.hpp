// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

namespace palpate::scenario {

/// Random numbers that are the same on every machine and with every standard library, and do not
/// depend on what else is drawn: each stream is a counter of its own, named by the seed and a text,
/// e.g. {seed, "marker_misplacement marker:tip"}. The n-th number of a stream is a hash of the name
/// and n (SplitMix64: G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number
/// generators, OOPSLA 2014). Not for secrets.
class Random {
 public:
  Random(std::uint64_t seed, std::string_view stream);

  std::uint64_t Bits();
  double Uniform();                      ///< [0, 1)
  std::size_t Below(std::size_t count);  ///< [0, count), count > 0
  /// Mean 0, standard deviation 1: the sum of twelve uniform numbers, which needs no logarithm (the
  /// last bit of those differs between machines). Never beyond 6.
  double Normal();
  Eigen::Vector3d Direction();  ///< of length 1, evenly over the sphere

 private:
  std::uint64_t key_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace palpate::scenario

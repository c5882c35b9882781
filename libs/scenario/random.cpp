// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/scenario/random.hpp"

#include "libs/core/check.hpp"

namespace palpate::scenario {

namespace {

constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15U;
constexpr double kShareOfBit = 0x1p-53;

std::uint64_t Mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

/// Fowler-Noll-Vo 1a.
std::uint64_t HashOf(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view stream)
    : key_(Mix(Mix(seed + kGolden) ^ HashOf(stream))) {}

std::uint64_t Random::Bits() { return Mix(key_ + kGolden * ++count_); }

double Random::Uniform() { return static_cast<double>(Bits() >> 11) * kShareOfBit; }

std::size_t Random::Below(std::size_t count) {
  PALPATE_CHECK(count > 0, count);
  return static_cast<std::size_t>(Bits() % count);
}

double Random::Normal() {
  std::int64_t sum = 0;  // in whole numbers: no rounding, whatever the machine
  for (int i = 0; i < 12; ++i) sum += static_cast<std::int64_t>(Bits() >> 11) - (1LL << 52);
  return static_cast<double>(sum) * kShareOfBit;
}

Eigen::Vector3d Random::Direction() {
  for (;;) {  // of the ball about the origin, by rejection from the cube
    const double x = 2.0 * Uniform() - 1.0;
    const double y = 2.0 * Uniform() - 1.0;
    const Eigen::Vector3d point(x, y, 2.0 * Uniform() - 1.0);
    const double length = point.norm();
    if (length > 0.1 && length <= 1.0) return point / length;
  }
}

}  // namespace palpate::scenario

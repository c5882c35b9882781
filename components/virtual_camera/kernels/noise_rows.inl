// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "components/virtual_camera/kernels/color_rows.inl"
#include "components/virtual_camera/kernels/lanes.inl"

namespace {

/// Mean 0, variance 1: the sum of eight bytes, of a random word and of its product with another.
PALPATE_LANES Float MoreNearlyNormal(Word random) {
  Word other = random * 0x9e3779b1U;
  other ^= other >> 15;
  return (NearlyNormal(random) + NearlyNormal(other)) * 0.70710678F;
}

/// [first, first + count) of an endless row of independent, nearly normal numbers.
void WhiteNoiseRow(std::uint32_t key_low, std::uint32_t key_high, std::uint32_t first, int count,
                   float* noise) {
  for (int i = 0; i < count; i += kWidth) {
    const Word counter = reinterpret_cast<Word>(Lanes() + i) + first;
    Store(noise + i, MoreNearlyNormal(RandomWord(counter, key_low, key_high)));
  }
}

/// out[i] = sum of weights[k] rows[k][i].
void Convolve(const float* const* rows, const float* weights, int weight_count, int count,
              float* out) {
  for (int i = 0; i < count; i += kWidth) {
    Float sum = weights[0] * Load(rows[0] + i);
    for (int k = 1; k < weight_count; ++k) sum += weights[k] * Load(rows[k] + i);
    Store(out + i, sum);
  }
}

void BlendRow(const float* fresh, float old_share, float fresh_share, int count, float* state) {
  for (int i = 0; i < count; i += kWidth) {
    Store(state + i, old_share * Load(state + i) + fresh_share * Load(fresh + i));
  }
}

}  // namespace

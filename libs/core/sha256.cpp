// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/sha256.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace palpate {

namespace {

using State = std::array<std::uint32_t, 8>;

constexpr size_t kBlockBytes = 64;

// FIPS 180-4, section 5.3.3: fractional parts of the square roots of the first 8 primes.
constexpr State kInitialState{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                              0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};

// Section 4.2.2: fractional parts of the cube roots of the first 64 primes.
constexpr std::array<std::uint32_t, 64> kRound{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::array<std::uint32_t, 64> ExpandBlock(std::string_view block) {
  std::array<std::uint32_t, 64> words{};
  for (size_t i = 0; i < kBlockBytes; ++i) {
    words[i / 4] = (words[i / 4] << 8) | static_cast<unsigned char>(block[i]);
  }
  for (size_t i = 16; i < words.size(); ++i) {
    const std::uint32_t a = words[i - 15];
    const std::uint32_t b = words[i - 2];
    const std::uint32_t s0 = std::rotr(a, 7) ^ std::rotr(a, 18) ^ (a >> 3);
    const std::uint32_t s1 = std::rotr(b, 17) ^ std::rotr(b, 19) ^ (b >> 10);
    words[i] = words[i - 16] + s0 + words[i - 7] + s1;
  }
  return words;
}

/// One round of section 6.2.2, step 3.
void TurnRound(State* state, std::uint32_t word, std::uint32_t round) {
  auto& [a, b, c, d, e, f, g, h] = *state;
  const std::uint32_t sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
  const std::uint32_t choice = (e & f) ^ (~e & g);
  const std::uint32_t t1 = h + sum1 + choice + round + word;
  const std::uint32_t sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
  const std::uint32_t majority = (a & b) ^ (a & c) ^ (b & c);
  *state = {t1 + sum0 + majority, a, b, c, d + t1, e, f, g};
}

void DigestBlock(std::string_view block, State* state) {
  const auto words = ExpandBlock(block);
  State turned = *state;
  for (size_t i = 0; i < words.size(); ++i) TurnRound(&turned, words[i], kRound[i]);
  for (size_t i = 0; i < turned.size(); ++i) (*state)[i] += turned[i];
}

/// The rest after the last whole block, with a 1 bit, zeros and the length in bits (section 5.1.1).
std::string PadRest(std::string_view bytes) {
  std::string rest(bytes.substr(bytes.size() / kBlockBytes * kBlockBytes));
  rest += '\x80';
  while (rest.size() % kBlockBytes != kBlockBytes - 8) rest += '\0';
  const std::uint64_t bits = 8 * static_cast<std::uint64_t>(bytes.size());
  for (int shift = 56; shift >= 0; shift -= 8) rest += static_cast<char>((bits >> shift) & 0xff);
  return rest;
}

}  // namespace

std::string Sha256Hex(std::string_view bytes) {
  State state = kInitialState;
  for (size_t i = 0; i + kBlockBytes <= bytes.size(); i += kBlockBytes) {
    DigestBlock(bytes.substr(i, kBlockBytes), &state);
  }
  const std::string rest = PadRest(bytes);
  for (size_t i = 0; i < rest.size(); i += kBlockBytes) {
    DigestBlock(std::string_view(rest).substr(i, kBlockBytes), &state);
  }
  std::string hex;
  for (const std::uint32_t word : state) {
    for (int shift = 28; shift >= 0; shift -= 4) hex += "0123456789abcdef"[(word >> shift) & 0xf];
  }
  return hex;
}

}  // namespace palpate

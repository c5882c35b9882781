// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/plot/color.hpp"

namespace palpate::view {

using plot::Color;
using plot::FromHex;
using plot::Mix;
using plot::SequentialColor;

namespace palette {
using namespace plot::palette;
inline constexpr Color kFloorLine = kGridLine;
inline constexpr Color kShadow = FromHex(0xEDF0F3);
inline constexpr Color kGhost = FromHex(0x8A97A5);
inline constexpr Color kClamp = FromHex(0xAEB8C2);
inline constexpr Color kSilicone = FromHex(0xC3D3E0);
inline constexpr Color kCable = FromHex(0x2B3A4A);
inline constexpr Color kEstimate = FromHex(0xC8102E);  ///< estimated forces
inline constexpr Color kTruth = FromHex(0x1D6FB8);     ///< known forces
inline constexpr Color kMarker = FromHex(0xF28E2B);    ///< observed points
inline constexpr Color kModelPoint = FromHex(0x111820);
inline constexpr Color kAxisX = FromHex(0xC0392B);
inline constexpr Color kAxisY = FromHex(0x2E8B57);
inline constexpr Color kAxisZ = FromHex(0x2F5FB3);
}  // namespace palette

}  // namespace palpate::view

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "libs/scenario/effect.hpp"

namespace palpate::virtual_robot {

using Effects = std::vector<scenario::ActiveEffect>;

/// Throws InputError for an effect that neither this component nor the camera's knows.
void CheckKnown(const Effects& effects);

/// The effects of one kind, in the order in which they are given.
std::vector<const scenario::ActiveEffect*> OfKind(const Effects& effects, std::string_view id);

/// A parameter of an effect. Throws InputError where it is missing or not finite.
double Value(const scenario::ActiveEffect& effect, std::string_view parameter);
/// Three of them, as a vector.
Eigen::Vector3d Values(const scenario::ActiveEffect& effect, std::string_view x, std::string_view y,
                       std::string_view z);
/// The same, refused unless it is > 0 (`above`) or >= 0.
double PositiveValue(const scenario::ActiveEffect& effect, std::string_view parameter);
double NonNegativeValue(const scenario::ActiveEffect& effect, std::string_view parameter);

/// Indices into `names` of the places "kind:name" that the effect names, in its order; `count` of
/// them. Throws InputError where there is no such name, or another number of places.
std::vector<int> PlacesOf(const scenario::ActiveEffect& effect, std::string_view kind,
                          const std::vector<std::string>& names, size_t count);
/// The same for one place.
int PlaceOf(const scenario::ActiveEffect& effect, std::string_view kind,
            const std::vector<std::string>& names);

}  // namespace palpate::virtual_robot

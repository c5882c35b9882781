// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>
#include <string>

#include "components/diagnosis/causes/cause.hpp"
#include "components/diagnosis/skin/skin_matcher.hpp"
#include "components/diagnosis/skin/skin_source.hpp"

namespace palpate::diagnosis {

/// What a first look at an experiment's pictures tells.
struct FirstLook {
  std::string why_unfit;                    ///< why they tell nothing; empty: they do
  std::optional<CauseName> exchanged = {};  ///< ShownRobot::exchanged, which they are matched about
};

/// Looks at all pictures and matches them, about the robot that stands nearest to where they show
/// one (WherePicturesShowIt). Tells `observed` what is known of the cameras, too.
FirstLook LookAtPictures(const robot::RobotBody& body, int threads, SkinSource* pictures,
                         SkinMatcher* matcher, ObservedExperiment* observed);

}  // namespace palpate::diagnosis

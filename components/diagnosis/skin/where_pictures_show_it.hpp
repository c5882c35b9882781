// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <optional>

#include "components/diagnosis/causes/cause.hpp"
#include "components/diagnosis/skin/skin_source.hpp"

namespace palpate::diagnosis {

/// A robot and what it has that the file's has not.
struct ShownRobot {
  ModelDraft draft;
  std::optional<CauseName> exchanged = {};  ///< the cables; none: it is the file's
};

/// Which robot stands nearest to where pictures show one: the robot file's, or one with two of its
/// cables exchanged, which bends so far to the other side that little of its skin is matched about
/// the file's. Goes by a picture or two for each cable, of when that is pulled the most.
ShownRobot WherePicturesShowIt(const robot::RobotBody& body, const ObservedExperiment& observed,
                               int threads, SkinSource* pictures);

}  // namespace palpate::diagnosis

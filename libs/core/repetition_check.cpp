// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/core/repetition_check.hpp"

#include <algorithm>
#include <functional>

namespace palpate {

bool RepetitionCheck::IsRepeated(std::string_view data, double mean) {
  const std::uint64_t hash = std::hash<std::string_view>()(data);
  if (has_last_ && hash == last_hash_) return is_noisy_;
  if (has_last_) LearnNoise(mean - last_mean_);
  has_last_ = true;
  last_hash_ = hash;
  last_mean_ = mean;
  return false;
}

void RepetitionCheck::LearnNoise(double step) {
  if (step == 0.0) return;
  if (last_step_ != 0.0) turned_back_.push_back((step > 0.0) != (last_step_ > 0.0));
  last_step_ = step;
  if (turned_back_.size() > tuning_.turns) turned_back_.pop_front();
  if (turned_back_.size() < tuning_.turns) return;
  const auto back = std::count(turned_back_.begin(), turned_back_.end(), true);
  if (static_cast<std::size_t>(back) >= tuning_.least_turns_back) is_noisy_ = true;
}

void RepetitionCheck::Forget() { *this = RepetitionCheck(tuning_); }

}  // namespace palpate

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/model/pixel_region.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/index.hpp"

namespace palpate::perception {

void PixelRegion::Place(int u, int v, int width_px, int height_px) {
  u_begin = u;
  v_begin = v;
  width = width_px;
  height = height_px;
  const std::size_t pixels =
      static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  z_m.assign(pixels, 0.0f);
  step_m.assign(pixels, 0.0f);
  distance_m.assign(pixels, 0.0f);
  evidence.assign(pixels, 0.0f);
  on_background.assign(pixels, 0);
  label.assign(pixels, Label::kNothing);
}

void EvidenceFilter::Smooth(PixelRegion* region) {
  between_.resize(region->size());
  AverageRing(*region, 1, region->evidence, &between_);
  support_ = count_;
  AverageRing(*region, 2, between_, &region->evidence);
}

void EvidenceFilter::AverageRing(const PixelRegion& region, int distance_px,
                                 const std::vector<float>& from, std::vector<float>* to) {
  count_.assign(region.size(), 0.0f);
  std::copy(from.begin(), from.end(), to->begin());
  const float scale = static_cast<float>(distance_px);
  for (int row = 0; row < region.height; ++row) {
    const std::size_t here = region.At(0, row);
    for (int down = -distance_px; down <= distance_px; down += distance_px) {
      if (row + down < 0 || row + down >= region.height) continue;
      const std::size_t there = region.At(0, row + down);
      for (int right = -distance_px; right <= distance_px; right += distance_px) {
        if (right == 0 && down == 0) continue;
        const int begin = std::max(0, -right);
        const int end = std::min(region.width, region.width - right);
        const float* z = region.z_m.data() + here;
        const float* z_there = region.z_m.data() + there + right;
        const float* step = region.step_m.data() + here;
        const float* value = from.data() + there + right;
        float* sum = to->data() + here;
        float* count = count_.data() + here;
        for (int u = begin; u < end; ++u) {
          const float same = std::abs(z_there[u] - z[u]) < scale * step[u] ? 1.0f : 0.0f;
          sum[u] += same * value[u];
          count[u] += same;
        }
      }
    }
    float* sum = to->data() + here;
    for (int u = 0; u < region.width; ++u)
      sum[u] /= 1.0f + count_[here + static_cast<std::size_t>(u)];
  }
}

void Patches::Find(const PixelRegion& region) {
  runs_.clear();
  int first_above = 0;
  for (int row = 0; row < region.height; ++row) {
    const int first_here = static_cast<int>(runs_.size());
    CutIntoRuns(region, row);
    Join(region, first_above, first_here);
    first_above = first_here;
  }
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const int root = RootOf(static_cast<int>(i));
    runs_[At(root)].pixels += runs_[i].end - runs_[i].begin;
  }
}

int Patches::RootOf(int run) {
  while (runs_[At(run)].parent != run) {
    Run& here = runs_[At(run)];
    here.parent = runs_[At(here.parent)].parent;
    run = here.parent;
  }
  return run;
}

void Patches::CutIntoRuns(const PixelRegion& region, int row) {
  const Label* label = region.label.data() + region.At(0, row);
  const float* z_m = region.z_m.data() + region.At(0, row);
  const float* step_m = region.step_m.data() + region.At(0, row);
  for (int u = 0; u < region.width;) {
    if (label[u] != Label::kRobot && label[u] != Label::kObject) {
      ++u;
      continue;
    }
    Run run;
    run.row = row;
    run.begin = u;
    run.label = label[u];
    run.parent = static_cast<int>(runs_.size());
    do {
      ++u;
    } while (u < region.width && label[u] == run.label &&
             std::abs(z_m[u] - z_m[u - 1]) < step_m[u]);
    run.end = u;
    runs_.push_back(run);
  }
}

void Patches::Join(const PixelRegion& region, int first_above, int first_here) {
  int above = first_above;
  const int end = static_cast<int>(runs_.size());
  for (int here = first_here; here < end; ++here) {
    const Run run = runs_[At(here)];
    while (above < first_here && runs_[At(above)].end <= run.begin) ++above;
    for (int other = above; other < first_here; ++other) {
      const Run& candidate = runs_[At(other)];
      if (candidate.begin >= run.end) break;
      if (candidate.label != run.label || !Touch(region, candidate, run)) continue;
      const int a = RootOf(other), b = RootOf(here);
      runs_[At(std::max(a, b))].parent = std::min(a, b);
    }
  }
}

bool Patches::Touch(const PixelRegion& region, const Run& above, const Run& here) const {
  for (int u = std::max(above.begin, here.begin); u < std::min(above.end, here.end); ++u) {
    const std::size_t a = region.At(u, above.row), b = region.At(u, here.row);
    if (std::abs(region.z_m[a] - region.z_m[b]) < region.step_m[b]) return true;
  }
  return false;
}

std::int64_t Patches::DropSmall(Label of, std::int64_t least, PixelRegion* region) {
  std::int64_t dropped = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = runs_[i];
    if (run.label != of) continue;
    const int root = RootOf(static_cast<int>(i));
    if (runs_[At(root)].pixels >= least) continue;
    const auto first = ToIndex(region->At(run.begin, run.row));
    std::fill_n(region->label.begin() + first, run.end - run.begin, Label::kSpeck);
    dropped += run.end - run.begin;
  }
  return dropped;
}

std::int64_t Patches::Largest(Label of) const {
  std::int64_t largest = 0;
  for (const Run& run : runs_) {
    if (run.label == of) largest = std::max(largest, run.pixels);
  }
  return largest;
}

}  // namespace palpate::perception

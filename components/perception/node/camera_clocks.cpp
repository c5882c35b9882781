// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/perception/node/camera_clocks.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/seconds.hpp"
#include "libs/core/text.hpp"

namespace palpate::perception {

namespace {

std::string InMilliseconds(double time_s) { return FormatNumber(std::round(1e4 * time_s) / 10.0); }

}  // namespace

void CameraClocks::Hear(std::size_t camera, const std::optional<dds::StampClock>& clock, Time now) {
  if (!clock) return;
  Camera& heard = cameras_[camera];
  if (!heard.host || heard.host->id != clock->host.id) heard = {clock->host, {}, now};
  if (clock->offset) heard.offset = clock->offset;
}

bool CameraClocks::HasFirstsClock(std::size_t camera) const {
  const std::optional<dds::Host>& first = cameras_[0].host;
  const std::optional<dds::Host>& own = cameras_[camera].host;
  return !first || !own || first->id == own->id;
}

/// The host of which no offset is known, the camera's or the first's; nullptr: both are.
const dds::Host* CameraClocks::Unmeasured(std::size_t camera) const {
  if (HasFirstsClock(camera)) return nullptr;
  for (const Camera* one : {&cameras_[camera], &cameras_[0]}) {
    if (!one->offset) return &*one->host;
  }
  return nullptr;
}

std::optional<ClockOffset> CameraClocks::ToFirst(std::size_t camera) const {
  if (HasFirstsClock(camera) || Unmeasured(camera) != nullptr) return std::nullopt;
  const ClockOffset& first = *cameras_[0].offset;
  const ClockOffset& own = *cameras_[camera].offset;
  return ClockOffset{first.offset_s - own.offset_s, first.bound_s + own.bound_s};
}

Status CameraClocks::Check(std::size_t camera) const {
  if (const dds::Host* host = Unmeasured(camera)) {
    return {StatusCode::kStale, "its clock is not known: no exchange of clocks with host '" +
                                    host->name + "' (palpate doctor checks the hosts)"};
  }
  const auto offset = ToFirst(camera);
  if (!offset || offset->bound_s <= tuning_.largest_bound_s) return Status::Ok();
  return {StatusCode::kStale, "its clock, of host '" + cameras_[camera].host->name +
                                  "', is known to +- " + InMilliseconds(offset->bound_s) +
                                  " ms: frames are joined up to +- " +
                                  InMilliseconds(tuning_.largest_bound_s) + " ms"};
}

std::int64_t CameraClocks::ToFirst_ns(std::size_t camera) const {
  const auto offset = ToFirst(camera);
  if (!offset || !Check(camera).ok()) return 0;
  return std::llround(1e9 * offset->offset_s);
}

Status CameraClocks::CheckWait(Time now) const {
  for (std::size_t k = 1; k < cameras_.size(); ++k) {
    const dds::Host* host = Unmeasured(k);
    if (host == nullptr) continue;
    const Time since = std::max(cameras_[k].since, cameras_[0].since);
    if (ToSeconds(now - since) > tuning_.longest_wait_s) continue;
    return {StatusCode::kStale, "the clock of host '" + host->name + "' is being measured"};
  }
  return Status::Ok();
}

}  // namespace palpate::perception

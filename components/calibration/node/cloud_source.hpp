// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "components/calibration/live/frame_collector.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::calibration {

/// Callbacks of CloudSource.
struct CloudEvents {
  std::function<void(SeenCloud)> seen;  ///< cloud without contacts
  std::function<void(const Status&)> refused;
  std::function<void(const std::string& device)> other_camera;  ///< the device has changed
};

/// Clouds of /perception/robot_cloud, combined with the /perception/report of their stamp.
class CloudSource {
 public:
  CloudSource(dds::Participant& participant, dds::WaitSet& loop, bool allow_contacts,
              CloudEvents events);

  std::uint64_t received() const { return received_; }
  std::uint32_t writers() const { return clouds_.matched(); }
  const dds::Endpoint& clouds() const { return clouds_; }
  const dds::Endpoint& reports() const { return reports_; }

 private:
  struct Report {
    std::string device;
    Status status;
    std::uint32_t contacts = 0;
    geometry::DepthPicture picture;
  };
  struct Parts {
    Status status = Status::Ok();
    std::optional<rgbd::SensedCloud> cloud;
    std::optional<Report> report;
  };

  void TakeClouds();
  void TakeReports();
  Parts& PartsAt(std::int64_t stamp_ns);
  void PassOn(std::int64_t stamp_ns);

  static constexpr std::size_t kMostPending = 32;

  bool allow_contacts_;
  CloudEvents events_;
  dds::Reader<idl::sensor_msgs::PointCloud2> clouds_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  std::map<std::int64_t, Parts> pending_;
  std::string device_;
  std::uint64_t received_ = 0;
};

}  // namespace palpate::calibration

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/calibration/live/frame_collector.hpp"
#include "libs/core/status.hpp"
#include "libs/dds/cloud_messages.hpp"
#include "libs/dds/participant.hpp"
#include "libs/dds/wait_set.hpp"

namespace palpate::calibration {

/// Callbacks of CloudSource.
struct CloudEvents {
  std::function<void(SeenCloud)> seen;  ///< cloud without contacts
  std::function<void(const Status&)> refused;
  std::function<void(const std::string& device)> other_camera;  ///< the device has changed
};

/// Clouds of /perception/robot_cloud, combined with the /perception/report of their stamp, and with
/// that of each camera beside the first.
class CloudSource {
 public:
  /// `cameras`: names of those beside the first.
  CloudSource(dds::Participant& participant, dds::WaitSet& loop, bool allow_contacts,
              CloudEvents events, const std::vector<std::string>& cameras = {});

  std::uint64_t received() const { return received_; }
  std::uint32_t writers() const { return clouds_.matched(); }
  const dds::Endpoint& clouds() const { return clouds_; }
  const dds::Endpoint& reports() const { return reports_; }
  /// Of the cameras beside the first.
  std::vector<const dds::Endpoint*> further_reports() const;

 private:
  struct Report {
    std::string device;
    Status status;
    std::uint32_t contacts = 0;
    geometry::DepthPicture picture;
    /// By which perception put the camera's points into the frame of the first.
    std::optional<Eigen::Isometry3d> T_first_camera;  ///< nullopt: it is no pose
  };
  struct Parts {
    Status status = Status::Ok();
    std::optional<dds::JoinedCloud> cloud;
    std::optional<Report> report;
    std::vector<std::optional<Report>> further;  ///< [further_]

    bool is_complete() const;
  };

  void TakeClouds();
  void TakeReports(dds::Reader<idl::palpate_msgs::PerceptionReport>& reader,
                   std::optional<std::size_t> further);
  Status Split(const Parts& parts, SeenCloud* seen) const;
  Parts& PartsAt(std::int64_t stamp_ns);
  void PassOn(std::int64_t stamp_ns);

  static constexpr std::size_t kMostPending = 32;

  bool allow_contacts_;
  CloudEvents events_;
  dds::Reader<idl::sensor_msgs::PointCloud2> clouds_;
  dds::Reader<idl::palpate_msgs::PerceptionReport> reports_;
  std::vector<std::unique_ptr<dds::Reader<idl::palpate_msgs::PerceptionReport>>> further_;
  std::map<std::int64_t, Parts> pending_;
  std::string device_;
  std::uint64_t received_ = 0;
};

}  // namespace palpate::calibration

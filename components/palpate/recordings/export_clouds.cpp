// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/ros_cloud.hpp"
#include "components/palpate/recordings/topic_export.hpp"
#include "libs/experiment/cloud/pcd.hpp"
#include "libs/experiment/cloud/ply.hpp"

namespace palpate::command {

namespace {

class CloudExport : public TopicExport {
 public:
  CloudExport(offline::MessageType type, std::filesystem::path folder, CloudFormat format)
      : type_(std::move(type)), folder_(std::move(folder)), format_(format) {}

  std::string Take(const recording::Message& message) override {
    std::string frame_id;
    experiment::PointCloud cloud;
    if (!offline::ReadCloud(message.data, type_, &frame_id, &cloud)) {
      return "is no cloud with x, y, z as FLOAT32 or FLOAT64";
    }
    std::filesystem::create_directories(folder_);
    const std::string name = std::to_string(offline::StampOf(message, type_));
    if (format_ == CloudFormat::kPly) {
      experiment::WritePly(cloud, folder_ / (name + ".ply"));
    } else {
      experiment::WritePcd(cloud, folder_ / (name + ".pcd"));
    }
    return {};
  }

 private:
  offline::MessageType type_;
  std::filesystem::path folder_;
  CloudFormat format_;
};

}  // namespace

std::unique_ptr<TopicExport> MakeCloudExport(offline::MessageType type,
                                             std::filesystem::path folder, CloudFormat format) {
  return std::make_unique<CloudExport>(std::move(type), std::move(folder), format);
}

}  // namespace palpate::command

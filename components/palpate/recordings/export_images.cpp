// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "components/offline/messages/ros_image.hpp"
#include "components/palpate/recordings/topic_export.hpp"
#include "libs/rgbd/png.hpp"

namespace palpate::command {

namespace {

class ImageExport : public TopicExport {
 public:
  ImageExport(offline::MessageType type, std::filesystem::path folder)
      : type_(std::move(type)), folder_(std::move(folder)) {}

  std::string Take(const recording::Message& message) override {
    offline::RosImage image;
    if (std::string cause = offline::ReadImage(message.data, type_, &image); !cause.empty())
      return cause;
    const auto file = folder_ / (std::to_string(offline::StampOf(message, type_)) + ".png");
    return image.IsDepth() ? TakeDepth(image, file) : TakeColor(image, file);
  }

 private:
  std::string TakeDepth(const offline::RosImage& image, const std::filesystem::path& file) {
    if (image.encoding == "32FC1") {
      return "encoding '32FC1' cannot be a PNG; `palpate export --experiment` makes 16-bit images "
             "of it";
    }
    offline::RosDepth depth;
    if (std::string cause = DecodeRosDepth(image, &depth); !cause.empty()) return cause;
    std::filesystem::create_directories(folder_);
    rgbd::WriteDepthPng(file, depth.steps);
    return {};
  }

  std::string TakeColor(const offline::RosImage& image, const std::filesystem::path& file) {
    rgbd::ColorImage color;
    if (std::string cause = DecodeRosColor(image, &color); !cause.empty()) return cause;
    std::filesystem::create_directories(folder_);
    rgbd::WriteColorPng(file, color);
    return {};
  }

  offline::MessageType type_;
  std::filesystem::path folder_;
};

}  // namespace

std::unique_ptr<TopicExport> MakeImageExport(offline::MessageType type,
                                             std::filesystem::path folder) {
  return std::make_unique<ImageExport>(std::move(type), std::move(folder));
}

}  // namespace palpate::command

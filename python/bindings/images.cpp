// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "libs/app/yaml.hpp"
#include "libs/core/error.hpp"
#include "libs/core/index.hpp"
#include "libs/experiment/cloud/point_cloud.hpp"
#include "libs/rgbd/color_image.hpp"
#include "libs/rgbd/image.hpp"
#include "libs/rgbd/png.hpp"
#include "libs/rgbd/rgbd_camera.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bind.hpp"
#include "python/bindings/experiment.hpp"
#include "python/bindings/keywords.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

using rgbd::CameraModel;
using rgbd::RgbdCamera;

/// An array that owns `image`: [h x w], of several channels [h x w x channels].
template <typename T, int kChannels>
py::array ArrayOf(rgbd::Image<T, kChannels> image) {
  auto* kept = new rgbd::Image<T, kChannels>(std::move(image));
  const py::capsule owner(
      kept, [](void* memory) { delete static_cast<rgbd::Image<T, kChannels>*>(memory); });
  std::vector<py::ssize_t> shape = {kept->height_px, kept->width_px};
  if (kChannels > 1) shape.push_back(kChannels);
  return py::array_t<T>(shape, kept->values.data(), owner);
}

/// Files of one kind in a recording, of which the last ones count from the end: -1 is the last.
const std::filesystem::path& FileAt(const std::vector<experiment::StampedFile>& files,
                                    py::ssize_t frame, const Recording& recording,
                                    const std::string& what) {
  const auto count = static_cast<py::ssize_t>(files.size());
  const py::ssize_t index = frame < 0 ? frame + count : frame;
  if (index < 0 || index >= count) {
    throw py::index_error("recording '" + recording.data().name + "' has " + std::to_string(count) +
                          " " + what + ", and none of number " + std::to_string(frame));
  }
  return files[static_cast<std::size_t>(index)].file;
}

RgbdCamera CameraOf(const Recording& recording) {
  const experiment::Recording& data = recording.data();
  if (!data.camera_file) {
    throw InputError("recording '" + data.name + "' has no camera.yaml: " + data.folder.string());
  }
  return rgbd::ReadCameraFile(*data.camera_file, app::LoadYaml);
}

/// read(file) of a frame, without the GIL.
template <typename Read>
auto ReadFrame(const std::vector<experiment::StampedFile>& files, py::ssize_t frame,
               const Recording& recording, const std::string& what, const Read& read) {
  const std::filesystem::path& file = FileAt(files, frame, recording, what);
  const py::gil_scoped_release released;
  return read(file);
}

py::array DepthSteps(const Recording& recording, py::ssize_t frame) {
  return ArrayOf(ReadFrame(recording.data().depth_images, frame, recording, "depth images",
                           rgbd::ReadDepthPng));
}

py::array Depth_m(const Recording& recording, py::ssize_t frame) {
  const auto read_m = [&](const std::filesystem::path& file) {
    const RgbdCamera camera = CameraOf(recording);
    const rgbd::DepthImage steps = rgbd::ReadDepthPng(file);
    rgbd::RangeImage range_m(steps.width_px, steps.height_px);
    for (std::size_t k = 0; k < steps.values.size(); ++k) {
      range_m.values[k] = steps.values[k] == camera.invalid_value
                              ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(steps.values[k] * camera.depth_unit_m);
    }
    return range_m;
  };
  return ArrayOf(
      ReadFrame(recording.data().depth_images, frame, recording, "depth images", read_m));
}

py::array ColorPixels(const Recording& recording, py::ssize_t frame) {
  return ArrayOf(ReadFrame(recording.data().color_images, frame, recording, "colour images",
                           rgbd::ReadColorImage));
}

py::array CloudPoints_m(const Recording& recording, py::ssize_t frame) {
  const experiment::PointCloud cloud =
      ReadFrame(recording.data().clouds, frame, recording, "clouds", experiment::ReadPointCloud);
  return CopyOfPoints(cloud.points_m);
}

RgbdCamera ReadCamera(const std::string& file) { return rgbd::ReadCameraFile(file, app::LoadYaml); }

Eigen::Matrix3d MatrixOf(const CameraModel& camera) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = camera.fx_px;
  K(1, 1) = camera.fy_px;
  K.topRightCorner<2, 1>() << camera.cx_px, camera.cy_px;
  return K;
}

void BindCameras(py::module_& module) {
  py::class_<CameraModel>(module, "CameraModel",
                          "A pinhole camera with OpenCV's rational lens distortion.")
      .def_readonly("width_px", &CameraModel::width_px)
      .def_readonly("height_px", &CameraModel::height_px)
      .def_property_readonly(
          "K", [](const CameraModel& camera) { return CopyOfMatrix(MatrixOf(camera)); })
      .def_property_readonly("distortion", [](const CameraModel& camera) {
        const auto numbers = camera.coefficients();
        return CopyOfVector(Eigen::Map<const Eigen::VectorXd>(
            numbers.data(), static_cast<Eigen::Index>(numbers.size())));
      });
  py::class_<RgbdCamera>(module, "Camera", "A depth camera and the colour camera beside it.")
      .def(
          py::init([](const py::kwargs& keys) { return rgbd::ReadCamera(TreeOf(keys, "Camera")); }))
      .def_static("read", &ReadCamera, py::arg("file"))
      .def_readonly("depth", &RgbdCamera::depth)
      .def_property_readonly("color",
                             [](const RgbdCamera& camera) {
                               std::optional<CameraModel> color;
                               if (camera.color.width_px > 0) color = camera.color;
                               return color;
                             })
      .def_readonly("depth_unit_m", &RgbdCamera::depth_unit_m)
      .def_readonly("invalid_value", &RgbdCamera::invalid_value)
      .def_readonly("color_registered", &RgbdCamera::color_registered)
      .def_property_readonly("T_depth_color", [](const RgbdCamera& camera) {
        return CopyOfMatrix(camera.T_depth_color.matrix());
      });
}

}  // namespace

void BindImages(py::module_& module, py::class_<Recording, std::shared_ptr<Recording>>& recording) {
  BindCameras(module);
  recording.def_property_readonly("camera", &CameraOf)
      .def("depth_steps", &DepthSteps, py::arg("frame"))
      .def("depth_m", &Depth_m, py::arg("frame"))
      .def("color", &ColorPixels, py::arg("frame"))
      .def("cloud_m", &CloudPoints_m, py::arg("frame"));
}

}  // namespace palpate::python

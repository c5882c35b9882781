// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "python/bindings/arrays.hpp"

#include <algorithm>
#include <cmath>

#include "libs/core/error.hpp"
#include "libs/core/text.hpp"

namespace py = pybind11;

namespace palpate::python {

namespace {

template <typename Number>
py::array View(std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides, const Number* data,
               py::handle owner) {
  py::array_t<Number> array(std::move(shape), std::move(strides), data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <typename Matrix>
py::array Columns(const Matrix& matrix, py::handle owner) {
  using Number = typename Matrix::Scalar;
  constexpr auto kSize = static_cast<py::ssize_t>(sizeof(Number));
  return View<Number>({matrix.cols(), matrix.rows()}, {kSize * matrix.outerStride(), kSize},
                      matrix.data(), owner);
}

constexpr auto kDouble = static_cast<py::ssize_t>(sizeof(double));

}  // namespace

py::array ViewOfVector(const Eigen::VectorXd& values, py::handle owner) {
  return View<double>({values.size()}, {kDouble}, values.data(), owner);
}

py::array ViewOfMatrix(const Eigen::MatrixXd& matrix, py::handle owner) {
  return View<double>({matrix.rows(), matrix.cols()}, {kDouble, kDouble * matrix.outerStride()},
                      matrix.data(), owner);
}

py::array ViewOfPoints(const Eigen::VectorXd& coordinates, py::handle owner) {
  return View<double>({coordinates.size() / 3, 3}, {3 * kDouble, kDouble}, coordinates.data(),
                      owner);
}

py::array ViewOfColumns(const Eigen::MatrixXd& matrix, py::handle owner) {
  return Columns(matrix, owner);
}

py::array ViewOfColumns(const Eigen::Matrix3Xd& matrix, py::handle owner) {
  return Columns(matrix, owner);
}

py::array ViewOfColumns(const Eigen::MatrixXi& matrix, py::handle owner) {
  return Columns(matrix, owner);
}

py::array CopyOfVector(const Eigen::VectorXd& values) {
  return py::array_t<double>(values.size(), values.data());
}

py::array CopyOfMatrix(const Eigen::MatrixXd& matrix) {
  const Eigen::MatrixXd by_rows = matrix.transpose();
  return py::array_t<double>({matrix.rows(), matrix.cols()}, by_rows.data());
}

py::array CopyOfPoints(const Eigen::Matrix3Xd& points) {
  return py::array_t<double>({points.cols(), Eigen::Index{3}}, points.data());
}

double RequireFinite(double value, const std::string& name) {
  if (!std::isfinite(value)) throw InputError(name + " is not finite");
  return value;
}

Eigen::Vector3d ReadVector3(const DoubleArray& values, const std::string& name) {
  if (values.ndim() != 1 || values.shape(0) != 3) {
    throw InputError(name + " must be three numbers");
  }
  const Eigen::Vector3d vector(values.at(0), values.at(1), values.at(2));
  if (!vector.allFinite()) throw InputError(name + " is not finite");
  return vector;
}

Eigen::Isometry3d ReadPose(const DoubleArray& matrix, const std::string& name) {
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4) {
    throw InputError(name + " must have the shape (4, 4)");
  }
  const Eigen::Matrix4d T = Eigen::Map<const Eigen::Matrix4d>(matrix.data()).transpose();
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  constexpr double kRounding = 1e-6;
  const bool is_rotation = R.isUnitary(kRounding) && R.determinant() > 0.0;
  if (!T.allFinite() || !is_rotation || T.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw InputError(name + " is no pose: it must have a rotation and the last row 0, 0, 0, 1");
  }
  return Eigen::Isometry3d(T);
}

Eigen::Matrix3Xd ReadPoints(const DoubleArray& points, const std::string& name) {
  if (points.ndim() != 2 || points.shape(1) != 3) {
    throw InputError(name + " must have the shape (n, 3)");
  }
  return Eigen::Map<const Eigen::Matrix3Xd>(points.data(), 3, points.shape(0));
}

int IndexOfWord(const std::string& word, const std::vector<std::string>& words,
                const std::string& what) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) {
    throw InputError("the robot has no " + what + " '" + word + "'" + DidYouMean(word, words));
  }
  return static_cast<int>(found - words.begin());
}

}  // namespace palpate::python

// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

/// Numpy arrays of what C++ holds, without copies, and what C++ takes from Python, checked.
namespace palpate::python {

using DoubleArray =
    pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Read-only views; `owner` keeps the memory.
pybind11::array ViewOfVector(const Eigen::VectorXd& values, pybind11::handle owner);
pybind11::array ViewOfMatrix(const Eigen::MatrixXd& matrix, pybind11::handle owner);
/// [n x 3] of coordinates [3n].
pybind11::array ViewOfPoints(const Eigen::VectorXd& coordinates, pybind11::handle owner);
/// [n x k] of the columns of a matrix [k x n].
pybind11::array ViewOfColumns(const Eigen::MatrixXd& matrix, pybind11::handle owner);
pybind11::array ViewOfColumns(const Eigen::Matrix3Xd& matrix, pybind11::handle owner);
pybind11::array ViewOfColumns(const Eigen::MatrixXi& matrix, pybind11::handle owner);
/// Copies that Python may change.
pybind11::array CopyOfVector(const Eigen::VectorXd& values);
pybind11::array CopyOfMatrix(const Eigen::MatrixXd& matrix);
/// [n x 3] of points [3 x n].
pybind11::array CopyOfPoints(const Eigen::Matrix3Xd& points);

/// Three finite numbers. Throws InputError, which names `name`.
Eigen::Vector3d ReadVector3(const DoubleArray& values, const std::string& name);
/// A pose of a 4 x 4 array, whose rotation may be off by rounding. Throws InputError for what is
/// none.
Eigen::Isometry3d ReadPose(const DoubleArray& matrix, const std::string& name);
/// [3 x n] of an array [n x 3], NaN where it has them. Throws InputError for another shape.
Eigen::Matrix3Xd ReadPoints(const DoubleArray& points, const std::string& name);
/// Throws InputError unless it is finite.
double RequireFinite(double value, const std::string& name);
/// The place of `word` in `words`. Throws InputError, with "did you mean": "the robot has no cable
/// 'x'".
int IndexOfWord(const std::string& word, const std::vector<std::string>& words,
                const std::string& what);

}  // namespace palpate::python

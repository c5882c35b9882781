// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "libs/fem/material.hpp"

/// The stresses of material.hpp for any scalar type, so that forward-mode differentiation gives
/// their derivatives. Only for element_derivative.cpp and point_stress.cpp.
namespace palpate::fem::element_derivative {

/// A number and its derivative in one direction: value + slope eps, eps^2 = 0.
struct Dual {
  double value = 0.0;
  double slope = 0.0;

  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT(google-explicit-constructor): a constant
  Dual(double v, double s) : value(v), slope(s) {}

  Dual& operator+=(const Dual& b) { return value += b.value, slope += b.slope, *this; }
  Dual& operator-=(const Dual& b) { return value -= b.value, slope -= b.slope, *this; }
  Dual& operator*=(const Dual& b) {
    slope = slope * b.value + value * b.slope;
    value *= b.value;
    return *this;
  }
  Dual& operator/=(const Dual& b) {
    value /= b.value;
    slope = (slope - value * b.slope) / b.value;
    return *this;
  }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator*(Dual a, const Dual& b) { return a *= b; }
  friend Dual operator/(Dual a, const Dual& b) { return a /= b; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
};

inline double Log(double a) { return std::log(a); }
inline Dual Log(const Dual& a) { return {std::log(a.value), a.slope / a.value}; }
inline double CubeRoot(double a) { return std::cbrt(a); }
inline Dual CubeRoot(const Dual& a) {
  const double root = std::cbrt(a.value);
  return {root, root * a.slope / (3.0 * a.value)};
}
inline double ValueOf(double a) { return a; }
inline double ValueOf(const Dual& a) { return a.value; }

template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;

/// The first Piola-Kirchhoff stress is linear in the Lame constants: P = lambda of_lambda +
/// mu of_mu.
template <typename T>
struct UnitStresses {
  Matrix3<T> of_lambda;
  Matrix3<T> of_mu;
};

/// Matrix of cofactors, d(det F)/dF.
template <typename T>
Matrix3<T> Cofactor(const Matrix3<T>& F) {
  Matrix3<T> cofactor;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      cofactor(i, j) = F(i1, j1) * F(i2, j2) - F(i1, j2) * F(i2, j1);
    }
  }
  return cofactor;
}

template <typename T>
T Determinant(const Matrix3<T>& F, const Matrix3<T>& cofactor) {
  return F(0, 0) * cofactor(0, 0) + F(0, 1) * cofactor(0, 1) + F(0, 2) * cofactor(0, 2);
}

/// Rotation of the polar decomposition, by Newton's iteration with Higham's scaling. The limit does
/// not depend on the scaling, so that it counts as a constant; the derivative converges one step
/// after the value.
template <typename T>
Matrix3<T> PolarRotation(const Matrix3<T>& F) {
  constexpr int kMaxSteps = 30;
  constexpr double kNearlyThere = 1e-9;  // squared by the next step
  Matrix3<T> R = F;
  int steps_left = kMaxSteps;
  while (steps_left-- > 0) {
    const Matrix3<T> cofactor = Cofactor(R);
    const T determinant = Determinant(R, cofactor);
    double cofactor_squared = 0.0;
    double squared = 0.0;
    for (int k = 0; k < 9; ++k) {
      cofactor_squared += ValueOf(cofactor(k)) * ValueOf(cofactor(k));
      squared += ValueOf(R(k)) * ValueOf(R(k));
    }
    const double det = ValueOf(determinant);
    const double scale = std::sqrt(std::sqrt(cofactor_squared / (det * det * squared)));
    const Matrix3<T> next = R * T(0.5 * scale) + cofactor * (T(0.5 / scale) / determinant);
    double change = 0.0;
    for (int k = 0; k < 9; ++k) {
      change = std::fmax(change, std::fabs(ValueOf(next(k)) - ValueOf(R(k))));
    }
    R = next;
    if (change < kNearlyThere && steps_left > 1) steps_left = 1;
  }
  return R;
}

/// det F, or 1 + tr(eps) for the linear law.
template <typename T>
T VolumeRatio(MaterialModel model, const Matrix3<T>& F) {
  if (model == MaterialModel::kLinear) return F.trace() - T(2.0);
  return Determinant(F, Cofactor(F));
}

/// With I = J^(-2/3) F : F, P = W' dI/dF + K (J - 1) cof F.
template <typename T>
Matrix3<T> YeohStressOfMu(const Material& material, const Matrix3<T>& F) {
  const Matrix3<T> cofactor = Cofactor(F);
  const T J = Determinant(F, cofactor);
  const T root = T(1.0) / CubeRoot(J);
  const T isochoric = root * root;
  const T F_squared = F.cwiseProduct(F).sum();
  const T stretch = isochoric * F_squared - T(3.0);
  const T slope = T(1.0) + stretch * (T(2.0 * material.c20_over_c10) +
                                      T(3.0 * material.c30_over_c10) * stretch);
  const Matrix3<T> dI = (F - cofactor * (F_squared / (T(3.0) * J))) * (T(2.0) * isochoric);
  return dI * (T(0.5) * slope) + cofactor * (T(2.0 / 3.0) * (J - T(1.0)));
}

/// `J`: the volume ratio that the volumetric part (what lambda multiplies) sees, of the point or
/// averaged over the element.
template <typename T>
UnitStresses<T> EvaluateStress(const Material& material, const Matrix3<T>& F, const T& J) {
  const Matrix3<T> identity = Matrix3<T>::Identity();
  switch (material.model) {
    case MaterialModel::kLinear:
      return {identity * (J - T(1.0)), F + F.transpose() - identity * T(2.0)};
    case MaterialModel::kCorotational: {
      const Matrix3<T> R = PolarRotation(F);
      const T stretch = (R.transpose() * F).trace() - T(3.0);
      return {R * stretch, (F - R) * T(2.0)};
    }
    case MaterialModel::kStVenantKirchhoff: {
      const Matrix3<T> twice_green = F.transpose() * F - identity;
      return {F * (twice_green.trace() * T(0.5)), F * twice_green};
    }
    case MaterialModel::kNeoHookean: {
      const Matrix3<T> cofactor = Cofactor(F);
      return {cofactor * (Log(J) / J), F - cofactor / Determinant(F, cofactor)};
    }
    case MaterialModel::kStableNeoHookean: {
      const Matrix3<T> cofactor = Cofactor(F);
      return {cofactor * (J - T(1.0)), F + cofactor * (Determinant(F, cofactor) - T(2.0))};
    }
    case MaterialModel::kYeoh: return {Cofactor(F) * (J - T(1.0)), YeohStressOfMu(material, F)};
  }
  return {};
}

}  // namespace palpate::fem::element_derivative

template <>
struct Eigen::NumTraits<palpate::fem::element_derivative::Dual> : Eigen::NumTraits<double> {
  using Real = palpate::fem::element_derivative::Dual;
  using NonInteger = palpate::fem::element_derivative::Dual;
  using Nested = palpate::fem::element_derivative::Dual;
  enum { RequireInitialization = 1, ReadCost = 2, AddCost = 2, MulCost = 4 };
};

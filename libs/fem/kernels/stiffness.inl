// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include "libs/fem/kernels/constitutive.inl"
#include "libs/fem/kernels/lanes.inl"

/// The tangent of an element from that of its integration points (constitutive.inl), pair of nodes
/// by pair of nodes: the nine entries stay in registers while the points are added.
namespace {

using palpate::fem::kernels::PairCount;

/// dN/dX of the lanes from `first` on.
template <int kNodes>
struct Gradients {
  const double* first;
  Vec At(int point, int node) const {
    const double* source = first + static_cast<long>((point * kNodes + node) * 3 * kLanes);
    return {{Load(source), Load(source + kLanes), Load(source + 2 * kLanes)}};
  }
};

/// v and d of every node at every point.
template <int kNodes, int kPoints>
struct Images {
  Vec v[kNodes][kPoints];
  Vec d[kNodes][kPoints];
};

/// What node b brings to its pairs at one point, weighted.
struct Column {
  Vec iso;     ///< (iso . G_a) I
  Vec main;    ///< v_a main'
  Vec skew;    ///< v_a skew' - skew v_a'
  Vec second;  ///< Yeoh: d_a second'; corotational: second d_a' - (second . v_a) tensor
  Vec green;   ///< StVK: (green . G_a) tensor
};

template <MaterialModel model>
PALPATE_INLINE Column MakeColumn(const Point& point, const Vec& gradient, const Vec& v,
                                 const Vec& d) {
  const Pack weight = point.weight;
  Column column;
  column.main = Scale(weight * point.main, v);
  if constexpr (Traits<model>::kGreen) {
    column.iso = Scale(weight, Times(point.second_map, gradient));
    column.green = Scale(weight * point.iso, gradient);
  } else {
    column.iso = Scale(weight * point.iso, gradient);
  }
  if constexpr (Traits<model>::kSkew) column.skew = Scale(weight * point.skew, v);
  if constexpr (Traits<model>::kRotation) column.second = Scale(weight * point.second, d);
  if constexpr (Traits<model>::kIsochoric) {
    column.main = Combine(weight * point.main, v, weight * point.cross, d);
    column.second = Combine(weight * point.second, d, weight * point.cross, v);
  }
  return column;
}

/// The block of one pair of nodes as it grows.
struct PairSum {
  Pack K[3][3];
  Pack skew[3];  ///< (0, 1), (0, 2), (1, 2) of the antisymmetric part
  Pack iso;
};

/// sum += a . b, in as many steps as there are products: the compiler may not reorder a sum.
PALPATE_INLINE void AddDot(const Vec& a, const Vec& b, Pack& sum) {
  for (int i = 0; i < 3; ++i) sum += a.v[i] * b.v[i];
}

PALPATE_INLINE void AddOuter(const Vec& a, const Vec& b, PairSum& sum) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) sum.K[i][k] += a.v[i] * b.v[k];
  }
}

/// (a b' - b a') in its entries (0, 1), (0, 2), (1, 2).
PALPATE_INLINE void AddWedge(const Vec& a, const Vec& b, Pack (&sum)[3]) {
  constexpr int kRow[3] = {0, 0, 1};
  constexpr int kColumn[3] = {1, 2, 2};
  for (int entry = 0; entry < 3; ++entry) {
    sum[entry] += a.v[kRow[entry]] * b.v[kColumn[entry]];
    sum[entry] -= a.v[kColumn[entry]] * b.v[kRow[entry]];
  }
}

/// Adds factor times a symmetric matrix.
PALPATE_INLINE void AddSymmetric(Pack factor, const Mat& tensor, PairSum& sum) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) sum.K[i][k] += factor * tensor.m[i < k ? i : k][i < k ? k : i];
  }
}

template <MaterialModel model>
PALPATE_INLINE void AddPoint(const Column& column, const Mat& tensor, const Vec& gradient,
                             const Vec& v, const Vec& d, PairSum& sum) {
  AddDot(column.iso, gradient, sum.iso);
  AddOuter(v, column.main, sum);
  if constexpr (Traits<model>::kSkew) {
    AddWedge(v, column.skew, sum.skew);
  }
  if constexpr (Traits<model>::kIsochoric) AddOuter(d, column.second, sum);
  if constexpr (Traits<model>::kRotation) {
    AddOuter(column.second, d, sum);
    AddSymmetric(-Dot(column.second, v), tensor, sum);
  }
  if constexpr (Traits<model>::kGreen) AddSymmetric(Dot(column.green, gradient), tensor, sum);
}

/// Adds one pair to the matrix, lane by lane, at values + addresses[lane].
template <MaterialModel model>
PALPATE_INLINE void AddPair(const PairSum& sum, const int* addresses, double* values) {
  Pack K[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) K[i][k] = sum.K[i][k];
    K[i][i] += sum.iso;
  }
  if constexpr (Traits<model>::kSkew) {
    K[0][1] += sum.skew[0];
    K[1][0] -= sum.skew[0];
    K[0][2] += sum.skew[1];
    K[2][0] -= sum.skew[1];
    K[1][2] += sum.skew[2];
    K[2][1] -= sum.skew[2];
  }
  Row rows[kWidth];
  MakeRows({K[0][0], K[1][0], K[2][0], K[0][1], K[1][1], K[2][1], K[0][2], K[1][2]}, rows);
  double nowhere[9] = {};
  for (int lane = 0; lane < kWidth; ++lane) {
    double* target = addresses[lane] < 0 ? nowhere : values + addresses[lane];
    AddRow(rows[lane], target);
    target[8] += K[2][2][lane];
  }
}

/// `mean_ddU_per_volume`, with mean dilatation: U'' / V of the rank-one part U'' / V C_a C_b',
/// C_a = sum of w v_a.
template <MaterialModel model, int kNodes, int kPoints, bool kMean>
PALPATE_INLINE void AddStiffness(const Point (&points)[kPoints], const Gradients<kNodes>& gradients,
                                 Pack mean_ddU_per_volume, const int* addresses, double* values) {
  Images<kNodes, kPoints> images;
  Vec C[kNodes];
  for (int a = 0; a < kNodes; ++a) {
    if constexpr (kMean) C[a] = {{Splat(0.0), Splat(0.0), Splat(0.0)}};
    for (int q = 0; q < kPoints; ++q) {
      const Vec gradient = gradients.At(q, a);
      images.v[a][q] = Times(points[q].map, gradient);
      if constexpr (Traits<model>::kSecondImage) {
        images.d[a][q] = Times(points[q].second_map, gradient);
      }
      if constexpr (kMean) C[a] = Combine(Splat(1.0), C[a], points[q].weight, images.v[a][q]);
    }
  }
  for (int b = 0; b < kNodes; ++b) {
    Column columns[kPoints];
    for (int q = 0; q < kPoints; ++q) {
      columns[q] = MakeColumn<model>(points[q], gradients.At(q, b), images.v[b][q], images.d[b][q]);
    }
    Vec mean_column;
    if constexpr (kMean) mean_column = Scale(mean_ddU_per_volume, C[b]);
    for (int a = b; a < kNodes; ++a) {
      PairSum sum = {};
      if constexpr (kMean) AddOuter(C[a], mean_column, sum);
#pragma GCC unroll 4
      for (int q = 0; q < kPoints; ++q) {
        AddPoint<model>(columns[q], points[q].tensor, gradients.At(q, a), images.v[a][q],
                        images.d[a][q], sum);
      }
      AddPair<model>(sum, addresses, values);
      addresses += kLanes;
    }
  }
}

}  // namespace

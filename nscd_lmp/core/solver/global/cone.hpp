// SPDX-License-Identifier: GPL-2.0-or-later
// The second-order cone |x_t| <= x_0 in three numbers. Planar contacts leave the last one 0, half lines the last two.
//
// Jordan algebra of Lorentz' product x o y = (x . y, x_0 y_t + y_0 x_t), and the scaling of Nesterov and Todd (1997).
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nscd::cone {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

inline double tangent(const Vector &x) { return std::hypot(x[1], x[2]); }

// The root of the determinant; 0 on the boundary, where round-off must not give NaN.
inline double lorentz(const Vector &x)
{
  constexpr double tiny = 1e-300;
  const double t = tangent(x);
  return std::sqrt(std::max((x[0] - t) * (x[0] + t), tiny));
}

inline Vector product(const Vector &x, const Vector &y)
{
  return {x.dot(y), x[0] * y[1] + y[0] * x[1], x[0] * y[2] + y[0] * x[2]};
}

// The y whose product with x is r.
inline Vector quotient(const Vector &x, const Vector &r)
{
  const double l = lorentz(x), first = (x[0] * r[0] - x[1] * r[1] - x[2] * r[2]) / (l * l);
  return {first, (r[1] - first * x[1]) / x[0], (r[2] - first * x[2]) / x[0]};
}

// The largest a with x + a dx in the cone; x lies inside.
inline double longest(const Vector &x, const Vector &dx)
{
  const double l = lorentz(x);
  const Vector unit = x / l;
  const double along = unit[0] * dx[0] - unit[1] * dx[1] - unit[2] * dx[2];
  const double f = (along + dx[0]) / (unit[0] + 1);
  const double rate = (std::hypot(dx[1] - f * unit[1], dx[2] - f * unit[2]) - along) / l;
  return rate > 0 ? 1 / rate : std::numeric_limits<double>::infinity();
}

// The symmetric S with S x = S^-1 z = lambda, and S^-1 = back.
struct Scaling {
  Matrix s, back;
  Vector lambda;

  Scaling(const Vector &x, const Vector &z)
  {
    const double lx = lorentz(x), lz = lorentz(z), beta = std::sqrt(lx / lz);
    Vector w = x / lx + Vector(z[0], -z[1], -z[2]) / lz;
    w /= lorentz(w);
    s = boost(w, -1) / beta;
    back = boost(w, 1) * beta;
    lambda = s * x;
  }

 private:
  static Matrix boost(const Vector &w, double sign)
  {
    Matrix m = Matrix::Identity();
    m(0, 0) = w[0];
    for (int a = 1; a < 3; ++a) {
      m(0, a) = m(a, 0) = sign * w[a];
      for (int b = 1; b < 3; ++b) m(a, b) += w[a] * w[b] / (1 + w[0]);
    }
    return m;
  }
};

}    // namespace nscd::cone

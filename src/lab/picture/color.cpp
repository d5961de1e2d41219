#include "picture/color.h"

#include <cmath>
#include <numbers>

namespace lacquer::picture {

namespace {

using Matrix = std::array<Color, 3>;

/// sRGB's primaries and white, in the fractions that FLIP's paper takes.
constexpr Matrix kToXyz{{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                         {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                         {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};
constexpr Color kWhite{kToXyz[0][0] + kToXyz[0][1] + kToXyz[0][2], kToXyz[1][0] + kToXyz[1][1] + kToXyz[1][2],
                       kToXyz[2][0] + kToXyz[2][1] + kToXyz[2][2]};

/// By cofactors.
constexpr Matrix inverse(const Matrix& m) {
  Matrix result{};
  double determinant = 0;
  for (size_t i = 0; i < 3; ++i) {
    const size_t i1 = (i + 1) % 3;
    const size_t i2 = (i + 2) % 3;
    for (size_t j = 0; j < 3; ++j) {
      const size_t j1 = (j + 1) % 3;
      const size_t j2 = (j + 2) % 3;
      result[j][i] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
    determinant += m[i][0] * result[0][i];
  }
  for (Color& row : result) {
    for (double& x : row) x /= determinant;
  }
  return result;
}
constexpr Matrix kFromXyz = inverse(kToXyz);

Color times(const Matrix& m, const Color& c) {
  Color result{};
  for (size_t i = 0; i < 3; ++i) result[i] = m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2];
  return result;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// The angle of a colour without any, 0 by the text's rule.
double hueOf(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double angle = std::atan2(b, a) * 180 / std::numbers::pi;
  return angle < 0 ? angle + 360 : angle;
}

/// From hue 1 to hue 2 the short way round; 0 where a colour has no hue.
double hueDifference(double c1, double c2, double h1, double h2) {
  if (c1 * c2 == 0) return 0;
  const double d = h2 - h1;
  return d > 180 ? d - 360 : d < -180 ? d + 360 : d;
}

double meanHue(double c1, double c2, double h1, double h2) {
  const double sum = h1 + h2;
  if (c1 * c2 == 0) return sum;
  if (std::abs(h1 - h2) <= 180) return sum / 2;
  return sum < 360 ? (sum + 360) / 2 : (sum - 360) / 2;
}

/// sqrt(x^7 / (x^7 + 25^7))
double saturated(double x) {
  const double x7 = std::pow(x, 7);
  return std::sqrt(x7 / (x7 + 6103515625.0));
}

}  // namespace

Color xyzOf(const Color& linear) { return times(kToXyz, linear); }
Color linearOf(const Color& xyz) { return times(kFromXyz, xyz); }

Color labOf(const Color& linear) {
  constexpr double kDelta = 6.0 / 29;
  const auto f = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Color xyz = xyzOf(linear);
  const double x = f(xyz[0] / kWhite[0]);
  const double y = f(xyz[1] / kWhite[1]);
  const double z = f(xyz[2] / kWhite[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color ycxczOf(const Color& linear) {
  const Color xyz = xyzOf(linear);
  const double x = xyz[0] / kWhite[0];
  const double y = xyz[1] / kWhite[1];
  const double z = xyz[2] / kWhite[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color linearOfYcxcz(const Color& ycxcz) {
  const double y = (ycxcz[0] + 16) / 116;
  return linearOf({(y + ycxcz[1] / 500) * kWhite[0], y * kWhite[1], (y - ycxcz[2] / 200) * kWhite[2]});
}

double deltaE2000(const Color& a, const Color& b) {
  const double mean_chroma = (std::hypot(a[1], a[2]) + std::hypot(b[1], b[2])) / 2;
  const double stretch = 1 + 0.5 * (1 - saturated(mean_chroma));
  const double c1 = std::hypot(a[1] * stretch, a[2]);
  const double c2 = std::hypot(b[1] * stretch, b[2]);
  const double h1 = hueOf(a[1] * stretch, a[2]);
  const double h2 = hueOf(b[1] * stretch, b[2]);
  const double dl = b[0] - a[0];
  const double dc = c2 - c1;
  const double dh = 2 * std::sqrt(c1 * c2) * std::sin(radians(hueDifference(c1, c2, h1, h2) / 2));
  const double l = (a[0] + b[0]) / 2 - 50;
  const double c = (c1 + c2) / 2;
  const double h = meanHue(c1, c2, h1, h2);
  const double t = 1 - 0.17 * std::cos(radians(h - 30)) + 0.24 * std::cos(radians(2 * h)) +
                   0.32 * std::cos(radians(3 * h + 6)) - 0.20 * std::cos(radians(4 * h - 63));
  const double sl = 1 + 0.015 * l * l / std::sqrt(20 + l * l);
  const double sc = 1 + 0.045 * c;
  const double sh = 1 + 0.015 * c * t;
  const double bump = (h - 275) / 25;
  const double turn = -2 * saturated(c) * std::sin(radians(60 * std::exp(-bump * bump)));
  const double x = dl / sl;
  const double y = dc / sc;
  const double z = dh / sh;
  return std::sqrt(x * x + y * y + z * z + turn * y * z);
}

}  // namespace lacquer::picture

#pragma once

#include <complex>
#include <optional>
#include <vector>

namespace raytruth {

/// How a scalar comes about on a ray parallel to an axis, where the tricubic B-spline is its kernel in one dimension.
struct ReconstructionPath {
  bool prefiltered = false;             ///< from the coefficients of the interpolating spline; else from the voxels
  std::optional<double> virtual_phase;  ///< Catmull-Rom through samples at unit steps, voxel centres being phase 0;
                                        ///< none: the spline itself at every point
};

/// The Fourier transform G(f) = integral g(x) e^{-2 pi i f x} dx, f in cycles per voxel, of what a unit impulse at
/// voxel x = 0 becomes, in closed form. With sinc(f) = sin(pi f) / (pi f) and phase p:
///     B-spline          sinc^4(f)
///     prefilter         3 / (2 + cos 2 pi f)                                                (Unser 1999)
///     virtual samples   C(f) sum over k of b(k + p) e^{-2 pi i f (k + p)},  C(f) = sinc^3(f) (3 sinc(f) - 2 cos pi f),
/// b the B-spline, which is sampled at k + p, and C the transform of the Catmull-Rom kernel (Keys 1981, a = -1/2). The
/// sum repeats the spline's spectrum around every whole frequency: sum over m of sinc^4(f - m) e^{-2 pi i m p}.
/// Zero exactly at whole frequencies but 0; elsewhere within 64 epsilon.
std::complex<double> frequency_response(const ReconstructionPath& path, double frequency);

/// The transform, measured: an impulse in a voxel grid is traced, sampled and interpolated by the code that everything
/// else here uses, and then read at equal steps.
class ImpulseResponse {
 public:
  /// Throws InputError unless samples_per_voxel > 2.
  ImpulseResponse(const ReconstructionPath& path, int samples_per_voxel);

  /// The sum of step g(x_j) e^{-2 pi i f x_j}: G(f) and its aliases, the sum over n of G(f + n N) e^{2 pi i n N x_0},
  /// N samples per voxel.
  [[nodiscard]] std::complex<double> at(double frequency) const;

  /// Bound on the rounding error of at(f).
  [[nodiscard]] double radius() const { return radius_; }

  /// Bound on the aliases for |f| <= 2, the terms with n != 0. As g has a continuous slope, |G(f)| <= V / (2 pi |f|)^3,
  /// V the variation of g''; so together they are at most 2 zeta(3) V / (2 pi (N - 2))^3.
  [[nodiscard]] double aliases() const { return aliases_; }

 private:
  std::vector<double> values_;
  double first_ = 0;  ///< position of the first value, from the impulse
  double step_ = 0;
  double radius_ = 0;
  double aliases_ = 0;
};

}  // namespace raytruth

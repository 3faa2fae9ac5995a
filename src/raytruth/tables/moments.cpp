#include "raytruth/tables/moments.hpp"

#include "raytruth/tables/exponential_moments.hpp"
#include "raytruth/tables/subranges.hpp"
#include "raytruth/transfer/emission.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace raytruth {

namespace {

using Vec4 = Eigen::Array<double, 4, 1>;

/// RGB and white light times the k-th power of its distance from the front, in intervals.
struct MomentSlab {
  std::array<Vec4, 4> moments;
  double transmittance = 1;
  double intervals = 0;
};

MomentSlab combine(const MomentSlab& a, const MomentSlab& b) {
  const double x = a.intervals;
  const auto& m = b.moments;
  // Horner's scheme for the moments of b about the front of a.
  const Vec4 first = m[1] + x * m[0];
  const Vec4 second = m[2] + x * (2 * m[1] + x * m[0]);
  const Vec4 third = m[3] + x * (3 * m[2] + x * (3 * m[1] + x * m[0]));
  const double t = a.transmittance;
  return {{a.moments[0] + t * m[0], a.moments[1] + t * first, a.moments[2] + t * second, a.moments[3] + t * third},
          t * b.transmittance,
          a.intervals + b.intervals};
}

/// J_k times the density of white light, both in units of the stretch.
std::array<double, 4> white_moments(double extinction, Emission emission, double length) {
  if (extinction == std::numeric_limits<double>::infinity())
    return {emission == Emission::associated ? 1.0 : 0.0, 0, 0, 0};
  std::array<double, 4> moments = exponential_moments(extinction * length);
  for (double& moment : moments) moment *= emission == Emission::associated ? extinction * length : length;
  return moments;
}

MomentSlab homogeneous(const Optics& optics, Emission emission, double length) {
  return {homogeneous_moments(optics, emission, length), std::exp(-optics.extinction * length), 1};
}

/// White light times its distance from the front, and from the back.
struct TentSlab {
  double light = 0;
  double from_front = 0;
  double from_back = 0;
  double transmittance = 1;
  double intervals = 0;
};

TentSlab combine(const TentSlab& a, const TentSlab& b) {
  return {a.light + a.transmittance * b.light, a.from_front + a.transmittance * (b.from_front + a.intervals * b.light),
          a.from_back + b.intervals * a.light + a.transmittance * b.from_back, a.transmittance * b.transmittance,
          a.intervals + b.intervals};
}

TentSlab half_interval(const Optics& optics, Emission emission, double length) {
  const auto white = white_moments(optics.extinction, emission, length / 2);
  return {white[0], white[1] / 2, (white[0] - white[1]) / 2, std::exp(-optics.extinction * length / 2), 0.5};
}

/// I'' of a slab of two halves.
double tent(const TentSlab& front, const TentSlab& back) {
  return (front.from_front + front.transmittance * back.from_back) / front.intervals;
}

}  // namespace

std::array<Vec4, 4> homogeneous_moments(const Optics& optics, Emission emission, double length) {
  const auto white = white_moments(optics.extinction, emission, length);
  std::array<Vec4, 4> moments;
  for (std::size_t k = 0; k < 4; ++k) moments[k] << white[k] * optics.color, white[k];
  return moments;
}

MomentTables moment_tables(const DiscreteTransfer& transfer, const TableAxes& axes) {
  MomentTables tables{{Table<double>(axes), Table<double>(axes), Table<double>(axes), Table<double>(axes)},
                      Table<double>(axes)};
  const auto write = [&tables](std::size_t front, std::size_t back, const MomentSlab& slab, double tent) {
    double scale = 1;
    for (std::size_t k = 0; k < 4; ++k) {
      tables.moments[k].set(front, back, slab.moments[k] / scale);
      scale *= slab.intervals;
    }
    tables.tent.set(front, back, {tent, tent, tent, 1 - slab.transmittance});
  };
  const auto join = [](const auto& a, const auto& b) { return combine(a, b); };

  for_each_diagonal(axes.size, [&](const Diagonal& diagonal) {
    const std::size_t width = diagonal.width;
    const double length = axes.length / static_cast<double>(width);
    const auto elements = elements_of(transfer.intervals, diagonal.backwards, [&](const Optics& optics) {
      return homogeneous(optics, transfer.emission, length);
    });
    std::vector<TentSlab> halves;
    for (const TentSlab& half : elements_of(transfer.intervals, diagonal.backwards, [&](const Optics& optics) {
           return half_interval(optics, transfer.emission, length);
         }))
      halves.insert(halves.end(), 2, half);
    std::vector<TentSlab> half_slabs(halves.size() - width + 1);
    for_each_subrange(halves, width, join, [&](std::size_t first, const TentSlab& slab) { half_slabs[first] = slab; });
    for_each_subrange(elements, width, join, [&](std::size_t first, const MomentSlab& slab) {
      write(diagonal.front(first), diagonal.back(first), slab,
            tent(half_slabs[2 * first], half_slabs[2 * first + width]));
    });
  });
  for (std::size_t i = 0; i < axes.size; ++i) {
    const TentSlab half = half_interval(transfer.entries[i], transfer.emission, axes.length);
    write(i, i, homogeneous(transfer.entries[i], transfer.emission, axes.length), tent(half, half));
  }
  return tables;
}

}  // namespace raytruth

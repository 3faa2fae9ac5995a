#pragma once

#include "raytruth/tables/subrange.hpp"

namespace raytruth {

/// The light of a slab, divided between its front and its back (Lum 2004, section 3): a share of 1 - s and of s, where
/// s runs from 0 at the front to 1 at the back. The opacity is the whole slab's in both. With `whitened` colours these
/// are the specular tables.
template <class Real>
struct WeightedTables {
  Table<Real> front;
  Table<Real> back;
};

/// Slabs that keep apart how far from either end their light comes.
template <class Real>
struct WeightedSlab {
  typename Rules<Real>::vec4 slab;
  Vector3<Real> from_front;  ///< M: light times its distance from the front, in intervals
  Vector3<Real> from_back;
  Real intervals{};
};

/// M(ab) = M_a + T_a (M_b + len_a C_b), and likewise from the back: sums of what is never negative.
template <class Real>
WeightedSlab<Real> combine(const WeightedSlab<Real>& a, const WeightedSlab<Real>& b) {
  const Real transmittance = Real(1) - a.slab[3];
  const Vector3<Real> light_a = a.slab.template head<3>();
  const Vector3<Real> light_b = b.slab.template head<3>();
  return {Rules<Real>{}.over(a.slab, b.slab), a.from_front + transmittance * (b.from_front + a.intervals * light_b),
          (a.from_back + b.intervals * light_a) + transmittance * b.from_back, a.intervals + b.intervals};
}

/// The weighted tables without a difference: slabs (C, M) as above, all of an interval's light in its middle, so that
/// interval k weighs (k - i + 1/2) / (j - i) towards the back and front and back are symmetric. i = j: half and half.
template <class Real>
WeightedTables<Real> weighted_tables(const DiscreteTransfer& transfer, const TableAxes& axes) {
  WeightedTables<Real> tables{Table<Real>(axes), Table<Real>(axes)};
  const auto stretch = [&](double length) {
    return [&transfer, length](const Optics& optics) {
      const auto slab = homogeneous_stretch<Real>(optics, transfer.emission, length);
      const Vector3<Real> half = Real(0.5) * slab.template head<3>();
      return WeightedSlab<Real>{slab, half, half, Real(1)};
    };
  };
  const auto write = [&tables](std::size_t front, std::size_t back, const WeightedSlab<Real>& value) {
    auto texel = value.slab;
    texel.template head<3>() = value.from_back / value.intervals;
    tables.front.set(front, back, texel);
    texel.template head<3>() = value.from_front / value.intervals;
    tables.back.set(front, back, texel);
  };
  for_each_entry(
      axes.size,
      [&](std::size_t width, bool backwards) {
        return elements_of(transfer.intervals, backwards, stretch(axes.length / static_cast<double>(width)));
      },
      combine<Real>, write);
  for (std::size_t i = 0; i < axes.size; ++i) write(i, i, stretch(axes.length)(transfer.entries[i]));
  return tables;
}

/// Lum 2004, section 4.3 as printed: colours times a ramp over the whole transfer function give C^G by the same
/// subranges, and
///
///     C^W = (C^G - i C^1) / (j - i) for i < j,  (i C^1 - C^G) / (i - j) for i > j
///
/// towards the back; towards the front C^1 - C^W. The differences of large numbers lose digits. Weights are those of
/// `weighted_tables`: interval k has the ramp's value k + 1/2.
template <class Real>
WeightedTables<Real> weighted_tables_by_difference(const DiscreteTransfer& transfer, const TableAxes& axes) {
  WeightedTables<Real> tables{subrange_table<Real>(transfer, axes), Table<Real>(axes)};
  const auto ramped = [&](const Optics& optics, double position, double length) {
    auto slab = homogeneous_stretch<Real>(optics, transfer.emission, length);
    const Vector3<Real> light = slab.template head<3>();
    slab.template head<3>() = Real(position) * light;
    return slab;
  };
  composite_subranges(tables.back, [&](std::size_t width, bool backwards) {
    return elements_of(transfer.intervals, backwards, [&](const Optics& interval) {
      const auto k = static_cast<double>(&interval - transfer.intervals.data());
      return ramped(interval, k + 0.5, axes.length / static_cast<double>(width));
    });
  });
  for (std::size_t i = 0; i < axes.size; ++i) tables.back.set(i, i, ramped(transfer.entries[i], 0.5, axes.length));
  for (std::size_t back = 0; back < axes.size; ++back)
    for (std::size_t front = 0; front < axes.size; ++front) {
      const auto whole = tables.front.at(front, back);
      auto weighted = tables.back.at(front, back);
      const Real i(static_cast<double>(front));
      const Real j(static_cast<double>(back));
      if (front != back)
        for (int channel = 0; channel < 3; ++channel)
          weighted[channel] = (weighted[channel] - i * whole[channel]) / (j - i);
      auto rest = whole;
      rest.template head<3>() = whole.template head<3>() - weighted.template head<3>();
      tables.front.set(front, back, rest);
      tables.back.set(front, back, weighted);
    }
  return tables;
}

}  // namespace raytruth

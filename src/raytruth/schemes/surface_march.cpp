#include "raytruth/schemes/surface_march.hpp"

#include "raytruth/rules/rules.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace raytruth {

namespace {

using Vec4 = Rules<double>::vec4;

Vec4 with_fourth(const Vector3<double>& vector, double fourth) { return {vector[0], vector[1], vector[2], fourth}; }

/// Something behind what there is.
void put_behind(const Vec4& next, SurfaceOutcome& outcome) {
  const Vec4 all = Rules<double>{}.over(outcome.rgba(), next);
  outcome.color = all.head<3>();
  outcome.opacity = all[3];
  ++outcome.composites;
}

}  // namespace

Vector3<double> normal_of(const SurfaceScheme& scheme, const SampledHit& hit, const Samples<double>& samples,
                          const std::function<Vector3<double>(double t)>& normal_at) {
  if (!scheme.interpolates_normals) return normal_at(hit.normal_t);
  const auto begin = static_cast<double>(samples.positions[hit.interval]);
  const auto end = static_cast<double>(samples.positions[hit.interval + 1]);
  const Vec4 normal = Rules<double>{}.isosurface_normal(
      with_fourth(normal_at(begin), 0), with_fourth(normal_at(end), 0), (hit.normal_t - begin) / (end - begin));
  return normal.head<3>();
}

SurfaceMarch::SurfaceMarch(const PiecewiseLinear& transfer, Emission emission, std::vector<Isosurface> isosurfaces)
    : look_up_(transfer, emission), matter_(transfer, emission), isosurfaces_(std::move(isosurfaces)) {
  check(isosurfaces_);
  for (const Isosurface& surface : isosurfaces_) scalars_.push_back(surface.s);
}

void SurfaceMarch::add_line(double from, double s_from, double to, double s_to) {
  if (!(from < to)) return;
  const double length = to - from;
  stretch_.pieces.push_back({stretch_.end, length, Rules<double>::cubic(Rules<double>{}.order1(s_from, s_to))});
  stretch_.end += DoubleDouble(length);
}

void SurfaceMarch::close_stretch(SurfaceOutcome& outcome) {
  if (stretch_.pieces.empty()) return;
  const Certified matter = matter_(stretch_);
  outcome.lookups += static_cast<std::int64_t>(stretch_.pieces.size());
  outcome.radius += matter.radius;
  if (matter.status != Status::converged) outcome.status = matter.status;
  put_behind(matter.rgba(), outcome);
  stretch_.pieces.clear();
  stretch_.end = DoubleDouble(0);
}

template <int Degree>
SurfaceOutcome SurfaceMarch::operator()(const SurfaceScheme& scheme, const Chain<Degree>& signal,
                                        const Samples<double>& samples, double tolerance, const ColorOf& color_of) {
  SurfaceOutcome outcome;
  outcome.hits = sampled_hits(scheme.method, signal, samples, scalars_, tolerance);
  outcome.fetches = static_cast<std::int64_t>(samples.values.size());
  if (scheme.method == SurfaceMethod::peak_finding)
    outcome.fetches += regula_falsi_steps * static_cast<std::int64_t>(outcome.hits.size());
  outcome.voxels = voxels_per_fetch * outcome.fetches;
  const auto place = [&samples](std::size_t k) { return static_cast<double>(samples.positions[k]); };
  std::size_t next = 0;
  const auto meet = [&] {
    const SampledHit& hit = outcome.hits[next++];
    const Isosurface& surface = isosurfaces_[hit.surface];
    const Vector3<double> color = color_of ? color_of(hit) : surface.color;
    put_behind(Rules<double>{}.isosurface_slab(with_fourth(color, surface.opacity)), outcome);
  };
  for (std::size_t k = 0; k < samples.interval_count(); ++k) {
    const double begin = place(k);
    const double end = place(k + 1);
    if (scheme.samples_matter) {
      while (next < outcome.hits.size() && outcome.hits[next].interval == k && outcome.hits[next].t <= begin) meet();
      put_behind(Rules<double>{}.homogeneous_slab(look_up_(samples.values[k]), end - begin, false), outcome);
      ++outcome.lookups;
      while (next < outcome.hits.size() && outcome.hits[next].interval == k) meet();
      continue;
    }
    double t = begin;
    double s = samples.values[k];
    while (next < outcome.hits.size() && outcome.hits[next].interval == k) {
      const SampledHit& hit = outcome.hits[next];
      add_line(t, s, hit.t, scalars_[hit.surface]);
      close_stretch(outcome);
      t = hit.t;
      s = scalars_[hit.surface];
      meet();
    }
    add_line(t, s, end, samples.values[k + 1]);
  }
  close_stretch(outcome);
  while (next < outcome.hits.size()) meet();
  return outcome;
}

template SurfaceOutcome SurfaceMarch::operator()(const SurfaceScheme&, const Chain<3>&, const Samples<double>&, double,
                                                 const ColorOf&);
template SurfaceOutcome SurfaceMarch::operator()(const SurfaceScheme&, const Chain<largest_degree>&,
                                                 const Samples<double>&, double, const ColorOf&);

}  // namespace raytruth

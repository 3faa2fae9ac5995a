#include "raytruth/schemes/surface_method.hpp"

#include "raytruth/rules/rules.hpp"

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

/// How many of the surfaces a scalar is at or above.
std::size_t class_of(double s, const std::vector<double>& scalars) {
  const auto is_reached = [s](double scalar) { return Rules<double>{}.isosurface_class(s, scalar) == 1; };
  return static_cast<std::size_t>(std::partition_point(scalars.begin(), scalars.end(), is_reached) - scalars.begin());
}

/// Where the line between two samples passes a scalar.
double place_on_line(const Samples<double>& samples, std::size_t interval, double scalar) {
  const double share =
      Rules<double>{}.isosurface_crossing(samples.values[interval], samples.values[interval + 1], scalar);
  return static_cast<double>(samples.positions[interval]) + share * samples.length_of(interval);
}

/// Where the signal passes it, by regula falsi.
template <int Degree>
double place_on_signal(const Chain<Degree>& signal, const Samples<double>& samples, std::size_t interval,
                       double scalar) {
  Rules<double> rules;
  Rules<double>::vec4 bracket{static_cast<double>(samples.positions[interval]),
                              static_cast<double>(samples.positions[interval + 1]), samples.values[interval] - scalar,
                              samples.values[interval + 1] - scalar};
  double place = bracket[0];
  for (int step = 0; step < regula_falsi_steps; ++step) {
    place = rules.isosurface_regula_falsi(bracket);
    bracket = rules.isosurface_bracket(bracket, place, signal.value(DoubleDouble(place)) - scalar);
  }
  return place;
}

/// The state moves by one value at each sample, towards the class that the sample has.
std::vector<SampledHit> one_per_step(const Samples<double>& samples, const std::vector<double>& scalars) {
  std::vector<SampledHit> hits;
  if (samples.values.empty()) return hits;
  std::size_t state = class_of(samples.values.front(), scalars);
  for (std::size_t i = 1; i < samples.values.size(); ++i) {
    const std::size_t target = class_of(samples.values[i], scalars);
    if (target == state) continue;
    const std::size_t surface = target > state ? state : state - 1;
    const auto t = static_cast<double>(samples.positions[i]);
    hits.push_back({t, surface, i - 1, t});
    state = target > state ? state + 1 : state - 1;
  }
  return hits;
}

std::vector<SampledHit> near_samples(const Samples<double>& samples, const std::vector<double>& scalars,
                                     double tolerance) {
  std::vector<SampledHit> hits;
  for (std::size_t i = 0; i < samples.values.size(); ++i)
    for (std::size_t surface = 0; surface < scalars.size(); ++surface) {
      if (!(std::abs(samples.values[i] - scalars[surface]) < tolerance)) continue;
      const auto t = static_cast<double>(samples.positions[i]);
      hits.push_back({t, surface, i, t});
    }
  return hits;
}

}  // namespace

namespace catalogue {

const std::vector<SurfaceScheme>& surface_schemes() {
  static const std::vector<SurfaceScheme> list{
      {.name = "every_crossing",
       .summary = "all isosurfaces passed between two samples, each where the line between them has its value",
       .source = "Engel, Kraus and Ertl 2001, for any number of them",
       .method = SurfaceMethod::every_crossing,
       .interpolates_normals = true,
       .color = "#0072B2",
       .marker = "o"},
      {.name = "nearest_normal",
       .summary = "the same, all of them lit by the first one's normal",
       .source = "Meissner et al. 2002, as Lum 2004, section 2.1, tells it",
       .method = SurfaceMethod::nearest_normal,
       .interpolates_normals = true,
       .color = "#56B4E9",
       .marker = "s"},
      {.name = "nearest_only",
       .summary = "the first isosurface passed between two samples, and no other",
       .source = "Lum 2004, section 2.1",
       .method = SurfaceMethod::nearest_only,
       .interpolates_normals = true,
       .color = "#009E73",
       .marker = "^"},
      {.name = "one_per_step",
       .summary = "the state moves by one isosurface at each sample, where the surface is drawn",
       .source = "VTK's isosurface blending",
       .method = SurfaceMethod::one_per_step,
       .samples_matter = true,
       .color = "#D55E00",
       .marker = "v"},
      {.name = "peak_finding",
       .summary = "the first isosurface passed, its place by three steps of regula falsi on the signal",
       .source = "Knoll et al. 2009, as we read it",
       .method = SurfaceMethod::peak_finding,
       .samples_matter = true,
       .color = "#CC79A7",
       .marker = "D"},
      {.name = "threshold",
       .summary = "an isosurface at every sample that is nearer to its value than a tolerance",
       .source = "",
       .method = SurfaceMethod::threshold,
       .samples_matter = true,
       .color = "#999999",
       .marker = "x"},
      {.name = "isoslab_per_crossing",
       .summary = "slabs around isosurfaces from a table, as deep as a crossing at every angle",
       .source = "Kraus 2005",
       .isoslab = IsoslabDensity::per_crossing,
       .color = "#882255",
       .marker = "d"},
      {.name = "isoslab_per_length",
       .summary = "slabs around isosurfaces from a table, as deep as a crossing at one slope of the scalar",
       .source = "Lum 2004, sections 2 and 5.2",
       .isoslab = IsoslabDensity::per_length,
       .color = "#AA4499",
       .marker = "P"},
  };
  return list;
}

}  // namespace catalogue

template <int Degree>
std::vector<SampledHit> sampled_hits(SurfaceMethod method, const Chain<Degree>& signal, const Samples<double>& samples,
                                     const std::vector<double>& scalars, double tolerance) {
  if (method == SurfaceMethod::one_per_step) return one_per_step(samples, scalars);
  if (method == SurfaceMethod::threshold) return near_samples(samples, scalars, tolerance);
  const bool is_one = method == SurfaceMethod::nearest_only || method == SurfaceMethod::peak_finding;
  std::vector<SampledHit> hits;
  for (std::size_t interval = 0; interval < samples.interval_count(); ++interval) {
    const std::size_t front = class_of(samples.values[interval], scalars);
    const std::size_t back = class_of(samples.values[interval + 1], scalars);
    const std::size_t passed = front < back ? back - front : front - back;
    const std::size_t first = hits.size();
    for (std::size_t i = 0; i < (is_one ? std::min<std::size_t>(passed, 1) : passed); ++i) {
      const std::size_t surface = front < back ? front + i : front - 1 - i;
      const double t = method == SurfaceMethod::peak_finding
                           ? place_on_signal(signal, samples, interval, scalars[surface])
                           : place_on_line(samples, interval, scalars[surface]);
      const bool shares_normal = method == SurfaceMethod::nearest_normal && i > 0;
      hits.push_back({t, surface, interval, shares_normal ? hits[first].t : t});
    }
  }
  return hits;
}

template std::vector<SampledHit> sampled_hits(SurfaceMethod, const Chain<3>&, const Samples<double>&,
                                              const std::vector<double>&, double);
template std::vector<SampledHit> sampled_hits(SurfaceMethod, const Chain<largest_degree>&, const Samples<double>&,
                                              const std::vector<double>&, double);

}  // namespace raytruth

#include "raytruth/rules/twins.hpp"

#include "raytruth/core/random.hpp"
#include "raytruth/core/real50.hpp"
#include "raytruth/rules/rules.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

namespace raytruth {

namespace {

constexpr float smallest_normal = std::numeric_limits<float>::min();
constexpr float denormal = smallest_normal / 1024;
constexpr float huge = 1e30F;
constexpr float epsilon = std::numeric_limits<float>::epsilon();

/// Reads arguments off a row of numbers.
template <class Real>
class Reader {
 public:
  explicit Reader(std::span<const float> numbers) : numbers_(numbers) {}

  template <class Argument>
  Argument read() {
    if constexpr (std::is_same_v<Argument, bool>) {
      return next() != 0;
    } else if constexpr (std::is_same_v<Argument, Real>) {
      return Real(next());
    } else {
      const Real x(next());
      const Real y(next());
      const Real z(next());
      return {x, y, z, Real(next())};
    }
  }

 private:
  double next() { return numbers_[next_++]; }

  std::span<const float> numbers_;
  std::size_t next_ = 0;
};

template <class Real, class Result, class... Arguments>
TwinValues<Real> call(Result (Rules<Real>::*function)(Arguments...), std::span<const float> numbers) {
  Reader<Real> reader(numbers);
  const std::tuple<Rules<Real>, Arguments...> arguments{Rules<Real>{}, reader.template read<Arguments>()...};
  const Result result = std::apply(
      [function](auto rules, const Arguments&... argument) { return (rules.*function)(argument...); }, arguments);
  if constexpr (std::is_same_v<Result, Real>)
    return {result};
  else
    return {result[0], result[1], result[2], result[3]};
}

template <class Real, class Result, class... Arguments>
constexpr std::size_t count_results(Result (Rules<Real>::*)(Arguments...)) {
  return std::is_same_v<Result, Real> ? 1 : 4;
}

/// A row of the table; `member(Rules<Real>)` gives the function's pointer in an arithmetic.
template <class Member>
Twin twin(std::string_view name, Member member, const std::vector<Domain>& arguments, Twin::Bounds bounds) {
  const auto in = [member]<class Real>(Real) {
    return [function = member(Rules<Real>{})](std::span<const float> numbers) { return call(function, numbers); };
  };
  return {.name = name,
          .arguments = arguments,
          .bounds = bounds,
          .result_count = count_results(member(Rules<double>{})),
          .in_binary32 = in(Binary32()),
          .in_binary64 = in(double()),
          .in_50_digits = in(Real50()),
          .summand = [](std::span<const float>, std::size_t) { return 0.0; },
          .reconcile = [](std::span<float>) {}};
}

/// A sum of multiples of the signal's values, which may cancel.
template <class Member>
Twin sum_twin(std::string_view name, Member member, const std::vector<Domain>& arguments, Twin::Bounds bounds) {
  Twin result = twin(name, member, arguments, bounds);
  result.summand = [arguments](std::span<const float> numbers, std::size_t) {
    double largest = 0;
    std::size_t next = 0;
    for (const Domain domain : arguments)
      for (std::size_t i = 0; i < number_count(domain); ++i, ++next)
        if (domain == Domain::signal || domain == Domain::signals)
          largest = std::max(largest, std::abs(static_cast<double>(numbers[next])));
    return largest;
  };
  return result;
}

/// A slab whose opacity, a number near 1 where it is thick, is taken off the light from its `sample_count` samples;
/// their optics come first, then the width.
template <class Member>
Twin sampled_slab_twin(std::string_view name, Member member, std::size_t sample_count, Twin::Bounds bounds) {
  std::vector<Domain> arguments(sample_count, Domain::optics);
  arguments.insert(arguments.end(), {Domain::width, Domain::is_linear});
  Twin result = twin(name, member, arguments, bounds);
  result.summand = [sample_count](std::span<const float> numbers, std::size_t component) {
    if (component == 3) return 0.0;
    const double slab_width = numbers[4 * sample_count];
    double light = 0;
    double depth = 0;
    for (std::size_t i = 0; i < sample_count; ++i) {
      light = std::max(light, slab_width * static_cast<double>(numbers[4 * i + component]));
      depth = std::max(depth, slab_width * static_cast<double>(numbers[4 * i + 3]));
    }
    return sample_count == 2 ? light : light * std::max(1.0, depth);
  };
  return result;
}

/// A difference from a number.
Twin difference_twin(Twin twin, double number) {
  twin.summand = [number](std::span<const float>, std::size_t) { return number; };
  return twin;
}

/// A weight or a coefficient that belongs to normals. The last argument is the cosine of their angle 2a; as the angle
/// approaches 180 degrees, terms grow like 1 / cos a: `scale` times that.
template <class Scale>
Twin with_normals(Twin twin, Scale&& scale) {
  twin.summand = [scale](std::span<const float> numbers, std::size_t) {
    return scale(numbers) / std::sqrt((1 + static_cast<double>(numbers.back())) / 2);
  };
  return twin;
}

/// The larger of the projections of the two normals, which come first.
double larger_projection(std::span<const float> numbers) {
  return std::max(std::abs(numbers[0]), std::abs(numbers[1]));
}

/// A cubic's coefficient has up to eight times a normal's projection, 4 skew (back - front).
double largest_multiple(std::span<const float> numbers) { return 8 * larger_projection(numbers); }

/// A cubic curve between normals.
template <class Member>
Twin arc_twin(std::string_view name, Member member, Twin::Bounds bounds) {
  return with_normals(twin(name, member, {Domain::projection, Domain::projection, Domain::cosine}, bounds),
                      largest_multiple);
}

/// A function of slab, opacity and ratio: the opacity is the corrected one of the slab.
Twin corrected_slab_twin(Twin twin) {
  twin.reconcile = [](std::span<float> numbers) {
    const Binary32 corrected = Rules<Binary32>{}.opacity_correction(Binary32(numbers[3]), Binary32(numbers[5]));
    numbers[4] = static_cast<float>(to_double(corrected));
  };
  return twin;
}

/// A function of coordinate and size: half a texel is taken off; tables have two entries or more.
Twin table_share_twin(Twin twin) {
  twin.summand = [](std::span<const float> numbers, std::size_t) {
    return 0.5 / (static_cast<double>(numbers[1]) - 1);
  };
  twin.reconcile = [](std::span<float> numbers) { numbers[1] = std::max(numbers[1], 2.0F); };
  return twin;
}

/// Light of a slab: its moments come first, `moment_count` numbers, then what they are multiplied by.
Twin lighting_twin(Twin twin, std::size_t moment_count) {
  twin.summand = [moment_count](std::span<const float> numbers, std::size_t) {
    const auto largest = [](std::span<const float> terms) {
      double result = 0;
      for (const float term : terms) result = std::max(result, std::abs(static_cast<double>(term)));
      return result;
    };
    return largest(numbers.first(moment_count)) * largest(numbers.subspan(moment_count));
  };
  return twin;
}

/// The largest magnitude of the cubic's coefficients, which are the arguments.
double largest_of(std::span<const float> cubic) {
  double largest = 0;
  for (const float b : cubic) largest = std::max(largest, std::abs(static_cast<double>(b)));
  return largest;
}

/// How far a unit in the last place of the cubic's coefficients, which are the arguments, moves a place where a
/// multiple of them is zero whose slope is `slope`, in such units; without bound where that slope vanishes.
double place_summand(std::span<const float> cubic, double slope) {
  constexpr double unbounded = 1e30;
  const double largest = largest_of(cubic);
  return largest < unbounded * std::abs(slope) && largest > 1 / unbounded ? largest / std::abs(slope) : unbounded;
}

/// The first differences of the cubic's coefficients, which are the arguments.
std::array<double, 3> slopes_of(std::span<const float> cubic) {
  const auto difference = [cubic](std::size_t i) {
    return static_cast<double>(cubic[i + 1]) - static_cast<double>(cubic[i]);
  };
  return {difference(0), difference(1), difference(2)};
}

/// Denormal numbers, which shaders may take for 0, have another class than it has.
void drop_denormals(std::span<float> numbers) {
  for (float& number : numbers)
    if (std::abs(number) < smallest_normal) number = 0;
}

/// Two places between the samples, and scalars on either side of 0.
void make_bracket(std::span<float> numbers) {
  constexpr float least = 0x1p-100F;  // times a last place of 1 still a normal number
  for (float& place : numbers.first(2)) place = std::min(std::abs(place), 1.0F);
  std::sort(numbers.begin(), numbers.begin() + 2);
  const bool is_rising = numbers[2] < numbers[3];
  for (float& scalar : numbers.subspan(2)) scalar = std::max(std::abs(scalar), least);
  numbers[is_rising ? 2 : 3] *= -1;
}

/// Unit vectors in all directions, or 0, as three numbers and a 0.
void make_normal(std::span<float> numbers) {
  double square = 0;
  for (float& number : numbers.first(3)) {
    number = std::clamp(2 * number - 1, -1.0F, 1.0F);
    square += static_cast<double>(number) * static_cast<double>(number);
  }
  numbers[3] = 0;
  if (square == 0) return;
  for (float& number : numbers.first(3)) number = static_cast<float>(number / std::sqrt(square));
}

std::vector<Twin> make_twins() {
  using enum Domain;
  constexpr Twin::Bounds exact{.gl = 0, .rounding = 0};
  constexpr Twin::Bounds product{.gl = 1, .rounding = 1};
  constexpr Twin::Bounds sum{.gl = 4, .rounding = 8};
  constexpr Twin::Bounds absorbing{.gl = 8, .rounding = 8};
  constexpr Twin::Bounds circular{.gl = 8, .rounding = 8};
  const std::vector three(3, signal);
  const std::vector four(4, signal);
  const std::vector three_split{signal, signal, signal, split};
  Twin inflection_twin = twin(
      "cubic_split_inflection", [](auto r) { return &decltype(r)::cubic_split_inflection; }, {signals}, sum);
  inflection_twin.summand = [](std::span<const float> cubic, std::size_t) {
    const auto [front, middle, back] = slopes_of(cubic);
    return place_summand(cubic, (middle - front) - (back - middle));
  };
  // Two extrema that are about to meet, and one that is about to leave for infinity, are where rounding puts them.
  Twin extrema_twin = twin(
      "cubic_split_extrema", [](auto r) { return &decltype(r)::cubic_split_extrema; }, {signals}, sum);
  extrema_twin.summand = [](std::span<const float> cubic, std::size_t) {
    constexpr double noise = 16 * epsilon;
    const auto [front, middle, back] = slopes_of(cubic);
    const double largest = std::max({std::abs(front), std::abs(middle), std::abs(back)});
    const double discriminant = std::abs(middle * middle - front * back);
    const double bend = (back - middle) - (middle - front);
    const bool is_noise = discriminant <= noise * largest * largest_of(cubic);
    return place_summand(cubic, is_noise ? 0 : std::min(std::sqrt(discriminant), std::abs(bend)));
  };
  Twin normal_curve_twin = twin(
      "normal_curve", [](auto r) { return &decltype(r)::normal_curve; }, {projection, projection, unit, unit}, sum);
  normal_curve_twin.summand = [](std::span<const float> numbers, std::size_t) { return largest_multiple(numbers); };
  Twin fades_cone_twin = twin(
      "fades_cone", [](auto r) { return &decltype(r)::fades_cone; }, {signals, shininess}, sum);
  fades_cone_twin.summand = [](std::span<const float> numbers, std::size_t) {
    return std::max(1.0, std::abs(static_cast<double>(numbers[0]))) * static_cast<double>(numbers[4]);  // of n (c - 1)
  };
  // A hump of a cubic, its ends well below: what is larger by rounding alone is anybody's guess.
  Twin fades_peak_twin = twin(
      "fades_peak", [](auto r) { return &decltype(r)::fades_peak; }, {signals, projection, projection}, sum);
  fades_peak_twin.summand = [](std::span<const float>, std::size_t) { return 4.0; };
  fades_peak_twin.reconcile = [](std::span<float> numbers) {
    for (float& number : numbers) number = std::min(std::abs(number), 1.0F);
    const float hump = 2 + 2 * numbers[1];
    const float skew = numbers[3] / 2 - 0.25F;
    const float front = -numbers[0] / 2;
    const std::array<float, 6> arguments{front, hump, -hump, skew, front, front + skew};
    std::copy(arguments.begin(), arguments.end(), numbers.begin());
  };
  Twin fades_highlight_twin = lighting_twin(twin(
                                                "fades_highlight", [](auto r) { return &decltype(r)::fades_highlight; },
                                                {signals, unit, signals, projection, projection}, sum),
                                            5);
  fades_highlight_twin.reconcile = [hump = fades_peak_twin.reconcile](std::span<float> numbers) {
    hump(numbers.subspan(5));
  };
  // Signs are 1 or -1, and what is passed exists.
  const auto to_sign = [](float& number) { number = number < 0 ? -1.0F : 1.0F; };
  Twin quadratic_curvature_twin = twin(
      "quadratic_gray_curvature", [](auto r) { return &decltype(r)::quadratic_gray_curvature; }, three_split, sum);
  quadratic_curvature_twin.summand = [](std::span<const float> numbers, std::size_t) {
    const auto length = static_cast<double>(numbers[3]);
    return 4 * std::max({std::abs(numbers[0]), std::abs(numbers[1]), std::abs(numbers[2])}) / (length * length);
  };
  Twin quadratic_slope_twin = twin(
      "quadratic_gray_slope", [](auto r) { return &decltype(r)::quadratic_gray_slope; },
      {signal, signal, projection, split}, sum);
  quadratic_slope_twin.summand = [](std::span<const float> numbers, std::size_t) {
    return std::max({std::abs(numbers[0]), std::abs(numbers[1])}) / static_cast<double>(numbers[3]) + 1;
  };
  Twin quadratic_place_twin =
      difference_twin(twin(
                          "quadratic_gray_place", [](auto r) { return &decltype(r)::quadratic_gray_place; },
                          {unit, projection, projection, projection}, sum),
                      1);
  quadratic_place_twin.reconcile = [to_sign](std::span<float> numbers) {
    to_sign(numbers[2]);
    to_sign(numbers[3]);
    numbers[0] *= numbers[2];
  };
  Twin quadratic_node_twin =
      difference_twin(twin(
                          "quadratic_gray_node", [](auto r) { return &decltype(r)::quadratic_gray_node; },
                          {projection, unit, unit, size}, sum),
                      16);
  quadratic_node_twin.reconcile = [](std::span<float> numbers) {
    numbers[1] = std::max(numbers[1], 0x1p-6F);
    numbers[2] = numbers[1] * (2 + 62 * std::abs(numbers[2]));
    numbers[0] *= 2 * numbers[2];
    numbers[3] = std::clamp(numbers[3], 1.0F, 16.0F);
  };
  Twin isosurface_class_twin = twin(
      "isosurface_class", [](auto r) { return &decltype(r)::isosurface_class; }, {signal, signal}, exact);
  isosurface_class_twin.reconcile = drop_denormals;
  Twin isosurface_crossing_twin = twin(
      "isosurface_crossing", [](auto r) { return &decltype(r)::isosurface_crossing; }, three, sum);
  isosurface_crossing_twin.reconcile = drop_denormals;
  Twin isosurface_regula_falsi_twin = difference_twin(
      twin(
          "isosurface_regula_falsi", [](auto r) { return &decltype(r)::isosurface_regula_falsi; }, {signals}, sum),
      1);
  isosurface_regula_falsi_twin.reconcile = make_bracket;
  Twin isosurface_bracket_twin = twin(
      "isosurface_bracket", [](auto r) { return &decltype(r)::isosurface_bracket; }, {signals, unit, projection},
      exact);
  isosurface_bracket_twin.reconcile = [](std::span<float> numbers) {
    make_bracket(numbers.first(4));
    drop_denormals(numbers);
  };
  // Normals that cancel each other leave a direction that rounding made.
  Twin isosurface_normal_twin = twin(
      "isosurface_normal", [](auto r) { return &decltype(r)::isosurface_normal; }, {signals, signals, unit}, sum);
  isosurface_normal_twin.summand = [](std::span<const float> numbers, std::size_t) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto front = static_cast<double>(numbers[i]);
      const double between = front + static_cast<double>(numbers[8]) * (static_cast<double>(numbers[4 + i]) - front);
      square += between * between;
    }
    return 1 / std::max(std::sqrt(square), 1e-30);
  };
  isosurface_normal_twin.reconcile = [](std::span<float> numbers) {
    make_normal(numbers.first(4));
    make_normal(numbers.subspan(4, 4));
  };
  return {
      sum_twin(
          "order0", [](auto r) { return &decltype(r)::order0; }, {signal}, exact),
      sum_twin(
          "order1", [](auto r) { return &decltype(r)::order1; }, {signal, signal}, sum),
      sum_twin(
          "order2_curvature", [](auto r) { return &decltype(r)::order2_curvature; }, three_split, sum),
      sum_twin(
          "order2_interval", [](auto r) { return &decltype(r)::order2_interval; }, {signal, signal, unit, signal}, sum),
      sum_twin(
          "order2_front", [](auto r) { return &decltype(r)::order2_front; }, three_split, sum),
      sum_twin(
          "order2_back", [](auto r) { return &decltype(r)::order2_back; }, three_split, sum),
      sum_twin(
          "order3_slope_first", [](auto r) { return &decltype(r)::order3_slope_first; }, four, sum),
      sum_twin(
          "order3_slope_second", [](auto r) { return &decltype(r)::order3_slope_second; }, four, sum),
      sum_twin(
          "order3_front", [](auto r) { return &decltype(r)::order3_front; }, four, sum),
      sum_twin(
          "order3_middle", [](auto r) { return &decltype(r)::order3_middle; }, four, sum),
      sum_twin(
          "order3_back", [](auto r) { return &decltype(r)::order3_back; }, four, sum),
      quadratic_curvature_twin,
      difference_twin(sum_twin(
                          "quadratic_gray_middle", [](auto r) { return &decltype(r)::quadratic_gray_middle; },
                          {unit, unit, projection, unit}, sum),
                      1),
      quadratic_slope_twin,
      difference_twin(twin(
                          "quadratic_gray_value", [](auto r) { return &decltype(r)::quadratic_gray_value; },
                          {unit, projection, projection, unit}, sum),
                      1),
      difference_twin(twin(
                          "quadratic_gray_extremum", [](auto r) { return &decltype(r)::quadratic_gray_extremum; },
                          {unit, projection, projection}, sum),
                      1),
      quadratic_place_twin,
      quadratic_node_twin,
      sum_twin(
          "virtual_catmull_rom", [](auto r) { return &decltype(r)::virtual_catmull_rom; }, four, sum),
      sum_twin(
          "virtual_catmull_rom_ghost", [](auto r) { return &decltype(r)::virtual_catmull_rom_ghost; }, three, sum),
      sum_twin(
          "virtual_sample", [](auto r) { return &decltype(r)::virtual_sample; }, {signals, unit}, sum),
      sum_twin(
          "virtual_texel", [](auto r) { return &decltype(r)::virtual_texel; },
          {signals, signals, signals, signals, unit}, sum),
      sum_twin(
          "cubic_split_cubic", [](auto r) { return &decltype(r)::cubic_split_cubic; }, four, sum),
      sum_twin(
          "cubic_split_value", [](auto r) { return &decltype(r)::cubic_split_value; }, {signals, unit}, sum),
      sum_twin(
          "cubic_split_parabola", [](auto r) { return &decltype(r)::cubic_split_parabola; }, three, sum),
      sum_twin(
          "cubic_split_part", [](auto r) { return &decltype(r)::cubic_split_part; }, {signals, unit, unit}, sum),
      inflection_twin,
      extrema_twin,
      sum_twin(
          "cubic_split_mean_error", [](auto r) { return &decltype(r)::cubic_split_mean_error; }, {signals}, sum),
      twin(
          "absorption", [](auto r) { return &decltype(r)::absorption; }, {depth, is_linear}, absorbing),
      twin(
          "absorption_mean_transmittance", [](auto r) { return &decltype(r)::absorption_mean_transmittance; },
          {depth, is_linear}, absorbing),
      twin(
          "over", [](auto r) { return &decltype(r)::over; }, {slab, slab}, sum),
      twin(
          "homogeneous_slab", [](auto r) { return &decltype(r)::homogeneous_slab; }, {optics, width, is_linear},
          absorbing),
      sampled_slab_twin(
          "trapezoid_slab", [](auto r) { return &decltype(r)::trapezoid_slab; }, 2, absorbing),
      sampled_slab_twin(
          "simpson_slab", [](auto r) { return &decltype(r)::simpson_slab; }, 3, absorbing),
      twin(
          "opacity_correction", [](auto r) { return &decltype(r)::opacity_correction; }, {opacity, ratio}, absorbing),
      difference_twin(
          twin(
              "opacity_correction_half", [](auto r) { return &decltype(r)::opacity_correction_half; }, {opacity}, sum),
          1),
      twin(
          "opacity_correction_linear", [](auto r) { return &decltype(r)::opacity_correction_linear; }, {opacity, ratio},
          product),
      corrected_slab_twin(twin(
          "opacity_corrected_slab", [](auto r) { return &decltype(r)::opacity_corrected_slab; }, {slab, opacity, ratio},
          sum)),
      difference_twin(
          twin(
              "texel_position", [](auto r) { return &decltype(r)::texel_position; }, {coordinate, size}, product),
          0.5),
      twin(
          "filter_weight", [](auto r) { return &decltype(r)::filter_weight; }, {position, levels}, exact),
      twin(
          "texel_clamped_to_edge", [](auto r) { return &decltype(r)::texel_clamped_to_edge; }, {texel, size}, exact),
      sum_twin(
          "filter_linear", [](auto r) { return &decltype(r)::filter_linear; }, {signals, signals, unit}, sum),
      twin(
          "table_coordinate", [](auto r) { return &decltype(r)::table_coordinate; }, {unit, size}, sum),
      table_share_twin(twin(
          "table_share", [](auto r) { return &decltype(r)::table_share; }, {coordinate, size}, sum)),
      sum_twin(
          "table_bilinear", [](auto r) { return &decltype(r)::table_bilinear; },
          {signals, signals, signals, signals, unit, unit}, sum),
      twin(
          "normal_curve_cosine", [](auto r) { return &decltype(r)::normal_curve_cosine; }, {cosine}, sum),
      twin(
          "normal_curve_rise", [](auto r) { return &decltype(r)::normal_curve_rise; }, {cosine}, sum),
      normal_curve_twin,
      sum_twin(
          "normal_curve_value", [](auto r) { return &decltype(r)::normal_curve_value; }, {signals, unit}, sum),
      with_normals(twin(
                       "mean_gradient", [](auto r) { return &decltype(r)::mean_gradient; },
                       {projection, projection, cosine}, sum),
                   larger_projection),
      sum_twin(
          "linear_gradient", [](auto r) { return &decltype(r)::linear_gradient; }, {signal, signal}, sum),
      arc_twin(
          "quadratic_arc", [](auto r) { return &decltype(r)::quadratic_arc; }, sum),
      arc_twin(
          "quadratic_arc_printed", [](auto r) { return &decltype(r)::quadratic_arc_printed; }, sum),
      arc_twin(
          "circle_arc", [](auto r) { return &decltype(r)::circle_arc; }, circular),
      arc_twin(
          "circle_arc_tuned", [](auto r) { return &decltype(r)::circle_arc_tuned; }, sum),
      arc_twin(
          "minimax_arc", [](auto r) { return &decltype(r)::minimax_arc; }, sum),
      arc_twin(
          "minimax_circle_arc", [](auto r) { return &decltype(r)::minimax_circle_arc; }, sum),
      twin(
          "normalized_linear", [](auto r) { return &decltype(r)::normalized_linear; }, {unit, cosine}, sum),
      with_normals(twin(
                       "slerp", [](auto r) { return &decltype(r)::slerp; }, {unit, cosine}, circular),
                   [](std::span<const float>) { return 1.0; }),
      difference_twin(
          twin(
              "highlight_lobe", [](auto r) { return &decltype(r)::highlight_lobe; }, {projection, shininess}, sum),
          1),
      difference_twin(twin(
                          "highlight_family", [](auto r) { return &decltype(r)::highlight_family; },
                          {projection, shininess, degree}, sum),
                      1),
      twin(
          "lighting_clamped", [](auto r) { return &decltype(r)::lighting_clamped; }, {projection}, exact),
      twin(
          "lighting_mirrored", [](auto r) { return &decltype(r)::lighting_mirrored; }, {projection}, exact),
      lighting_twin(
          twin(
              "lighting_integral", [](auto r) { return &decltype(r)::lighting_integral; }, {signals, signals}, sum),
          4),
      lighting_twin(twin(
                        "lighting_interpolated", [](auto r) { return &decltype(r)::lighting_interpolated; },
                        {signals, projection, projection}, sum),
                    4),
      fades_cone_twin,
      lighting_twin(twin(
                        "fades_integral", [](auto r) { return &decltype(r)::fades_integral; },
                        {signals, signals, projection, projection}, sum),
                    4),
      lighting_twin(twin(
                        "fades_diffuse_printed", [](auto r) { return &decltype(r)::fades_diffuse_printed; },
                        {signals, signals, projection, projection}, sum),
                    4),
      fades_peak_twin,
      fades_highlight_twin,
      lighting_twin(twin(
                        "fades_highlight_printed", [](auto r) { return &decltype(r)::fades_highlight_printed; },
                        {signals, signals, signals, projection, projection, shininess, projection, projection}, sum),
                    8),
      lighting_twin(twin(
                        "gooch_constant", [](auto r) { return &decltype(r)::gooch_constant; },
                        {signals, signals, unit, unit, unit, unit}, sum),
                    8),
      lighting_twin(twin(
                        "gooch_linear", [](auto r) { return &decltype(r)::gooch_linear; },
                        {signals, signals, signals, unit, unit, unit, unit}, sum),
                    8),
      isosurface_class_twin,
      isosurface_crossing_twin,
      isosurface_regula_falsi_twin,
      isosurface_bracket_twin,
      twin(
          "isosurface_slab", [](auto r) { return &decltype(r)::isosurface_slab; }, {slab}, product),
      isosurface_normal_twin,
  };
}

/// Uniform random numbers of one input, one after the other.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t index) : seed_(seed), index_(index) {}

  double uniform() {
    if (next_ == 4) {
      numbers_ = random_numbers(seed_, RandomStream::points, index_, repetition_++);
      next_ = 0;
    }
    return numbers_[next_++];
  }

  float uniform(double low, double high) { return static_cast<float>(low + (high - low) * uniform()); }
  float logarithmic(double low, double high) { return static_cast<float>(low * std::pow(high / low, uniform())); }
  float power_of_two(int low, int high) {
    return std::ldexp(1.0F, low + static_cast<int>(uniform() * (high - low + 1)));
  }
  float integer(int low, int high) { return std::floor(uniform(low, high + 1)); }

  template <std::size_t Count>
  float one_of(const std::array<float, Count>& values) {
    return values[static_cast<std::size_t>(uniform() * Count)];
  }

 private:
  std::uint64_t seed_;
  std::uint64_t index_;
  std::uint32_t repetition_ = 0;
  std::array<double, 4> numbers_{};
  std::size_t next_ = 4;
};

float random_number(Domain domain, std::size_t component, Draw& draw) {
  switch (domain) {
    case Domain::signal:
    case Domain::signals:
    case Domain::unit:
    case Domain::coordinate:
      return draw.uniform(0, 1);
    case Domain::optics:
      return component < 3 ? draw.uniform(0, 1) : draw.logarithmic(1e-6, 1e2);
    case Domain::slab:
      return draw.uniform(0, 1);
    case Domain::width:
      return draw.logarithmic(1e-6, 1e1);
    case Domain::depth:
      return draw.logarithmic(1e-12, 1e3);
    case Domain::opacity:
      return draw.uniform() < 0.5 ? draw.logarithmic(1e-12, 1) : 1 - draw.logarithmic(epsilon, 1);
    case Domain::ratio:
      return draw.logarithmic(1.0 / 256, 1);
    case Domain::split:
      return draw.uniform(1.0 / 64, 1 - 1.0 / 64);
    case Domain::is_linear:
      return draw.uniform() < 0.5 ? 0.0F : 1.0F;
    case Domain::position:
      return draw.uniform(-0.5, 2047.5);
    case Domain::texel:
      return draw.integer(-1, 2048);
    case Domain::size:
      return draw.integer(1, 2048);
    case Domain::levels:
      return draw.uniform() < 0.125 ? 0.0F : draw.power_of_two(6, 16);
    case Domain::projection:
      return draw.uniform(-1, 1);
    case Domain::cosine:
      return draw.uniform(-0.99, 1);
    case Domain::shininess:
      return draw.logarithmic(1, 100);
    case Domain::degree:
      return draw.integer(1, 3);
  }
  return 0;
}

float adversarial_number(Domain domain, std::size_t component, Draw& draw) {
  switch (domain) {
    case Domain::signal:
    case Domain::signals:
      return draw.one_of(std::array{0.0F, -0.0F, 1.0F, -1.0F, denormal, smallest_normal, epsilon, 1 - epsilon / 2,
                                    255.0F, huge, -huge});
    case Domain::optics:
      return component < 3 ? draw.one_of(std::array{0.0F, denormal, smallest_normal, 1.0F, 1e6F})
                           : draw.one_of(std::array{0.0F, denormal, smallest_normal, 1e-12F, 1e-6F, 1.0F, 88.0F, 1e3F});
    case Domain::width:
      return draw.one_of(std::array{0.0F, 1e-30F, 1e-12F, 1e-6F, 1.0F, 1.0F + epsilon});
    case Domain::depth:
      return draw.one_of(std::array{0.0F, denormal, smallest_normal, 2 * smallest_normal, 1e-12F, epsilon, 0.34657F,
                                    0.34658F, 1.0F, 16.6F, 17.4F, 87.0F, 88.8F, 104.0F, 1e3F, huge});
    case Domain::slab:
    case Domain::opacity:
    case Domain::coordinate:
    case Domain::unit:
      return draw.one_of(std::array{0.0F, denormal, smallest_normal, 1e-12F, epsilon, 0.29289F, 0.2929F, 0.5F,
                                    1 - epsilon, 1 - epsilon / 2, 1.0F});
    case Domain::ratio:
      return draw.power_of_two(-8, 0);
    case Domain::split:
      return draw.one_of(std::array{1.0F / 64, 0.5F - epsilon, 0.5F, 0.5F + epsilon, 1 - 1.0F / 64});
    case Domain::position:
      return draw.integer(0, 2047) + draw.one_of(std::array{-0.5F, -epsilon, 0.0F, epsilon, 0.5F});
    case Domain::projection:
      return draw.one_of(std::array{0.0F, -0.0F, denormal, smallest_normal, epsilon, 0.5F, 1 - epsilon / 2, 1.0F,
                                    -epsilon, -0.5F, -1.0F});
    case Domain::cosine:
      return draw.one_of(std::array{1.0F, 1 - epsilon / 2, 1 - epsilon, 0.5F, 0.5F + epsilon, denormal, 0.0F, -epsilon,
                                    -0.5F, -0.5F - epsilon, -1 + 1.0F / 128});
    case Domain::shininess:
      return draw.one_of(std::array{1.0F, 1 + epsilon, 2.0F, 10.0F, 50.5F, 128.0F, 1e4F});
    case Domain::is_linear:
    case Domain::texel:
    case Domain::size:
    case Domain::levels:
    case Domain::degree:
      return random_number(domain, component, draw);
  }
  return 0;
}

}  // namespace

std::span<const DomainInfo> domains() {
  using enum Domain;
  static constexpr std::array<DomainInfo, 20> list{{
      {signal, "signal", "real", "scalar", "0 to 1"},
      {signals, "signals", "vec4", "scalar", "0 to 1"},
      {optics, "optics", "vec4", "1/length", "emission density 0 to 1, extinction 1e-6 to 1e2"},
      {slab, "slab", "vec4", "", "colour and opacity 0 to 1"},
      {width, "width", "real", "length", "1e-6 to 10"},
      {depth, "depth", "real", "", "1e-12 to 1e3"},
      {opacity, "opacity", "real", "", "1e-12 to 1 - 2^-23"},
      {ratio, "ratio", "real", "", "1/256 to 1"},
      {unit, "unit", "real", "", "0 to 1"},
      {split, "split", "real", "", "1/64 to 63/64"},
      {is_linear, "is_linear", "bool", "", "both"},
      {coordinate, "coordinate", "real", "", "0 to 1"},
      {position, "position", "real", "texel", "-1/2 to 2047 1/2"},
      {texel, "texel", "real", "texel", "-1 to 2048"},
      {size, "size", "real", "texel", "1 to 2048"},
      {levels, "levels", "real", "", "0, and 2^6 to 2^16"},
      {projection, "projection", "real", "", "-1 to 1"},
      {cosine, "cosine", "real", "", "-0.99 to 1"},
      {shininess, "shininess", "real", "", "1 to 100"},
      {degree, "degree", "real", "", "1 to 3"},
  }};
  return list;
}

const DomainInfo& info(Domain domain) {
  return *std::find_if(domains().begin(), domains().end(),
                       [domain](const DomainInfo& entry) { return entry.domain == domain; });
}

std::size_t number_count(Domain domain) { return info(domain).type == "vec4" ? 4 : 1; }

std::size_t Twin::number_count() const {
  std::size_t count = 0;
  for (const Domain argument : arguments) count += raytruth::number_count(argument);
  return count;
}

void draw_arguments(const Twin& twin, TwinInputs inputs, std::uint64_t seed, std::uint64_t index,
                    std::span<float> numbers) {
  Draw draw(seed, index);
  const bool is_random = inputs == TwinInputs::random;
  const bool are_nearly_equal = !is_random && index % 2 == 1;
  const float base = draw.uniform(0.5, 1);
  std::size_t next = 0;
  for (const Domain argument : twin.arguments)
    for (std::size_t component = 0; component < number_count(argument); ++component) {
      float& number = numbers[next++];
      if (are_nearly_equal && (argument == Domain::signal || argument == Domain::signals))
        number = base + epsilon * draw.integer(-2, 2);
      else
        number = is_random || are_nearly_equal ? random_number(argument, component, draw)
                                               : adversarial_number(argument, component, draw);
    }
  twin.reconcile(numbers);
}

namespace catalogue {

const std::vector<Twin>& twins() {
  static const std::vector<Twin> list = make_twins();
  return list;
}

}  // namespace catalogue

}  // namespace raytruth

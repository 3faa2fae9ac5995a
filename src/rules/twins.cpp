#include "rules/twins.hpp"

#include "core/random.hpp"
#include "rules/rules.hpp"

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

/// Of arguments slab, opacity, ratio: the opacity is the corrected one of the slab.
Twin corrected_slab_twin(Twin twin) {
  twin.reconcile = [](std::span<float> numbers) {
    const Binary32 corrected = Rules<Binary32>{}.opacity_correction(Binary32(numbers[3]), Binary32(numbers[5]));
    numbers[4] = static_cast<float>(to_double(corrected));
  };
  return twin;
}

std::vector<Twin> make_twins() {
  using enum Domain;
  constexpr Twin::Bounds exact{.gl = 0, .rounding = 0};
  constexpr Twin::Bounds product{.gl = 1, .rounding = 1};
  constexpr Twin::Bounds sum{.gl = 4, .rounding = 8};
  constexpr Twin::Bounds absorbing{.gl = 8, .rounding = 8};
  const std::vector three(3, signal);
  const std::vector four(4, signal);
  const std::vector three_split{signal, signal, signal, split};
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
      sum_twin(
          "virtual_catmull_rom", [](auto r) { return &decltype(r)::virtual_catmull_rom; }, four, sum),
      sum_twin(
          "virtual_catmull_rom_ghost", [](auto r) { return &decltype(r)::virtual_catmull_rom_ghost; }, three, sum),
      sum_twin(
          "virtual_sample", [](auto r) { return &decltype(r)::virtual_sample; }, {signals, unit}, sum),
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
    case Domain::is_linear:
    case Domain::texel:
    case Domain::size:
    case Domain::levels:
      return random_number(domain, component, draw);
  }
  return 0;
}

}  // namespace

std::span<const DomainInfo> domains() {
  using enum Domain;
  static constexpr std::array<DomainInfo, 16> list{{
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

#include "raytruth/documents/table_case.hpp"

#include "raytruth/catalogue.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/partial_pre_integration.hpp"
#include "raytruth/tables/table_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;
using Vec4 = Rules<double>::vec4;

constexpr std::int64_t largest_size = 4096;
constexpr std::int64_t most_iterations = 65536;
constexpr std::size_t cells_judged = 32;  ///< along each axis
constexpr std::uint64_t places_judged = 4096;
constexpr std::uint64_t weighted_places_judged = 256;  // each is proven by itself, in milliseconds
constexpr std::uint64_t seed = 1;                      ///< of the places

constexpr std::string_view by_iterations = "second_order_iterations";
constexpr std::string_view by_nyquist = "second_order_nyquist";
constexpr std::string_view exactly = "second_order_exact";
constexpr std::string_view partially = "partial_pre_integration";

void read_slabs(const JsonReader& json, TableCase& asked, std::vector<std::string>& warnings) {
  asked.transfer = read_transfer_function(json.at("transfer_function"), warnings);
  if (const auto emission = json.find("emission"); emission && emission->word({"associated", "plain"}) == "plain")
    asked.emission = Emission::plain;
  json.at("transfer_function").blame_for([&] { return RayIntegral(*asked.transfer, asked.emission); });
  asked.axes.length = json.at("length").positive_number();
  const auto ends = json.at("range").items(2);
  if (ends.size() != 2) json.at("range").refuse(fmt::format("{} items", ends.size()), "a pair of numbers");
  asked.axes.low = ends[0].number();
  asked.axes.high = ends[1].number();
  json.at("range").blame_for([&] {
    check(asked.axes);
    return 0;
  });
  // Whatever the builder: its error is measured against exact slabs.
  json.at("length").blame_for([&] {
    check_depth(*asked.transfer, asked.axes);
    return 0;
  });
}

Json place_json(const std::array<double, 2>& scalars) { return {{"front", scalars[0]}, {"back", scalars[1]}}; }

/// Errors at random places, collected one by one.
class ErrorsAtPlaces {
 public:
  void add(const Vec4& found, const Vec4& truth, double radius) {
    const Vec4 error = (found - truth).abs();
    largest_ = std::max(largest_, error.maxCoeff());
    sum_ += error.mean();
    sum_of_squares_ += error.square().mean();
    radius_ = std::max(radius_, radius);
    ++count_;
  }
  [[nodiscard]] Json json(std::string_view look_up) const {
    const auto count = static_cast<double>(count_);
    return {{"look_up", look_up}, {"max", largest_},
            {"l1", sum_ / count}, {"l2", std::sqrt(sum_of_squares_ / count)},
            {"places", count_},   {"error_bound", radius_}};
  }

 private:
  double largest_ = 0;
  double sum_ = 0;
  double sum_of_squares_ = 0;
  double radius_ = 0;
  std::uint64_t count_ = 0;
};

template <std::size_t Count>
std::array<double, Count> random_scalars(const TableAxes& axes, std::uint64_t place) {
  const auto random = random_numbers(seed, RandomStream::points, place);
  std::array<double, Count> scalars{};
  for (std::size_t axis = 0; axis < Count; ++axis) scalars[axis] = axes.low + random[axis] * (axes.high - axes.low);
  return scalars;
}

Vec4 in_format(const TableFormat& format, const Vec4& entry) {
  return entry.unaryExpr([&](double value) { return stored(format, value); });
}

Json second_order_error(const TableCase& asked, const Table3<float>& table) {
  SecondOrderSlabs slabs(*asked.transfer, asked.axes, asked.emission);
  ErrorsAtPlaces errors;
  for (std::uint64_t i = 0; i < places_judged; ++i) {
    const auto scalars = random_scalars<3>(asked.axes, i);
    const Certified truth = slabs.certified(scalars);
    const Vec4 found = trilinear<double>(
        asked.axes,
        [&](std::size_t front, std::size_t middle, std::size_t back) -> Vec4 {
          return in_format(asked.format, table.at(front, middle, back).cast<double>());
        },
        scalars);
    errors.add(found, {truth.color[0], truth.color[1], truth.color[2], truth.opacity}, truth.radius);
  }
  return errors.json("trilinear");
}

/// A slab's weighted light in RGB and its opacity, by ball arithmetic: as the diffuse light of a surface whose cosine
/// is the weight. The tent is 1 - |2 x - 1|, light without shading less that of a surface lit from both sides.
CertifiedRadiance weighted_light(const ShadedSlab& slab, const PiecewiseLinear& transfer, Emission emission,
                                 LightWeight weight) {
  Cubic cosine{1, 0, 0, 0};
  if (weight == LightWeight::to_front) cosine = {1, -1, 0, 0};
  if (weight == LightWeight::x) cosine = {0, 1, 0, 0};
  if (weight == LightWeight::x_squared) cosine = {0, 0, 1, 0};
  if (weight == LightWeight::x_cubed) cosine = {0, 0, 0, 1};
  if (weight == LightWeight::tent) cosine = {-1, 2, 0, 0};
  const Lighting lighting{
      .ambient = 1, .diffuse = 1, .negative = weight == LightWeight::tent ? Negative::mirror : Negative::none};
  CertifiedRadiance light = cubic_reference(slab, transfer, emission, lighting, cosine, {1, 0, 0, 0});
  if (weight == LightWeight::tent) {
    light.diffuse = light.ambient - light.diffuse;
    light.radius *= 2;
  }
  return light;
}

Json weighted_error(const TableCase& asked, const Table<double>& table, const TableContent& content) {
  std::vector<TransferPoint> points = asked.transfer->points();
  for (TransferPoint& point : points) point.optics.color = {1, 1, 1};
  const PiecewiseLinear white(std::move(points));
  ErrorsAtPlaces errors;
  for (std::uint64_t i = 0; i < weighted_places_judged; ++i) {
    const auto scalars = random_scalars<2>(asked.axes, i);
    const ShadedSlab slab{.front = scalars[0], .back = scalars[1], .length = asked.axes.length};
    const auto light = weighted_light(slab, content.is_white ? white : *asked.transfer, asked.emission, content.weight);
    Vec4 truth(light.diffuse[0], light.diffuse[1], light.diffuse[2], light.opacity);
    double radius = light.radius;
    if (content.has_white_as_alpha) {
      const auto of_white = weighted_light(slab, white, asked.emission, content.weight);
      truth[3] = of_white.diffuse[0];
      radius = std::max(radius, of_white.radius);
    }
    const Vec4 found = bilinear<double>(
        asked.axes,
        [&](std::size_t front, std::size_t back) -> Vec4 { return in_format(asked.format, table.at(front, back)); },
        scalars);
    errors.add(found, truth, radius);
  }
  return errors.json("bilinear");
}

Json linear_error(const TableCase& asked, const Table<double>& table) {
  const CertifiedCells truth = certified_cells(*asked.transfer, asked.axes, asked.emission, cells_judged, seed);
  const TableError error = bilinear_error(
      truth, [&](const CertifiedCell& /*cell*/, std::size_t front, std::size_t back) { return table.at(front, back); },
      asked.format);
  return {{"look_up", "bilinear"},
          {"max", error.max},
          {"max_at", place_json({error.front, error.back})},
          {"l1", error.mean},
          {"l2", error.root_mean_square},
          {"diagonal_band_max", error.band_max},
          {"places", truth.cells.size() * places_per_axis * places_per_axis},
          {"error_bound", truth.radius}};
}

MadeTable linear_table(const TableCase& asked, const TableBuilder& builder) {
  Table<double> table = builder.make(*asked.transfer, asked.axes, asked.emission);
  const std::size_t n = asked.axes.size;
  return {
      .shape = {n, n, 4},
      .values = table.values,
      .axes = {"back scalar", "front scalar", "red, green, blue, opacity"},
      .error = builder.content.is_slab() ? linear_error(asked, table) : weighted_error(asked, table, builder.content)};
}

MadeTable parabolic_table(const TableCase& asked, const SecondOrderMethod& method) {
  const Table3<float> table = second_order_table(*asked.transfer, asked.axes, asked.emission, method);
  const std::size_t n = asked.axes.size;
  return {.shape = {n, n, n, 4},
          .values = {table.values.begin(), table.values.end()},
          .axes = {"back scalar", "middle scalar", "front scalar", "red, green, blue, opacity"},
          .error = second_order_error(asked, table)};
}

MadeTable psi_table(const TableCase& asked) {
  const PsiTable table(asked.axes.size);
  double largest = 0;
  for (std::uint64_t i = 0; i < places_judged; ++i) {
    const auto random = random_numbers(seed, RandomStream::points, i);
    const double front = random[0] / (1 - random[0]);
    const double back = random[1] / (1 - random[1]);
    largest =
        std::max(largest, std::abs(table(front, back, PsiLookUp::bilinear) - partial_pre_integration_psi(front, back)));
  }
  return {.shape = {table.size(), table.size()},
          .values = table.values(),
          .axes = {"gamma = D / (D + 1) of the back extinction's optical depth D", "the same of the front one"},
          .error = {{"look_up", "bilinear, numbers not rounded"}, {"max", largest}, {"places", places_judged}}};
}

}  // namespace

TableCase read_table_case(const JsonReader& json, std::vector<std::string>& warnings) {
  std::vector<std::string_view> names{by_iterations, by_nyquist, exactly, partially};
  for (const TableBuilder& builder : catalogue::table_builders()) names.push_back(builder.name);
  const std::string name = json.at("builder").word(names);
  TableCase asked{
      .builder = PartialPreIntegration{}, .transfer = {}, .axes = {}, .format = table_formats[1], .json = json};

  const bool is_second_order = name == by_iterations || name == by_nyquist || name == exactly;
  if (name == partially)
    json.only({"builder", "size", "format"});
  else if (name == by_iterations)
    json.only({"transfer_function", "emission", "builder", "iterations", "size", "length", "range", "format"});
  else
    json.only({"transfer_function", "emission", "builder", "size", "length", "range", "format"});
  const auto largest = is_second_order ? static_cast<std::int64_t>(largest_table3_size) : largest_size;
  asked.axes.size = static_cast<std::size_t>(json.at("size").integer(2, largest));
  if (name == by_iterations)
    asked.builder = SecondOrderMethod{
        Iterations{.count = static_cast<int>(json.at("iterations").integer(1, most_iterations)), .is_left = false}};
  if (name == by_nyquist) asked.builder = SecondOrderMethod{NyquistIterations{}};
  if (name == exactly) asked.builder = SecondOrderMethod{Ideal{}};
  for (const TableBuilder& builder : catalogue::table_builders())
    if (builder.name == name) asked.builder = &builder;
  if (name != partially) read_slabs(json, asked, warnings);
  if (const auto format = json.find("format")) {
    std::vector<std::string_view> formats;
    for (const TableFormat& known : table_formats) formats.push_back(known.name);
    const std::string chosen = format->word(formats);
    asked.format = *std::find_if(table_formats.begin(), table_formats.end(),
                                 [&chosen](const TableFormat& known) { return known.name == chosen; });
  }
  return asked;
}

MadeTable make_table(const TableCase& asked) {
  if (const auto* const builder = std::get_if<const TableBuilder*>(&asked.builder))
    return linear_table(asked, **builder);
  if (const auto* const method = std::get_if<SecondOrderMethod>(&asked.builder)) return parabolic_table(asked, *method);
  return psi_table(asked);
}

}  // namespace raytruth

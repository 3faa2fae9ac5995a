#include "raytruth/documents/table_case.hpp"

#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/core/random.hpp"
#include "raytruth/documents/case_json.hpp"
#include "raytruth/documents/radius_axis_json.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/tables/exact.hpp"
#include "raytruth/tables/look_up_error.hpp"
#include "raytruth/tables/partial_pre_integration.hpp"
#include "raytruth/tables/table_file.hpp"
#include "raytruth/tables/table_for_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t largest_size = 4096;
constexpr std::int64_t most_iterations = 65536;
constexpr std::string_view certified_quadratic_gray = "quadratic_gray";
constexpr std::uint64_t psi_places_judged = 4096;
constexpr std::uint64_t seed = 1;  ///< of the places

void read_slabs(const JsonReader& json, TableCase& asked, std::vector<std::string>& warnings) {
  TransferDocument read = read_transfer_function(json.at("transfer_function"), {}, warnings);
  asked.transfer = std::move(read.transfer);
  if (read.is_of_another_program) asked.transfer_description = std::move(read.description);
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

bool is_highlight(GradientTable which) { return which != GradientTable::diffuse && which != GradientTable::diffuse_z; }

/// "light", "gradient", "exponent" and "v" of a quadratic table; none: its colours.
std::optional<QuadraticGrayAsked::Lit> read_gradient_light(const JsonReader& json, bool is_corrected_model) {
  const auto light = json.find("light");
  if (!light || light->text() == "ambient") {
    for (const char* const key : {"gradient", "exponent", "v"})
      if (const auto found = json.find(key))
        found->refuse(fmt::format("a {} without light by the gradient", key), "one with the light diffuse or specular");
    return {};
  }
  std::vector<std::string_view> words{"ambient"};
  words.insert(words.end(), gradient_table_names.begin(), gradient_table_names.end());
  const std::string word = light->word(words);
  if (!is_corrected_model)
    light->refuse("the light " + word + " with quadratic_gray_printed",
                  "quadratic_gray, whose \"gradient\" is printed or corrected");
  QuadraticGrayAsked::Lit lit;
  lit.which = static_cast<GradientTable>(std::find(gradient_table_names.begin(), gradient_table_names.end(), word) -
                                         gradient_table_names.begin());
  if (const auto gradient = json.find("gradient"))
    lit.is_corrected = gradient->word({"corrected", "printed"}) == "corrected";
  if (!is_highlight(lit.which)) {
    for (const char* const key : {"exponent", "v"})
      if (const auto found = json.find(key))
        found->refuse(fmt::format("a {} of diffuse light", key), "one with a specular light");
    return lit;
  }
  lit.exponent = json.at("exponent").positive_number();
  const JsonReader v = json.at("v");
  v.only({"low", "high", "count"});
  const double low = v.at("low").number();
  const double high = v.at("high").number();
  const auto count = static_cast<std::size_t>(v.at("count").integer(2, 256));
  const bool is_ratio = lit.which != GradientTable::specular;
  if (!(low < high) || (is_ratio && (low < 0 || high > 1)))
    v.refuse(fmt::format("{} to {}", low, high), is_ratio ? "ascending ends from 0 to 1" : "ascending ends");
  lit.v.clear();
  for (std::size_t i = 0; i < count; ++i)
    lit.v.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(count - 1));
  return lit;
}

Json error_json(const LookUpError& error) {
  Json json{{"look_up", error.look_up}, {"max", error.max}};
  if (error.max_at) json["max_at"] = {{"front", (*error.max_at)[0]}, {"back", (*error.max_at)[1]}};
  json["l1"] = error.mean;
  json["l2"] = error.root_mean_square;
  if (error.band_max) json["diagonal_band_max"] = *error.band_max;
  json["places"] = error.places;
  json["error_bound"] = error.radius;
  json["rounding_max"] = error.rounding;
  return json;
}

}  // namespace

MadeTable judged(const TableCase& asked, const TableBuilder& builder, const Table<double>& table) {
  const std::size_t n = asked.axes.size;
  const bool is_slab = builder.content.is_slab();
  Json error = error_json(
      is_slab ? linear_look_up_error(table, *asked.transfer, asked.emission, asked.format)
              : weighted_look_up_error(table, builder.content, *asked.transfer, asked.emission, asked.format));
  if (!is_slab && asked.transfer->is_linear_in_opacity()) error["truth"] = sampled_opacity;
  return {.shape = {n, n, 4},
          .values = table.values,
          .axes = {"back scalar", "front scalar", "red, green, blue, opacity"},
          .error = std::move(error)};
}

MadeTable judged(const TableCase& asked, const Table3<float>& table) {
  const std::size_t n = asked.axes.size;
  return {.shape = {n, n, n, 4},
          .values = {table.values.begin(), table.values.end()},
          .axes = {"back scalar", "middle scalar", "front scalar", "red, green, blue, opacity"},
          .error =
              error_json(second_order_look_up_error(table, *asked.transfer, asked.axes, asked.emission, asked.format))};
}

namespace {

/// A table for every v, one behind the other.
MadeTable gradient_tables(const TableCase& asked, const QuadraticGrayAsked& quadratic) {
  const auto& lit = *quadratic.lit;
  MadeTable made;
  const std::size_t n = asked.axes.size;
  for (const double v : lit.v) {
    const auto table = asked.json.at("light").blame_for([&] {
      return gradient_lit_table(*asked.transfer, asked.axes, quadratic.radius, lit.which, lit.exponent, v,
                                lit.is_corrected);
    });
    made.values.insert(made.values.end(), table.values.begin(), table.values.end());
  }
  made.radius = radius_axis_json(quadratic.radius);
  made.shape = {quadratic.radius.node_count(), n, n, 4};
  const Json of_entry{"curvature, in gray values per squared length", "back scalar", "front scalar",
                      "red, green, blue of the light, opacity"};
  made.axes = of_entry;
  if (is_highlight(lit.which)) {
    made.shape.insert(made.shape.begin(), lit.v.size());
    made.axes = Json::array({lit.which == GradientTable::specular ? "v" : "ratio"});
    made.axes.insert(made.axes.end(), of_entry.begin(), of_entry.end());
    made.radius["v"] = lit.v;
  }
  double rounding = 0;
  for (const double value : made.values)
    rounding = std::max(rounding, std::abs(read_back(asked.format, value) - value));
  made.error = {{"entries", {{"error", "that of rounding, about 1e-13 of the largest: not proven"}}},
                {"rounding_max", rounding}};
  return made;
}

/// The model's exact table has certified entries, proven ones; that of the print is what it is.
MadeTable quadratic_table(const TableCase& asked, const QuadraticGrayAsked& quadratic) {
  if (quadratic.lit) return gradient_tables(asked, quadratic);
  const bool is_certified = quadratic.builder->name == certified_quadratic_gray;
  QuadraticGrayTable<double> table;
  Json nodes;
  if (is_certified) {
    CertifiedQuadraticGray certified = asked.json.at("size").blame_for(
        [&] { return certified_quadratic_gray_table(*asked.transfer, asked.axes, quadratic.radius, asked.emission); });
    table = std::move(certified.table);
    nodes = {{"error_bound", certified.radius}};
  } else {
    table = asked.json.at("size").blame_for([&] {
      return in_binary64(quadratic.builder->make(*asked.transfer, asked.axes, quadratic.radius, asked.emission));
    });
    nodes = {{"error_bound", nullptr}, {"why", "sums over gray values as printed"}};
  }
  Json error =
      error_json(quadratic_gray_look_up_error(table, *asked.transfer, asked.axes, asked.emission, asked.format));
  error["entries"] = nodes;
  error["of_places"] = "random scalars at both ends, curvatures spread evenly over the nodes of their axis";
  const std::size_t n = asked.axes.size;
  Json axes{"curvature, in gray values per squared length", "back scalar", "front scalar", "red, green, blue, opacity"};
  MadeTable made{.shape = {table.radius.node_count(), n, n, 4},
                 .values = std::move(table.values),
                 .axes = std::move(axes),
                 .error = std::move(error)};
  made.radius = radius_axis_json(quadratic.radius);
  made.last_scalar = table.axes.high;
  return made;
}

MadeTable psi_table(const TableCase& asked) {
  const PsiTable table(asked.axes.size);
  std::vector<double> in_file = table.values();
  double rounding = 0;
  for (double& value : in_file) {
    const double computed = value;
    value = read_back(asked.format, computed);
    rounding = std::max(rounding, std::abs(value - computed));
  }
  const PsiTable stored(asked.axes.size, std::move(in_file));
  double largest = 0;
  for (std::uint64_t i = 0; i < psi_places_judged; ++i) {
    const auto random = random_numbers(seed, RandomStream::points, i);
    const double front = random[0] / (1 - random[0]);
    const double back = random[1] / (1 - random[1]);
    largest = std::max(largest,
                       std::abs(stored(front, back, PsiLookUp::bilinear) - partial_pre_integration_psi(front, back)));
  }
  return {
      .shape = {table.size(), table.size()},
      .values = table.values(),
      .axes = {"gamma = D / (D + 1) of the back extinction's optical depth D", "the same of the front one"},
      .error = {{"look_up", "bilinear"}, {"max", largest}, {"places", psi_places_judged}, {"rounding_max", rounding}}};
}

}  // namespace

TableCase read_table_case(const JsonReader& json, std::vector<std::string>& warnings) {
  check_form(json, "table/1");
  std::vector<std::string_view> names = names_of(catalogue::second_order_builders);
  names.push_back(catalogue::psi_builder.name);
  for (const std::string_view name : names_of(catalogue::quadratic_gray_builders())) names.push_back(name);
  for (const std::string_view name : names_of(catalogue::table_builders())) names.push_back(name);
  const std::string name = json.at("builder").word(names);
  TableCase asked{
      .builder = PartialPreIntegration{}, .transfer = {}, .axes = {}, .format = table_formats[1], .json = json};

  const SecondOrderBuilder* const second_order = find_named(catalogue::second_order_builders, name);
  const QuadraticGrayBuilder* const quadratic = find_named(catalogue::quadratic_gray_builders(), name);
  const bool is_psi = name == catalogue::psi_builder.name;
  if (is_psi)
    json.only({"raytruth", "builder", "size", "format"});
  else if (quadratic != nullptr)
    json.only({"raytruth", "transfer_function", "emission", "builder", "size", "length", "range", "radius", "format",
               "light", "gradient", "exponent", "v"});
  else if (second_order != nullptr && second_order->takes_iterations)
    json.only(
        {"raytruth", "transfer_function", "emission", "builder", "iterations", "size", "length", "range", "format"});
  else
    json.only({"raytruth", "transfer_function", "emission", "builder", "size", "length", "range", "format"});
  std::int64_t largest = largest_size;
  if (second_order != nullptr) largest = static_cast<std::int64_t>(largest_table3_size);
  if (quadratic != nullptr) largest = static_cast<std::int64_t>(largest_quadratic_size);
  asked.axes.size = static_cast<std::size_t>(json.at("size").integer(2, largest));
  if (second_order != nullptr) {
    asked.builder = second_order->method(
        second_order->takes_iterations ? static_cast<int>(json.at("iterations").integer(1, most_iterations)) : 0);
  } else if (quadratic != nullptr) {
    QuadraticGrayAsked of_model{.builder = quadratic, .radius = quadratic->radius};
    if (const auto radius = json.find("radius")) of_model.radius = read_radius_axis(*radius, quadratic->radius);
    of_model.lit = read_gradient_light(json, name == certified_quadratic_gray);
    asked.builder = of_model;
  } else if (!is_psi) {
    asked.builder = find_named(catalogue::table_builders(), name);
  }
  if (!is_psi) read_slabs(json, asked, warnings);
  if (const auto* const of_model = std::get_if<QuadraticGrayAsked>(&asked.builder)) {
    const bool needs_extinction = of_model->lit || of_model->builder->name != certified_quadratic_gray;
    if (needs_extinction && asked.transfer->is_linear_in_opacity())
      json.at("transfer_function")
          .refuse("opacities that are linear between points",
                  "one whose points state the extinction, or the colours of quadratic_gray,");
  }
  if (const auto format = json.find("format")) {
    asked.format = *find_named(table_formats, format->word(names_of(table_formats)));
  }
  return asked;
}

MadeTable make_table(const TableCase& asked) {
  if (const auto* const builder = std::get_if<const TableBuilder*>(&asked.builder)) {
    MadeTable table = judged(asked, **builder,
                             table_for_format(**builder, *asked.transfer, asked.axes, asked.emission, asked.format));
    if (is_made_in_binary32(**builder, *asked.transfer, asked.format))
      table.error["arithmetic"] =
          "entries made in binary32, within 1e-5 of the builder's in binary64; \"float64\" has those";
    return table;
  }
  if (const auto* const method = std::get_if<SecondOrderMethod>(&asked.builder))
    return judged(asked, second_order_table(*asked.transfer, asked.axes, asked.emission, *method));
  if (const auto* const quadratic = std::get_if<QuadraticGrayAsked>(&asked.builder))
    return quadratic_table(asked, *quadratic);
  return psi_table(asked);
}

nlohmann::ordered_json table_description(const TableCase& asked, const MadeTable& table, const std::string& name) {
  nlohmann::ordered_json text{
      {"raytruth", "table/1"},
      {"table", name},
      {"shape", table.shape},
      {"axes", table.axes},
      {"format", std::string(asked.format.name)},
      {"entries",
       "entry i of n stands for low + (high - low) i / (n - 1); as a texture it has its centre at "
       "(i + 1/2) / n"}};
  if (!table.radius.is_null()) text["radius"] = table.radius;
  if (table.last_scalar && *table.last_scalar != asked.axes.high) text["high"] = *table.last_scalar;
  if (asked.transfer) text["colors"] = "opacity-weighted: composite with C += T C_slab, T *= 1 - opacity";
  if (!asked.transfer_description.is_null()) text["transfer_function"] = asked.transfer_description;
  text["error"] = table.error;
  text["case"] = asked.json.json();
  return text;
}

std::int64_t clamped_numbers(const TableCase& asked, const MadeTable& table) {
  const TexelType type = asked.format.type;
  if (!asked.format.is_texel || type == TexelType::float32 || type == TexelType::float16) return 0;
  return std::count_if(table.values.begin(), table.values.end(), [](double value) { return value > 1; });
}

}  // namespace raytruth

#include "raytruth/documents/read_transfer_function.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace raytruth {

namespace {

Vector3<double> read_color(const JsonReader& json) {
  const auto channels = json.numbers(3);
  if (channels.size() != 3) json.refuse_value("a list of 3 numbers");
  return {channels[0], channels[1], channels[2]};
}

/// Calls `make`; where a point is refused, its place in the document is named.
template <class Make>
PiecewiseLinear with_place_of_point(const JsonReader& json, Make&& make) {
  const auto points = json.at("points").items();
  try {
    return make(points);
  } catch (const PointError& error) {
    points[error.index].blame_for([&error]() -> PiecewiseLinear { throw InputError(error.what()); });
    throw;
  }
}

PiecewiseLinear read_opacity_points(const JsonReader& json) {
  const double unit_length = json.at("unit_length").positive_number();
  return with_place_of_point(json, [&](const std::vector<JsonReader>& items) {
    std::vector<OpacityPoint> points;
    for (const JsonReader& item : items) {
      item.only({"s", "opacity", "color"});
      points.push_back({item.at("s").number(), item.at("opacity").number(0, 1), read_color(item.at("color"))});
    }
    return from_opacity(points, unit_length);
  });
}

PiecewiseLinear read_extinction_points(const JsonReader& json) {
  return with_place_of_point(json, [](const std::vector<JsonReader>& items) {
    std::vector<TransferPoint> points;
    for (const JsonReader& item : items) {
      item.only({"s", "extinction", "color"});
      points.push_back({item.at("s").number(), {item.at("extinction").number(0), read_color(item.at("color"))}});
    }
    return PiecewiseLinear(std::move(points));
  });
}

PiecewiseLinear read_points(const JsonReader& json) {
  json.only({"points", "unit_length"});
  return json.find("unit_length") ? read_opacity_points(json) : read_extinction_points(json);
}

}  // namespace

PiecewiseLinear read_transfer_function(const JsonReader& json, std::vector<std::string>& /*warnings*/) {
  if (!json.is_string()) return read_points(json);
  return json.blame_for([&] { return read_points(JsonReader::from_file(json.resolve(json.text()).string())); });
}

}  // namespace raytruth

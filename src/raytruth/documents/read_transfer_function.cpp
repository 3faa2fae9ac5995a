#include "raytruth/documents/read_transfer_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace raytruth {

namespace {

Vector3<double> read_color(const JsonReader& json) {
  const auto channels = json.numbers(3);
  if (channels.size() != 3) json.refuse_value("a list of 3 numbers");
  return {channels[0], channels[1], channels[2]};
}

/// Calls `make` for the items of a list; where one is refused, its place in the document is named.
template <class Make>
auto with_place_of_item(const JsonReader& json, Make&& make) {
  const auto items = json.items();
  try {
    return make(items);
  } catch (const PointError& error) {
    items[error.index].blame_for([&error] { throw InputError(error.what()); });
    throw;
  }
}

PiecewiseLinear read_opacity_points(const JsonReader& json) {
  const double unit_length = json.at("unit_length").positive_number();
  return with_place_of_item(json.at("points"), [&](const std::vector<JsonReader>& items) {
    std::vector<OpacityPoint> points;
    for (const JsonReader& item : items) {
      item.only({"s", "opacity", "color"});
      points.push_back({item.at("s").number(), item.at("opacity").number(0, 1), read_color(item.at("color"))});
    }
    return from_opacity(points, unit_length);
  });
}

PiecewiseLinear read_extinction_points(const JsonReader& json) {
  return with_place_of_item(json.at("points"), [](const std::vector<JsonReader>& items) {
    std::vector<TransferPoint> points;
    for (const JsonReader& item : items) {
      item.only({"s", "extinction", "color"});
      points.push_back({item.at("s").number(), {item.at("extinction").number(0), read_color(item.at("color"))}});
    }
    return PiecewiseLinear(std::move(points));
  });
}

std::vector<Isosurface> read_isosurfaces(const JsonReader& json) {
  return with_place_of_item(json, [](const std::vector<JsonReader>& items) {
    std::vector<Isosurface> isosurfaces;
    for (const JsonReader& item : items) {
      item.only({"s", "opacity", "color"});
      isosurfaces.push_back({item.at("s").number(), item.at("opacity").number(0, 1), read_color(item.at("color"))});
    }
    check(isosurfaces);
    return isosurfaces;
  });
}

PiecewiseLinear read_points(const JsonReader& json) {
  // Without points there is nothing but the isosurfaces.
  if (!json.find("points") && json.find("isosurfaces")) {
    json.only({"isosurfaces"});
    return PiecewiseLinear(std::vector<TransferPoint>(1));
  }
  json.only({"points", "unit_length", "isosurfaces"});
  return json.find("unit_length") ? read_opacity_points(json) : read_extinction_points(json);
}

/// A transfer function of this program.
TransferDocument read_document(const JsonReader& json, const TransferContext& context) {
  TransferDocument result{.transfer = read_points(json), .description = {}};
  result.description = {{"points", result.transfer.points().size()}, {"color", "linear light"}};
  if (result.transfer.is_linear_in_opacity()) result.description["opacity"] = "linear between points";
  if (const auto isosurfaces = json.find("isosurfaces")) {
    if (!context.takes_isosurfaces)
      isosurfaces->refuse("isosurfaces here", "them in rays for `eval` and in scenes alone");
    result.isosurfaces = read_isosurfaces(*isosurfaces);
    result.description["isosurfaces"] = result.isosurfaces.size();
  }
  return result;
}

TransferFileRequest read_request(const JsonReader& json, const TransferContext& context) {
  TransferFileRequest request{.ignores_gradient_opacity = context.ignores_gradient_opacity};
  if (json.is_string()) {
    request.file = json.resolve(json.text());
  } else {
    json.only(
        {"file", "preset", "opacity", "opacity_preset", "range", "scalars", "unit_length", "ignore_gradient_opacity"});
    request.file = json.resolve(json.at("file").text());
    if (const auto preset = json.find("preset")) request.preset = preset->text();
    if (const auto opacity = json.find("opacity")) request.opacity = json.resolve(opacity->text());
    if (const auto preset = json.find("opacity_preset")) request.opacity_preset = preset->text();
    if (const auto unit_length = json.find("unit_length")) request.unit_length = unit_length->positive_number();
    if (const auto scalars = json.find("scalars"))
      request.scalars =
          scalars->word({"as_stated", "stretched"}) == "stretched" ? ScalarChoice::stretched : ScalarChoice::as_stated;
    if (const auto ignore = json.find("ignore_gradient_opacity"); ignore && ignore->boolean())
      request.ignores_gradient_opacity = true;
    if (const auto range = json.find("range")) {
      const auto ends = range->numbers(2);
      if (ends.size() != 2 || !(ends[0] < ends[1])) range->refuse_value("a pair of ascending numbers");
      request.range = {{ends[0], ends[1]}};
    }
  }
  if (context.opacity) request.opacity = *context.opacity;
  return request;
}

}  // namespace

bool is_of_another_program(const JsonReader& json) {
  if (json.is_object()) return json.find("file").has_value() && !json.find("points");
  return json.is_string() && json.blame_for([&] { return is_transfer_file(json.resolve(json.text())); });
}

TransferDocument read_transfer_function(const JsonReader& json, const TransferContext& context,
                                        std::vector<std::string>& warnings) {
  if (is_of_another_program(json)) {
    const TransferFileRequest request = read_request(json, context);
    FileTransfer read = json.blame_for([&] { return read_transfer_file(request, context.volume, warnings); });
    return {std::move(read.transfer), std::move(read.description), true};
  }
  if (context.opacity)
    json.refuse("points with an opacity of their own", "another program's file together with --opacity");
  if (!json.is_string()) return read_document(json, context);
  return json.blame_for(
      [&] { return read_document(JsonReader::from_file(json.resolve(json.text()).string()), context); });
}

nlohmann::ordered_json transfer_function_json(const PiecewiseLinear& transfer,
                                              const std::vector<Isosurface>& isosurfaces) {
  using Json = nlohmann::ordered_json;
  Json points = Json::array();
  for (std::size_t i = 0; i < transfer.points().size(); ++i) {
    const auto& [s, optics] = transfer.points()[i];
    Json point{{"s", s}};
    if (transfer.is_linear_in_opacity())
      point["opacity"] = transfer.opacities()[i];
    else
      point["extinction"] = optics.extinction;
    point["color"] = {optics.color[0], optics.color[1], optics.color[2]};
    points.push_back(std::move(point));
  }
  Json document{{"points", std::move(points)}};
  if (transfer.is_linear_in_opacity()) document["unit_length"] = transfer.unit_length();
  for (const Isosurface& surface : isosurfaces)
    document["isosurfaces"].push_back({{"s", surface.s},
                                       {"opacity", surface.opacity},
                                       {"color", {surface.color[0], surface.color[1], surface.color[2]}}});
  return document;
}

}  // namespace raytruth

#include "raytruth/documents/transfer_files/file_map.hpp"

namespace raytruth {

namespace {

/// The maps of a list, of groups in it, or a single one.
void collect_maps(const JsonReader& json, std::vector<JsonReader>& maps) {
  if (json.is_array()) {
    for (const JsonReader& item : json.items(0)) collect_maps(item, maps);
  } else if (json.is_object()) {
    if (const auto children = json.find("Children"))
      collect_maps(*children, maps);
    else
      maps.push_back(json);
  } else {
    json.refuse_value("a colour map or a list of them");
  }
}

ColorSpace space_of(const JsonReader& json) {
  const std::string name = json.word({"RGB", "HSV", "Lab", "CIELAB", "Diverging", "Step"});
  if (name == "RGB") return ColorSpace::rgb;
  if (name == "HSV") return ColorSpace::hsv;
  if (name == "Diverging") return ColorSpace::diverging;
  return name == "Step" ? ColorSpace::step : ColorSpace::lab;
}

/// ParaView's own opacity lists have a midpoint and a sharpness for each point.
void add_vtk_points(ColorMap& map, const JsonReader& json) {
  for (const auto& [s, opacity, midpoint, sharpness] : groups_of<4>(json.place(), json.numbers())) {
    if (midpoint != 0.5 || sharpness != 0) json.refuse("a curve between points", "midpoint 0.5 and sharpness 0");
    map.opacities.push_back({s, opacity});
  }
}

}  // namespace

FileMap read_vtk_preset(const TransferFileRequest& request) {
  std::vector<JsonReader> maps;
  collect_maps(JsonReader::from_file(request.file.string()), maps);
  const auto name_of = [](const JsonReader& map) {
    const auto name = map.find("Name");
    return name ? name->text() : std::string();
  };
  const JsonReader& json = chosen(maps, request, name_of);
  FileMap result{.format = "ParaView colour map", .name = name_of(json)};
  if (const auto space = json.find("ColorSpace")) result.map.space = space_of(*space);
  if (const auto colors = json.find("RGBPoints"))
    add_colors(result.map, colors->place(), colors->numbers());
  else if (const auto categories = json.find("IndexedColors"))
    categories->refuse("a map of categories", "a map with RGBPoints");
  if (const auto opacities = json.find("OpacityPoints")) {
    result.format = "VolView or ParaView Glance preset";
    add_opacities(result.map, opacities->place(), opacities->numbers());
  } else if (const auto points = json.find("Points")) {
    add_vtk_points(result.map, *points);
  }
  const auto absolute = json.find("AbsoluteRange");
  if (!(absolute && absolute->boolean()) && result.map.opacities.empty() && !result.map.colors.empty())
    result.own_range = {result.map.colors.front().s, result.map.colors.back().s};
  return result;
}

}  // namespace raytruth

#include "raytruth/documents/transfer_files/xml_numbers.hpp"

namespace raytruth {

namespace {

constexpr std::string_view paraview_format = "ParaView colour map";

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

/// true and false, or 1 and 0.
bool is_set(const JsonReader& map, std::string_view name) {
  const auto value = map.find(name);
  if (!value) return false;
  return value->is_boolean() ? value->boolean() : value->number() != 0;
}

/// vtk.js lets hues take the shorter way unless told otherwise; ParaView does not.
ColorSpace space_of(std::string_view name, bool wraps_hue) {
  if (name == "HSV") return wraps_hue ? ColorSpace::hsv_wrapped : ColorSpace::hsv;
  if (name == "Diverging") return ColorSpace::diverging;
  if (name == "Step") return ColorSpace::step;
  return name == "RGB" ? ColorSpace::rgb : ColorSpace::lab;
}

/// Groups of scalar, opacity, midpoint and sharpness.
void add_vtk_points(ColorMap& map, const JsonReader& json) {
  for (const auto& [s, opacity, midpoint, sharpness] : groups_of<4>(json.place(), json.numbers())) {
    for (const double share : {midpoint, sharpness})
      if (!(share >= 0 && share <= 1))
        json.refuse(fmt::format("midpoint {} and sharpness {}", midpoint, sharpness), "each from 0 to 1");
    map.opacities.push_back({s, opacity, midpoint, sharpness});
  }
}

FileMap read_json_map(const JsonReader& json) {
  FileMap result{.format = std::string(paraview_format), .scalars = FileScalars::relative};
  const auto opacities = json.find("OpacityPoints");
  if (const auto space = json.find("ColorSpace"))
    result.map.space = space_of(space->word({"RGB", "HSV", "Lab", "CIELAB", "Diverging", "Step"}),
                                json.find("HSVWrap") ? is_set(json, "HSVWrap") : opacities.has_value());
  if (const auto colors = json.find("RGBPoints"))
    add_colors(result.map, colors->place(), colors->numbers());
  else if (const auto categories = json.find("IndexedColors"))
    categories->refuse("a map of categories", "a map with RGBPoints");
  result.map.is_logarithmic = is_set(json, "UseLogScale");
  if (opacities) {
    result.format = "VolView or ParaView Glance preset";
    result.scalars = result.map.colors.empty() ? FileScalars::unstated : FileScalars::absolute;
    add_opacities(result.map, opacities->place(), opacities->numbers());
  } else if (const auto points = json.find("Points")) {
    result.scalars = FileScalars::unstated;
    add_vtk_points(result.map, *points);
  }
  if (json.find("AbsoluteRange"))
    result.scalars = is_set(json, "AbsoluteRange") ? FileScalars::absolute : FileScalars::relative;
  for (const char* const name : {"NanColor", "Annotations", "EffectiveRange", "IndexedColors", "NumberOfTableValues",
                                 "Discretize", "UseBelowRangeColor", "UseAboveRangeColor"})
    if (json.find(name) && !(name == std::string_view("IndexedColors") && result.map.colors.empty()))
      result.ignored.emplace_back(name);
  return result;
}

FileMap read_xml_map(const XmlFile& file, const pugi::xml_node& node) {
  FileMap result{.format = std::string(paraview_format) + " (XML)", .scalars = FileScalars::relative};
  const std::string space = node.attribute("space").as_string("RGB");
  // "Wrapped" is how these files say that the hue takes the shorter way.
  constexpr std::array<std::string_view, 7> spaces{"RGB", "HSV", "Wrapped", "Lab", "CIELAB", "Diverging", "Step"};
  if (std::find(spaces.begin(), spaces.end(), space) == spaces.end())
    refuse(place_of(file, node) + "/@space", shortened(space), "RGB, HSV, Wrapped, Lab, CIELAB, Diverging or Step");
  if (std::string_view(node.attribute("indexedLookup").value()) == "true")
    refuse(place_of(file, node) + "/@indexedLookup", "a map of categories", "a map of points");
  result.map.space = space == "Wrapped" ? ColorSpace::hsv_wrapped : space_of(space, false);
  bool has_opacity = false;
  for (const pugi::xml_node& point : node.children("Point")) {
    const double s = attribute(file, point, "x");
    result.map.colors.push_back(
        {s, {attribute(file, point, "r"), attribute(file, point, "g"), attribute(file, point, "b")}});
    if (!point.attribute("o")) continue;
    const double opacity = attribute(file, point, "o");
    result.map.opacities.push_back({s, opacity});
    has_opacity = has_opacity || opacity != 1;
  }
  // Colour maps that are all opaque are colour maps: the format has no way to leave opacity out.
  if (!has_opacity) result.map.opacities.clear();
  if (has_opacity) result.scalars = FileScalars::unstated;
  if (node.child("NaN")) result.ignored.emplace_back("NaN");
  return result;
}

}  // namespace

std::vector<NamedMap> read_vtk_json(const JsonReader& document) {
  std::vector<JsonReader> found;
  collect_maps(document, found);
  std::vector<NamedMap> maps;
  for (const JsonReader& json : found) {
    const auto name = json.find("Name");
    const std::string word = name ? name->text() : std::string();
    maps.push_back({word, [json, word] {
                      FileMap map = read_json_map(json);
                      map.name = word;
                      return map;
                    }});
  }
  return maps;
}

std::vector<NamedMap> read_vtk_xml(const std::filesystem::path& file) {
  return maps_of(read_xml(file), "ColorMap", read_xml_map);
}

}  // namespace raytruth

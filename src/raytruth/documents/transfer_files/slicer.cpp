#include "raytruth/documents/transfer_files/xml_numbers.hpp"

#include <initializer_list>
#include <sstream>

namespace raytruth {

namespace {

constexpr std::string_view format_name = "3D Slicer volume property";

/// A list that states the count of its numbers first.
std::vector<double> counted_numbers(const std::string& place, const std::string& text) {
  std::istringstream stream(text);
  std::string word;
  std::vector<double> numbers;
  while (stream >> word) numbers.push_back(number_of(place, word));
  if (numbers.empty()) refuse(place, "nothing", "a list of numbers");
  if (numbers.front() != static_cast<double>(numbers.size() - 1))
    refuse(place, fmt::format("{} numbers", numbers.size() - 1), fmt::format("{}, as it says,", numbers.front()));
  numbers.erase(numbers.begin());
  return numbers;
}

/// Whether opacity depends on the gradient: not if it is 1 everywhere.
bool depends_on_gradient(const std::vector<std::array<double, 2>>& points) {
  return std::any_of(points.begin(), points.end(), [](const auto& point) { return point[1] != 1; });
}

FileMap slicer_map(const std::string& place, const std::string& opacity, const std::string& gradient,
                   const std::string& color) {
  FileMap result{.format = std::string(format_name)};
  add_opacities(result.map, place + ": scalarOpacity", counted_numbers(place + ": scalarOpacity", opacity));
  add_colors(result.map, place + ": colorTransfer", counted_numbers(place + ": colorTransfer", color));
  if (!gradient.empty())
    result.has_gradient_opacity = depends_on_gradient(
        groups_of<2>(place + ": gradientOpacity", counted_numbers(place + ": gradientOpacity", gradient)));
  return result;
}

nlohmann::ordered_json lighting_of(double ambient, double diffuse, double specular, double power) {
  return {{"ambient", ambient}, {"diffuse", diffuse}, {"specular", specular}, {"shininess", power}};
}

FileMap read_text_map(const std::filesystem::path& path) {
  const std::string file = path.string();
  std::istringstream text(read_text(file, "a readable volume property"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
  constexpr std::size_t first_list = 6;  // behind interpolation, shading and four numbers of lighting
  if (lines.size() < first_list + 3)
    refuse(file, fmt::format("{} lines", lines.size()), "six lines of one number and three lists");
  std::array<double, first_list> numbers{};
  for (std::size_t i = 0; i < first_list; ++i)
    numbers[i] = number_of(file, std::string_view(lines[i]).substr(0, lines[i].find_last_not_of(" \t\r") + 1));
  FileMap result = slicer_map(file, lines[first_list], lines[first_list + 1], lines[first_list + 2]);
  const auto& [interpolation, shade, diffuse, ambient, specular, power] = numbers;
  if (shade != 0) result.lighting = lighting_of(ambient, diffuse, specular, power);
  result.ignored = {"interpolation"};
  return result;
}

FileMap read_node(const XmlFile& file, const pugi::xml_node& node) {
  FileMap result = slicer_map(place_of(file, node), node.attribute("scalarOpacity").value(),
                              node.attribute("gradientOpacity").value(), node.attribute("colorTransfer").value());
  if (node.attribute("scalarOpacityUnitDistance"))
    result.unit_distance = attribute(file, node, "scalarOpacityUnitDistance");
  if (std::string_view(node.attribute("disableGradientOpacity").value()) == "1") result.has_gradient_opacity = false;
  if (std::string_view(node.attribute("shade").value()) == "1") {
    const auto number = [&](const char* name, double usual) {
      return node.attribute(name) ? attribute(file, node, name) : usual;
    };
    result.lighting = lighting_of(number("ambient", 0.1), number("diffuse", 0.7), number("specular", 0.2),
                                  number("specularPower", 10));
  }
  for (const char* const name :
       {"interpolation", "effectiveRange", "isoSurfaceValues", "independentComponents", "useClippedVoxelIntensity"})
    if (node.attribute(name)) result.ignored.emplace_back(name);
  return result;
}

// --- .vp.json ---

/// The curve from a point to the next, where the file states one.
template <class Value>
Keyed<Value> key_of(const JsonReader& point, Value value) {
  Keyed<Value> key{.s = point.at("x").number(), .value = std::move(value)};
  if (const auto midpoint = point.find("midpoint")) key.midpoint = midpoint->number(0, 1);
  if (const auto sharpness = point.find("sharpness")) key.sharpness = sharpness->number(0, 1);
  return key;
}

FileMap read_property(const JsonReader& json) {
  FileMap result{.format = std::string(format_name)};
  const auto components = json.at("components").items(1);
  const JsonReader& component = components.front();
  if (components.size() > 1)
    result.ignored.push_back(fmt::format("components 1 to {}, for a volume of one component", components.size() - 1));
  for (const JsonReader& point : component.at("scalarOpacity").at("points").items())
    result.map.opacities.push_back(key_of(point, point.at("y").number()));
  for (const JsonReader& point : component.at("rgbTransferFunction").at("points").items()) {
    const auto color = point.at("color").numbers(3);
    if (color.size() != 3) point.at("color").refuse_value("a list of 3 numbers");
    result.map.colors.push_back(key_of(point, Vector3<double>(color[0], color[1], color[2])));
  }
  const auto disables = component.find("disableGradientOpacity");
  if (const auto gradient = component.find("gradientOpacity"); gradient && !(disables && disables->boolean())) {
    std::vector<std::array<double, 2>> points;
    for (const JsonReader& point : gradient->at("points").items())
      points.push_back({point.at("x").number(), point.at("y").number()});
    result.has_gradient_opacity = depends_on_gradient(points);
  }
  if (const auto unit = component.find("scalarOpacityUnitDistance")) result.unit_distance = unit->positive_number();
  if (const auto shade = component.find("shade"); shade && shade->boolean()) {
    const auto number = [&component](const char* name, double usual) {
      const auto lighting = component.find("lighting");
      const auto value = lighting ? lighting->find(name) : std::nullopt;
      return value ? value->number() : usual;
    };
    result.lighting = lighting_of(number("ambient", 0.1), number("diffuse", 0.7), number("specular", 0.2),
                                  number("specularPower", 10));
  }
  for (const auto& [name, value] : json.members())
    if (name != "components") result.ignored.push_back(name);
  for (const char* const name : {"componentWeight", "grayTransferFunction"})
    if (component.find(name)) result.ignored.emplace_back(name);
  return result;
}

}  // namespace

std::vector<NamedMap> read_slicer_text(const std::filesystem::path& file) {
  return {{"", [file] { return read_text_map(file); }}};
}

std::vector<NamedMap> read_slicer_xml(const std::filesystem::path& file) {
  return maps_of(read_xml(file), "VolumeProperty", read_node);
}

std::vector<NamedMap> read_slicer_json(const JsonReader& document) {
  std::vector<NamedMap> maps;
  const auto items = document.at("volumeProperties").items(1);
  // The format has no names: they are told apart by their number.
  for (std::size_t i = 0; i < items.size(); ++i)
    maps.push_back({items.size() == 1 ? "" : std::to_string(i), [item = items[i]] { return read_property(item); }});
  return maps;
}

}  // namespace raytruth

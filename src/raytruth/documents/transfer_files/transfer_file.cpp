#include "raytruth/documents/transfer_files/transfer_file.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/transfer/color_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

/// What a file's opacities are those of.
enum class OpacityUnit { spacing, side_200, side_150 };

/// A transfer function of a file, before anything is known of the grid.
struct FileMap {
  std::string format;
  std::string name = {};
  ColorMap map = {};
  OpacityUnit unit = OpacityUnit::spacing;
  std::optional<std::array<double, 2>> own_range =
      {};  ///< of scalars that stands for the data's; none: they are the data's
  bool has_gradient_opacity = false;
};

[[noreturn]] void refuse(std::string_view place, std::string_view found, std::string_view allowed) {
  throw InputError(one_line(fmt::format("{}: found {}; {} is allowed", place, found, allowed)));
}

/// Takes the one of this name; of a single one, none need be named.
template <class Map, class NameOf>
const Map& chosen(const std::vector<Map>& maps, const TransferFileRequest& request, const NameOf& name_of) {
  const std::string file = request.file.string();
  if (maps.empty()) refuse(file, "no transfer function", "one or more");
  std::vector<std::string> names;
  for (const Map& map : maps) names.push_back(name_of(map));
  if (!request.preset) {
    if (maps.size() == 1) return maps.front();
    refuse(file, fmt::format("{} transfer functions and no preset named", maps.size()),
           fmt::format("\"preset\" with one of their names ({}, ...)", shortened(names.front())));
  }
  const auto found = std::find(names.begin(), names.end(), *request.preset);
  if (found == names.end()) {
    const auto closest = closest_word(*request.preset, std::vector<std::string_view>(names.begin(), names.end()));
    refuse(file,
           fmt::format("no preset {}{}", shortened(*request.preset),
                       closest.empty() ? "" : fmt::format(" (perhaps {})", closest)),
           fmt::format("one of {}", shortened(fmt::format("{}", fmt::join(names, ", ")), 200)));
  }
  return maps[static_cast<std::size_t>(found - names.begin())];
}

/// Numbers in groups: the first of each group is the scalar.
template <std::size_t Size>
std::vector<std::array<double, Size>> groups_of(const std::string& place, const std::vector<double>& numbers) {
  if (numbers.empty() || numbers.size() % Size != 0)
    refuse(place, fmt::format("{} numbers", numbers.size()), fmt::format("a multiple of {}", Size));
  std::vector<std::array<double, Size>> groups(numbers.size() / Size);
  for (std::size_t i = 0; i < numbers.size(); ++i) groups[i / Size][i % Size] = numbers[i];
  return groups;
}

void add_colors(ColorMap& map, const std::string& place, const std::vector<double>& numbers) {
  for (const auto& [s, r, g, b] : groups_of<4>(place, numbers)) map.colors.push_back({s, {r, g, b}});
}

void add_opacities(ColorMap& map, const std::string& place, const std::vector<double>& numbers) {
  for (const auto& [s, opacity] : groups_of<2>(place, numbers)) map.opacities.push_back({s, opacity});
}

// --- JSON: ParaView, VolView, ParaView Glance ---

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

FileMap read_json(const TransferFileRequest& request) {
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

// --- Lists of numbers in text: 3D Slicer ---

double number_of(const std::string& place, std::string_view word) {
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number))
    refuse(place, fmt::format("\"{}\"", shortened(word)), "a finite number");
  return number;
}

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
bool depends_on_gradient(const std::string& place, const std::string& text) {
  const auto points = groups_of<2>(place, counted_numbers(place, text));
  return std::any_of(points.begin(), points.end(), [](const auto& point) { return point[1] != 1; });
}

FileMap slicer_map(const std::string& place, const std::string& opacity, const std::string& gradient,
                   const std::string& color) {
  FileMap result{.format = "3D Slicer volume property"};
  add_opacities(result.map, place + ": scalarOpacity", counted_numbers(place + ": scalarOpacity", opacity));
  add_colors(result.map, place + ": colorTransfer", counted_numbers(place + ": colorTransfer", color));
  result.has_gradient_opacity = !gradient.empty() && depends_on_gradient(place + ": gradientOpacity", gradient);
  return result;
}

FileMap read_vp(const TransferFileRequest& request) {
  const std::string file = request.file.string();
  std::istringstream text(read_text(file, "a readable volume property"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
  constexpr std::size_t first_list = 6;  // behind interpolation, shading and four numbers of lighting
  if (lines.size() < first_list + 3)
    refuse(file, fmt::format("{} lines", lines.size()), "six lines of one number and three lists");
  for (std::size_t i = 0; i < first_list; ++i)
    number_of(file, std::string_view(lines[i]).substr(0, lines[i].find_last_not_of(" \t\r") + 1));
  return slicer_map(file, lines[first_list], lines[first_list + 1], lines[first_list + 2]);
}

// --- XML ---

pugi::xml_document read_xml(const std::filesystem::path& file) {
  const std::string text = read_text(file.string(), "a readable XML file");
  pugi::xml_document document;
  const auto result = document.load_buffer(text.data(), text.size());
  if (!result) {
    const auto line =
        std::count(text.begin(), text.begin() + std::min<std::ptrdiff_t>(result.offset, std::ssize(text)), '\n') + 1;
    refuse(fmt::format("{}: line {}", file.string(), line), fmt::format("\"{}\"", result.description()),
           "well-formed XML");
  }
  return document;
}

std::string place_of(const std::filesystem::path& file, const pugi::xml_node& node) {
  return fmt::format("{}: {}", file.string(), node.path('/'));
}

double attribute(const std::filesystem::path& file, const pugi::xml_node& node, const char* name) {
  const std::string place = fmt::format("{}/@{}", place_of(file, node), name);
  if (node.attribute(name).empty()) refuse(place, "nothing", "a number");
  return number_of(place, node.attribute(name).value());
}

pugi::xml_node child_of(const std::filesystem::path& file, const pugi::xml_node& node, const char* name) {
  const pugi::xml_node child = node.child(name);
  if (!child) refuse(fmt::format("{}/{}", place_of(file, node), name), "nothing", "one");
  return child;
}

/// The nodes of this name anywhere in the document.
std::vector<pugi::xml_node> nodes_named(const pugi::xml_document& document, const char* name) {
  std::vector<pugi::xml_node> nodes;
  for (const auto& found : document.select_nodes(fmt::format("//{}", name).c_str())) nodes.push_back(found.node());
  return nodes;
}

FileMap read_slicer(const TransferFileRequest& request) {
  const pugi::xml_document document = read_xml(request.file);
  const auto nodes = nodes_named(document, "VolumeProperty");
  const pugi::xml_node& node = chosen(
      nodes, request, [](const pugi::xml_node& property) { return std::string(property.attribute("name").value()); });
  FileMap result = slicer_map(place_of(request.file, node), node.attribute("scalarOpacity").value(),
                              node.attribute("gradientOpacity").value(), node.attribute("colorTransfer").value());
  result.name = node.attribute("name").value();
  return result;
}

/// Voreen: intensities in `domain`, 8-bit colours; where a key is split, `colorL` counts below it, `colorR` from it on.
FileMap read_voreen(const TransferFileRequest& request) {
  const auto& file = request.file;
  const pugi::xml_document document = read_xml(file);
  const auto nodes = nodes_named(document, "TransFuncIntensity");
  const pugi::xml_node& node = chosen(nodes, request, [](const pugi::xml_node&) { return std::string(); });
  FileMap result{.format = "Voreen transfer function", .unit = OpacityUnit::side_200, .own_range = {{0, 1}}};

  // What changes the keys in other ways must not be there.
  const auto only = [&](const char* name, const char* which, double allowed) {
    const pugi::xml_node child = node.child(name);
    if (child && attribute(file, child, which) != allowed)
      refuse(place_of(file, child), fmt::format("{} {}", which, child.attribute(which).value()),
             fmt::format("{}", allowed));
  };
  only("gammaValue", "value", 1);
  only("threshold", "x", 0);
  only("threshold", "y", 1);
  only("alphaMode", "value", 1);
  if (std::string_view(node.child("ignoreAlpha").attribute("value").value()) == "true")
    refuse(place_of(file, node.child("ignoreAlpha")), "true", "false");
  double low = 0;
  double high = 1;
  if (const pugi::xml_node domain = node.child("domain")) {
    low = attribute(file, domain, "x");
    high = attribute(file, domain, "y");
    if (!(low < high)) refuse(place_of(file, domain), fmt::format("{} to {}", low, high), "an ascending pair");
    // Beyond 0 to 1 it is no share of the data's range: these are the data's own scalars.
    if (low < 0 || high > 1) result.own_range.reset();
  }
  const auto add = [&](double s, const pugi::xml_node& color) {
    constexpr double most = 255;
    result.map.colors.push_back(
        {s,
         {attribute(file, color, "r") / most, attribute(file, color, "g") / most, attribute(file, color, "b") / most}});
    result.map.opacities.push_back({s, attribute(file, color, "a") / most});
  };
  for (const pugi::xml_node& key : node.child("Keys").children("key")) {
    const double s = low + (high - low) * attribute(file, child_of(file, key, "intensity"), "value");
    add(s, child_of(file, key, "colorL"));
    if (std::string_view(key.child("split").attribute("value").value()) == "true")
      add(s, child_of(file, key, "colorR"));
  }
  return result;
}

FileMap read_inviwo(const TransferFileRequest& request) {
  const auto& file = request.file;
  const pugi::xml_document document = read_xml(file);
  const auto nodes = nodes_named(document, "Points");
  const pugi::xml_node& points = chosen(nodes, request, [](const pugi::xml_node&) { return std::string(); });
  FileMap result{.format = "Inviwo transfer function", .unit = OpacityUnit::side_150, .own_range = {{0, 1}}};
  for (const auto& [name, allowed] : {std::pair{"maskMin", 0.0}, {"maskMax", 1.0}, {"type", 0.0}}) {
    const pugi::xml_node child = points.parent().child(name);
    if (child && attribute(file, child, "content") != allowed)
      refuse(place_of(file, child), child.attribute("content").value(), fmt::format("{}", allowed));
  }
  for (const pugi::xml_node& point : points.children("Point")) {
    const double s = attribute(file, child_of(file, point, "pos"), "content");
    const pugi::xml_node color = child_of(file, point, "rgba");
    result.map.colors.push_back(
        {s, {attribute(file, color, "x"), attribute(file, color, "y"), attribute(file, color, "z")}});
    result.map.opacities.push_back({s, attribute(file, color, "w")});
  }
  return result;
}

FileMap read_map(const TransferFileRequest& request) {
  const std::string extension = request.file.extension().string();
  if (extension == ".json") return read_json(request);
  if (extension == ".xml" || extension == ".mrml") return read_slicer(request);
  if (extension == ".vp") return read_vp(request);
  if (extension == ".tfi") return read_voreen(request);
  if (extension == ".itf") return read_inviwo(request);
  refuse(request.file.string(), fmt::format("the extension \"{}\"", shortened(extension)),
         "one of .json, .xml, .mrml, .vp, .tfi, .itf");
}

// --- For a grid ---

/// The length that opacities are those of, in smallest spacings.
double length_of(OpacityUnit unit, const Grid& grid) {
  if (unit == OpacityUnit::spacing) return 1;
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    side = std::max(side, static_cast<double>(grid.size[axis]) * grid.spacing[axis]);
  const double smallest = *std::min_element(grid.spacing.begin(), grid.spacing.end());
  return side / smallest / (unit == OpacityUnit::side_200 ? 200 : 150);
}

std::string_view words_of(OpacityUnit unit) {
  switch (unit) {
    case OpacityUnit::side_200:
      return "of 1/200 of the grid's longest side, as Voreen's reference step";
    case OpacityUnit::side_150:
      return "of 1/150 of the grid's longest side, as Inviwo's reference step";
    default:
      return "of a smallest spacing, as VTK's unit distance of 1";
  }
}

/// Stretches the scalars of a map from its own range to another one.
void stretch(FileMap& map, const std::array<double, 2>& to, const std::string& file) {
  const auto from = map.own_range.value_or(std::array{map.map.colors.front().s, map.map.colors.back().s});
  if (!(from[0] < from[1]))
    refuse(file, fmt::format("scalars from {} to {}", from[0], from[1]), "a range that can be stretched");
  const auto moved = [&](double s) { return to[0] + (s - from[0]) / (from[1] - from[0]) * (to[1] - to[0]); };
  for (auto& key : map.map.colors) key.s = moved(key.s);
  for (auto& key : map.map.opacities) key.s = moved(key.s);
}

}  // namespace

FileTransfer read_transfer_file(const TransferFileRequest& request, const Grid& grid,
                                std::vector<std::string>& warnings) {
  const std::string file = request.file.string();
  FileMap map = read_map(request);
  if (map.map.colors.empty()) refuse(file, "no colours", "one or more");
  if (map.has_gradient_opacity && !request.ignores_gradient_opacity)
    refuse(file, "opacity that depends on the gradient", "it, with --ignore-gradient-opacity,");
  if (request.opacity) {
    FileMap other = read_map({.file = *request.opacity, .ignores_gradient_opacity = request.ignores_gradient_opacity});
    if (other.has_gradient_opacity && !request.ignores_gradient_opacity)
      refuse(request.opacity->string(), "opacity that depends on the gradient", "it, with --ignore-gradient-opacity,");
    map.map.opacities = std::move(other.map.opacities);
    map.unit = other.unit;
  }
  if (map.map.opacities.empty())
    refuse(file, "a map of colours without opacity", "such a map together with --opacity FILE");

  std::string scalars = "those of the file are the data's";
  if (request.range || map.own_range) {
    const auto [low, high] = grid.range();
    const auto to = request.range.value_or(std::array{low, high});
    stretch(map, to, file);
    scalars = fmt::format("those of the file stretched from {} to {}", to[0], to[1]);
  }
  const auto clamped = std::count_if(map.map.opacities.begin(), map.map.opacities.end(),
                                     [](const auto& key) { return key.value > largest_opacity; });
  if (clamped > 0)
    warnings.push_back(fmt::format("warning: {}: {} opacities above 1 - 2^-12 are clamped to it", file, clamped));
  const double unit_length = request.unit_length.value_or(length_of(map.unit, grid));
  Json description{{"file", request.file.filename().string()}, {"format", map.format}};
  if (!map.name.empty()) description["preset"] = map.name;
  description["color"] = "the file's RGB, taken as linear light";
  description["opacity"] = request.unit_length ? "of unit_length, as asked for" : words_of(map.unit);
  description["unit_length"] = unit_length;
  description["scalars"] = scalars;
  if (map.has_gradient_opacity) description["gradient_opacity"] = "ignored";
  try {
    return {transfer_of(map.map, unit_length), std::move(description)};
  } catch (const InputError& error) {
    throw InputError(one_line(fmt::format("{}: {}", file, error.what())));
  }
}

}  // namespace raytruth

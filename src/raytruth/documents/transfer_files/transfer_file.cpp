#include "raytruth/documents/transfer_files/transfer_file.hpp"

#include "raytruth/core/one_line.hpp"
#include "raytruth/documents/json/input.hpp"
#include "raytruth/documents/transfer_files/file_map.hpp"
#include "raytruth/documents/transfer_files/xml_numbers.hpp"
#include "raytruth/transfer/color_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

// --- Formats ---

struct TransferFileFormat {
  std::string_view extension;
  std::vector<NamedMap> (*read)(const std::filesystem::path&);
};

constexpr std::array formats{
    TransferFileFormat{".json", read_json_maps},  TransferFileFormat{".xml", read_xml_maps},
    TransferFileFormat{".mrml", read_slicer_xml}, TransferFileFormat{".vp", read_slicer_text},
    TransferFileFormat{".tfi", read_voreen},      TransferFileFormat{".itf", read_inviwo},
};

std::vector<NamedMap> maps_in(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  std::vector<std::string_view> known;
  for (const TransferFileFormat& format : formats) {
    if (format.extension == extension) return format.read(file);
    known.push_back(format.extension);
  }
  refuse(file.string(), fmt::format("the extension \"{}\"", shortened(extension)),
         fmt::format("one of {}", fmt::join(known, ", ")));
}

/// Takes the one of this name; of a single one, none need be named.
FileMap chosen_map(const std::filesystem::path& path, const std::optional<std::string>& preset,
                   std::string_view member) {
  const std::string file = path.string();
  const std::vector<NamedMap> maps = maps_in(path);
  if (maps.empty()) refuse(file, "no transfer function", "one or more");
  std::vector<std::string_view> names;
  for (const NamedMap& map : maps) names.push_back(map.name);
  if (!preset) {
    if (maps.size() == 1) return maps.front().read();
    refuse(file, fmt::format("{} transfer functions and no preset named", maps.size()),
           fmt::format("\"{}\" with one of their names ({}, ...; `raytruth transfer` of the file lists them)", member,
                       shortened(names.front())));
  }
  const auto found = std::find(names.begin(), names.end(), *preset);
  if (found == names.end()) {
    const auto closest = closest_word(*preset, names);
    refuse(
        file,
        fmt::format("no preset {}{}", shortened(*preset), closest.empty() ? "" : fmt::format(" (perhaps {})", closest)),
        fmt::format("one of {}", shortened(fmt::format("{}", fmt::join(names, ", ")), 200)));
  }
  return maps[static_cast<std::size_t>(found - names.begin())].read();
}

// --- Mending what programs write ---

/// Adds what was mended to the warnings, each beginning with the file.
class Mender {
 public:
  Mender(std::string file, std::vector<std::string>& warnings) : file_(std::move(file)), warnings_(warnings) {}

  template <class Value>
  void mend(std::vector<Keyed<Value>>& keys, std::string_view what) {
    sort(keys, what);
    join(keys, what);
    thin(keys, what);
    for (auto& key : keys) clamp(key.value, what);
  }

 private:
  /// Rounding of binary32 and of printing, summed.
  static constexpr double rounding = 1e-6;
  /// Scalars nearer than this share of their range are two values at one scalar: programs that allow one value only
  /// move the second by as little as they can.
  static constexpr double nearest = 1e-12;

  void say(const std::string& what) { warnings_.push_back(fmt::format("{}: {}", file_, what)); }

  template <class Value>
  void sort(std::vector<Keyed<Value>>& keys, std::string_view what) {
    const auto is_before = [](const auto& a, const auto& b) { return a.s < b.s; };
    if (std::is_sorted(keys.begin(), keys.end(), is_before)) return;
    std::stable_sort(keys.begin(), keys.end(), is_before);
    say(fmt::format("the {} are not in the order of their scalars; they are sorted", what));
  }

  template <class Value>
  void join(std::vector<Keyed<Value>>& keys, std::string_view what) {
    if (keys.size() < 2) return;
    const double near = nearest * (keys.back().s - keys.front().s);
    std::size_t joined = 0;
    double first = 0;
    for (std::size_t i = 1; i < keys.size(); ++i) {
      const double distance = keys[i].s - keys[i - 1].s;
      if (!(distance > 0 && distance <= near)) continue;
      if (joined++ == 0) first = keys[i - 1].s;
      keys[i].s = keys[i - 1].s;
    }
    if (joined > 0)
      say(
          fmt::format("{} of the {} lie next to the one before as near as can be, the first at {}; both are values at "
                      "one scalar, a jump",
                      joined, what, first));
  }

  /// Where three and more are at one scalar, the first and the last are its limits; those between them are never met.
  template <class Value>
  void thin(std::vector<Keyed<Value>>& keys, std::string_view what) {
    const std::size_t before = keys.size();
    for (std::size_t i = 1; i + 1 < keys.size();) {
      if (keys[i - 1].s == keys[i + 1].s)
        keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(i));
      else
        ++i;
    }
    if (keys.size() < before)
      say(fmt::format("{} of the {} lie between two others at one scalar; they are left out", before - keys.size(),
                      what));
  }

  void clamp(double& value, std::string_view what) {
    const double clamped = std::clamp(value, 0.0, 1.0);
    if (!(std::abs(value - clamped) <= rounding) || value == clamped) return;  // what is worse than rounded is refused
    say(fmt::format("{} among the {} is taken as {}", value, what, clamped));
    value = clamped;
  }

  void clamp(Vector3<double>& color, std::string_view what) {
    for (double& channel : color) clamp(channel, what);
  }

  std::string file_;
  std::vector<std::string>& warnings_;
};

/// `member` is the JSON member that names the preset.
FileMap mended_map(const std::filesystem::path& file, const std::optional<std::string>& preset, std::string_view member,
                   bool ignores_gradient_opacity, std::vector<std::string>& warnings) {
  FileMap map = chosen_map(file, preset, member);
  if (map.has_gradient_opacity && !ignores_gradient_opacity)
    refuse(file.string(), "opacity that depends on the gradient",
           "it, with --ignore-gradient-opacity or \"ignore_gradient_opacity\": true,");
  if (!(map.unit_distance > 0 && std::isfinite(map.unit_distance)))
    refuse(file.string(), fmt::format("unit distance {}", map.unit_distance), "a finite number > 0");
  Mender mender(file.string(), warnings);
  mender.mend(map.map.colors, "colours");
  mender.mend(map.map.opacities, "opacities");
  return map;
}

// --- Lengths ---

/// The length that opacities are those of, in smallest spacings.
double length_of(const FileMap& map, const TransferVolume* volume, const std::string& file) {
  const bool is_world = map.unit == OpacityUnit::world;
  if (volume != nullptr)
    return (is_world ? map.unit_distance : volume->longest_side / (map.unit == OpacityUnit::side_200 ? 200 : 150)) /
           volume->smallest_spacing;
  if (is_world) return map.unit_distance;
  refuse(file,
         fmt::format("opacities of 1/{} of a volume's longest side, and no volume",
                     map.unit == OpacityUnit::side_200 ? 200 : 150),
         "{\"file\": FILE, \"unit_length\": N} with the length in voxels that they are to be of");
}

std::string words_of(const FileMap& map) {
  switch (map.unit) {
    case OpacityUnit::side_200:
      return "of 1/200 of the grid's longest side, as Voreen's reference step";
    case OpacityUnit::side_150:
      return "of 1/150 of the grid's longest side, as Inviwo's reference step";
    default:
      return map.unit_distance == 1 ? "of 1 world unit, as VTK's unit distance"
                                    : fmt::format("of {} world units, the file's unit distance", map.unit_distance);
  }
}

// --- Scalars ---

using Range = std::array<double, 2>;

template <class Value>
Range range_of(const std::vector<Keyed<Value>>& keys) {
  return {keys.front().s, keys.back().s};
}

/// Stretches scalars from one range to another one; those of logarithms in the logarithm, as ParaView does.
template <class Value>
void stretch(std::vector<Keyed<Value>>& keys, const Range& from, const Range& to, bool is_logarithmic,
             const std::string& file) {
  if (from[0] == from[1]) return;  // one colour or opacity for all
  if (is_logarithmic && !(from[0] > 0 && to[0] > 0))
    refuse(file,
           fmt::format("colours over the logarithm of the scalars {} to {}", from[0] > 0 ? to[0] : from[0],
                       from[0] > 0 ? to[1] : from[1]),
           "a range of numbers > 0");
  for (auto& key : keys) {
    const double share = is_logarithmic ? std::log(key.s / from[0]) / std::log(from[1] / from[0])
                                        : (key.s - from[0]) / (from[1] - from[0]);
    key.s = key.s == from[1] ? to[1]
            : is_logarithmic ? to[0] * std::pow(to[1] / to[0], share)
                             : to[0] + share * (to[1] - to[0]);
  }
}

/// What a list of a file is stretched from.
template <class Value>
Range own_range(const FileMap& map, const std::vector<Keyed<Value>>& keys) {
  if (map.own_range) return *map.own_range;
  const ColorMap& both = map.map;
  if (map.scalars != FileScalars::absolute || both.colors.empty() || both.opacities.empty()) return range_of(keys);
  // Scalars of the data are common to both lists, also where one of them ends earlier.
  const auto [first, last] = range_of(both.colors);
  const auto [first_opacity, last_opacity] = range_of(both.opacities);
  return {std::min(first, first_opacity), std::max(last, last_opacity)};
}

bool covers(const Range& wide, const Range& narrow) { return wide[0] <= narrow[0] && narrow[1] <= wide[1]; }

/// Stretches a map's colours, or its opacities, where that is asked for or the file's program does so. Says what was
/// done.
template <class Value>
std::string fit(std::vector<Keyed<Value>>& keys, const FileMap& map, const TransferFileRequest& request,
                const TransferVolume* volume, bool is_logarithmic, std::vector<std::string>& warnings) {
  const std::string file = request.file.string();
  const Range own = own_range(map, keys);
  bool stretches = map.scalars == FileScalars::relative;
  std::string habit;
  if (map.scalars == FileScalars::unstated && volume != nullptr && own != volume->range) {
    // Only where the file says nothing is there a choice to be told of.
    const auto& opacities = map.map.opacities;
    stretches = !covers(opacities.empty() ? own : range_of(opacities), volume->range);
    habit = stretches ? "; \"scalars\": \"as_stated\" leaves them"
                      : fmt::format(
                            ", for {} to {} cover the data's {} to {}; \"scalars\": \"stretched\" stretches "
                            "them over the data, as ParaView does by default",
                            own[0], own[1], volume->range[0], volume->range[1]);
  }
  if (request.scalars) stretches = *request.scalars == ScalarChoice::stretched;
  std::optional<Range> to = request.range;
  if (!to && stretches && volume != nullptr) to = volume->range;
  if (!to) {
    if (stretches && (request.scalars || map.own_range))
      warnings.push_back(fmt::format(
          "{}: its scalars are meant to be stretched over the data's, and there are none: they are taken as "
          "they are, from {} to {}; \"range\": [LOW, HIGH] stretches them",
          file, own[0], own[1]));
    if (!habit.empty() && !request.scalars) warnings.push_back(fmt::format("{}: scalars are as stated{}", file, habit));
    return "those of the file are the data's";
  }
  if (!((*to)[0] < (*to)[1])) {
    to = Range{(*to)[0], (*to)[0] + 1};
    warnings.push_back(
        fmt::format("{}: the data has one value, {}: scalars are stretched from it to {}", file, (*to)[0], (*to)[1]));
  }
  stretch(keys, own, *to, is_logarithmic, file);
  std::string done = fmt::format("those of the file stretched from {} to {}", (*to)[0], (*to)[1]);
  if (!habit.empty() && !request.range && !request.scalars)
    warnings.push_back(
        fmt::format("{}: scalars from {} to {} are stretched over the data's {} to {}, as "
                    "ParaView does by default{}",
                    file, own[0], own[1], (*to)[0], (*to)[1], habit));
  return done;
}

std::string_view name_of(ColorSpace space) {
  switch (space) {
    case ColorSpace::hsv:
      return "HSV, the hue not past red";
    case ColorSpace::hsv_wrapped:
      return "HSV, the hue the shorter way";
    case ColorSpace::lab:
      return "CIE L*a*b*";
    case ColorSpace::diverging:
      return "Msh, diverging";
    case ColorSpace::step:
      return "steps";
    default:
      return "RGB";
  }
}

}  // namespace

TransferVolume transfer_volume(const Grid& grid) {
  const auto [low, high] = grid.range();
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    side = std::max(side, static_cast<double>(grid.size[axis]) * grid.spacing[axis]);
  return {{low, high}, *std::min_element(grid.spacing.begin(), grid.spacing.end()), side};
}

std::vector<NamedMap> read_json_maps(const std::filesystem::path& file) {
  const JsonReader document = JsonReader::from_lenient_file(file.string());
  if (document.is_object() && document.find("volumeProperties")) return read_slicer_json(document);
  return read_vtk_json(document);
}

std::vector<NamedMap> read_xml_maps(const std::filesystem::path& file) {
  return read_xml(file).nodes_named("ColorMap").empty() ? read_slicer_xml(file) : read_vtk_xml(file);
}

bool is_transfer_file(const std::filesystem::path& file) {
  if (file.extension() != ".json") return true;
  const JsonReader document = JsonReader::from_lenient_file(file.string());
  return !(document.is_object() && (document.find("points") || document.find("isosurfaces")));
}

std::vector<TransferListing> transfer_functions_in(const std::filesystem::path& file) {
  std::vector<TransferListing> result;
  for (const NamedMap& named : maps_in(file)) {
    TransferListing listing{.name = named.name};
    try {
      const FileMap map = named.read();
      listing.colors = map.map.colors.size();
      listing.opacities = map.map.opacities.size();
      const auto is_less = [](const auto& a, const auto& b) { return a.s < b.s; };
      if (!map.map.colors.empty()) {
        const auto [low, high] = std::minmax_element(map.map.colors.begin(), map.map.colors.end(), is_less);
        listing.range = {low->s, high->s};
      }
    } catch (const InputError& error) {
      listing.problem = error.what();
    }
    result.push_back(std::move(listing));
  }
  return result;
}

FileTransfer read_transfer_file(const TransferFileRequest& request, const TransferVolume* volume,
                                std::vector<std::string>& warnings) {
  const std::string file = request.file.string();
  FileMap map = mended_map(request.file, request.preset, "preset", request.ignores_gradient_opacity, warnings);
  if (map.map.colors.empty()) refuse(file, "no colours", "one or more");
  if (!request.opacity && map.map.opacities.empty())
    refuse(file, "a map of colours without opacity", "such a map together with --opacity FILE or \"opacity\": FILE");
  std::optional<FileMap> other;
  if (request.opacity) {
    other = mended_map(*request.opacity, request.opacity_preset, "opacity_preset", request.ignores_gradient_opacity,
                       warnings);
    if (other->map.opacities.empty()) refuse(request.opacity->string(), "no opacities", "one or more");
  }

  const FileMap& of_opacity = other ? *other : map;
  TransferFileRequest opacity_request = request;
  if (request.opacity) opacity_request.file = *request.opacity;
  std::vector<std::string> remarks;
  ColorMap fitted = map.map;
  fitted.opacities = of_opacity.map.opacities;
  const std::string scalars = fit(fitted.colors, map, request, volume, fitted.is_logarithmic, remarks);
  const std::string opacity_scalars = fit(fitted.opacities, of_opacity, opacity_request, volume, false, remarks);
  for (std::string& remark : remarks)
    if (std::find(warnings.begin(), warnings.end(), remark) == warnings.end()) warnings.push_back(std::move(remark));

  const double unit_length =
      request.unit_length ? *request.unit_length : length_of(of_opacity, volume, opacity_request.file.string());
  Json description{{"file", request.file.filename().string()}, {"format", map.format}};
  if (!map.name.empty()) description["preset"] = map.name;
  if (request.opacity) description["opacity_file"] = request.opacity->filename().string();
  description["color"] = "the file's RGB, taken as linear light";
  description["interpolation"] =
      fmt::format("colours in {}{}{}; opacities linear between points", name_of(fitted.space),
                  fitted.is_logarithmic ? ", over the logarithm of the scalar" : "",
                  is_sampled(fitted) ? ", sampled at 1025 scalars and linear between them" : "");
  description["opacity"] = request.unit_length ? "of unit_length, as asked for" : words_of(of_opacity);
  description["unit_length"] = unit_length;
  description["unit"] = volume != nullptr
                            ? fmt::format("a smallest spacing of the volume, {} world units", volume->smallest_spacing)
                            : "a voxel's side, taken as 1 world unit";
  description["scalars"] = scalars;
  if (opacity_scalars != scalars) description["opacity_scalars"] = opacity_scalars;
  if (of_opacity.has_gradient_opacity) description["gradient_opacity"] = "ignored";
  if (!map.lighting.is_null()) {
    description["lighting"] = map.lighting;
    Json shading{{"light", {0, 0, 1}}};
    shading.update(map.lighting);
    warnings.push_back(
        fmt::format("{}: the light that it asks for is not taken; a scene states its own, such as \"shading\": {}",
                    file, shading.dump()));
  }
  if (!map.ignored.empty()) description["ignored"] = map.ignored;
  try {
    PiecewiseLinear transfer = transfer_of(fitted, unit_length);
    description["points"] = transfer.points().size();
    description["range"] = {transfer.points().front().s, transfer.points().back().s};
    return {std::move(transfer), std::move(description)};
  } catch (const InputError& error) {
    throw InputError(one_line(fmt::format("{}: {}", file, error.what())));
  }
}

}  // namespace raytruth

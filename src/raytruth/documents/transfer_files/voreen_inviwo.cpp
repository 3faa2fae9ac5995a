#include "raytruth/documents/transfer_files/xml_numbers.hpp"

namespace raytruth {

namespace {

/// Voreen: intensities in `domain`, 8-bit colours; where a key is split, `colorL` counts below it, `colorR` from it on.
FileMap read_intensities(const XmlFile& file, const pugi::xml_node& node) {
  FileMap result{.format = "Voreen transfer function",
                 .unit = OpacityUnit::side_200,
                 .scalars = FileScalars::relative,
                 .own_range = {{0, 1}}};

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
    if (low < 0 || high > 1) result.scalars = FileScalars::absolute;
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

FileMap read_points(const XmlFile& file, const pugi::xml_node& points) {
  FileMap result{.format = "Inviwo transfer function",
                 .unit = OpacityUnit::side_150,
                 .scalars = FileScalars::relative,
                 .own_range = {{0, 1}}};
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

}  // namespace

std::vector<NamedMap> read_voreen(const std::filesystem::path& file) {
  return maps_of(read_xml(file), "TransFuncIntensity", read_intensities);
}

std::vector<NamedMap> read_inviwo(const std::filesystem::path& file) {
  return maps_of(read_xml(file), "Points", read_points);
}

}  // namespace raytruth

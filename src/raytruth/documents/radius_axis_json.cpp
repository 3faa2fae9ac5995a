#include "raytruth/documents/radius_axis_json.hpp"

#include <algorithm>
#include <string>

namespace raytruth {

namespace {

// The last of `RadiusLookUp` is a slip, for studies alone.
constexpr std::array<std::string_view, 3> look_up_names{"linear_in_curvature", "linear_in_radius", "nearest"};

template <class Enum, std::size_t Count>
Enum read_enum(const JsonReader& json, const std::array<std::string_view, Count>& names) {
  const std::string word = json.word({names.begin(), names.end()});
  return static_cast<Enum>(std::find(names.begin(), names.end(), word) - names.begin());
}

}  // namespace

RadiusAxis read_radius_axis(const JsonReader& json, const RadiusAxis& standard) {
  json.only({"axis", "low", "high", "count", "look_up"});
  RadiusAxis axis = standard;
  axis.steps = read_enum<RadiusSteps>(json.at("axis"), radius_steps_names);
  axis.low = json.at("low").positive_number();
  axis.high = json.at("high").positive_number();
  axis.count = static_cast<std::size_t>(json.at("count").integer(1, static_cast<std::int64_t>(most_radii)));
  axis.look_up =
      axis.steps == RadiusSteps::signed_curvature ? RadiusLookUp::linear_in_curvature : RadiusLookUp::linear_in_radius;
  if (const auto look_up = json.find("look_up")) axis.look_up = read_enum<RadiusLookUp>(*look_up, look_up_names);
  json.blame_for([&] {
    check(axis);
    return 0;
  });
  return axis;
}

nlohmann::ordered_json radius_axis_json(const RadiusAxis& axis) {
  nlohmann::ordered_json json{{"axis", std::string(radius_steps_names[static_cast<std::size_t>(axis.steps)])},
                              {"low", axis.low},
                              {"high", axis.high},
                              {"count", axis.count},
                              {"look_up", std::string(look_up_names[static_cast<std::size_t>(axis.look_up)])}};
  for (std::size_t node = 0; node < axis.node_count(); ++node) json["curvatures"].push_back(axis.curvature(node));
  return json;
}

}  // namespace raytruth

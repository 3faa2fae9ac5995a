#include "raytruth/documents/case_json.hpp"
#include "raytruth/core/named.hpp"

#include <algorithm>

namespace raytruth {

Vector3<double> read_vector(const JsonReader& json) {
  const auto numbers = json.numbers(3);
  if (numbers.size() != 3) json.refuse_value("a list of 3 numbers");
  return {numbers[0], numbers[1], numbers[2]};
}

Emission read_emission(const JsonReader& json) {
  const auto emission = json.find("emission");
  return emission && emission->word({"associated", "plain"}) == "plain" ? Emission::plain : Emission::associated;
}

Border read_border(const JsonReader& json) {
  const auto border = json.find("border");
  if (!border) return Border::half_voxel;
  const std::string name = border->word({border_names.begin(), border_names.end()});
  return static_cast<Border>(std::find(border_names.begin(), border_names.end(), name) - border_names.begin());
}

std::vector<std::string> read_schemes(const JsonReader& json, const std::vector<std::string_view>& names,
                                      std::vector<OutsideProgram>* programs) {
  std::vector<std::string_view> allowed{"reference"};
  allowed.insert(allowed.end(), names.begin(), names.end());
  std::vector<std::string> schemes;
  std::vector<std::string> taken{allowed.begin(), allowed.end()};
  for (const JsonReader& item : json.items()) {
    if (programs != nullptr && is_outside_program(item)) {
      programs->push_back(read_outside_program(item));
      const std::string& name = programs->back().name;
      if (std::find(taken.begin(), taken.end(), name) != taken.end())
        item.at("name").refuse_value("a name that no scheme and no other program has");
      taken.push_back(name);
      continue;
    }
    const std::string scheme = item.word(allowed);
    if (std::find(schemes.begin(), schemes.end(), scheme) != schemes.end()) item.refuse_value("each scheme once");
    schemes.push_back(scheme);
  }
  return schemes;
}

nlohmann::ordered_json color_json(const Vector3<double>& color) { return {color[0], color[1], color[2]}; }

nlohmann::ordered_json refused(std::string_view why) { return {{"status", "refused"}, {"why", why}}; }

void add_status(nlohmann::ordered_json& answer, Status status) {
  if (status == Status::converged) return;
  answer["status"] = "not_converged";
  answer["why"] =
      "error_bound holds, but is above 1e-13 times the brightest light that a ray can have (at least 1): rounding "
      "hides "
      "on which side of a jump of the transfer function the scalar is, or how near it comes to an opacity of 1, or the "
      "ray is very deep";
}

Sampling read_sampling(const JsonReader& json) {
  Sampling sampling{json.at("kind").word(names_of(catalogue::samplings)), {}};
  if (sampling.kind == "constant") {
    json.only({"kind", "step"});
    sampling.step = json.at("step").positive_number();
  } else {
    json.only({"kind"});
  }
  return sampling;
}

void check_form(const JsonReader& json, std::string_view form) {
  if (const auto stated = json.find("raytruth")) stated->word({form});
}

}  // namespace raytruth

#include "raytruth/documents/slab_case.hpp"

#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/documents/case_json.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/shading/slab_reference.hpp"
#include "raytruth/shading/slab_shading.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array treatments{std::pair{std::string_view("clamp"), Negative::clamp},
                                std::pair{std::string_view("mirror"), Negative::mirror},
                                std::pair{std::string_view("none"), Negative::none}};

Vector3<double> read_unit_vector(const JsonReader& json) {
  Vector3<double> vector = read_vector(json);
  json.blame_for([&vector] {
    check_unit_vector(vector);
    return 0;
  });
  return vector;
}

ShadedSlab read_slab(const JsonReader& json) {
  json.only({"front", "back", "length", "front_normal", "back_normal"});
  ShadedSlab slab{json.at("front").number(), json.at("back").number(), json.at("length").number(0),
                  read_unit_vector(json.at("front_normal")), read_unit_vector(json.at("back_normal"))};
  json.at("back_normal").blame_for([&slab] {
    check(slab);
    return 0;
  });
  return slab;
}

Lighting read_lighting(const JsonReader& json) {
  json.only({"light", "half", "ambient", "diffuse", "specular", "shininess", "highlight", "negative"});
  Lighting lighting;
  lighting.light = read_unit_vector(json.at("light"));
  lighting.half = read_unit_vector(json.at("half"));
  lighting.ambient = json.at("ambient").number(0);
  lighting.diffuse = json.at("diffuse").number(0);
  lighting.specular = json.at("specular").number(0);
  lighting.shininess = json.at("shininess").number(1, largest_shininess);
  lighting.highlight =
      find_named(catalogue::highlights(), json.at("highlight").word(names_of(catalogue::highlights())));
  const std::string negative =
      json.at("negative").word({treatments[0].first, treatments[1].first, treatments[2].first});
  for (const auto& [name, value] : treatments)
    if (name == negative) lighting.negative = value;
  json.at("shininess").blame_for([&lighting] {
    check(lighting);
    return 0;
  });
  return lighting;
}

bool is_finite(const ShadedRadiance& light) {
  return light.ambient.isFinite().all() && light.diffuse.isFinite().all() && light.specular.isFinite().all() &&
         std::isfinite(light.opacity);
}

Json light_json(const ShadedRadiance& light) {
  return {{"ambient", color_json(light.ambient)},
          {"diffuse", color_json(light.diffuse)},
          {"specular", color_json(light.specular)},
          {"opacity", light.opacity}};
}

Json reference_json(const CertifiedRadiance& truth) {
  if (!is_finite(truth) || !std::isfinite(truth.radius)) return refused(why_not_finite);
  Json answer = light_json(truth);
  answer["error_bound"] = truth.radius;
  add_status(answer, truth.status);
  return answer;
}

Json answer_of(const Shading& shading, const SlabCase& asked, const SlabOptics& optics,
               const CertifiedRadiance& truth) {
  if (const auto why = shading.refusal(asked.lighting); !why.empty()) return refused(why);
  const ShadedRadiance light =
      shade(shading, cosines_of(asked.slab, asked.lighting), optics, asked.emission, asked.lighting);
  const ShadedRadiance error{light.ambient - truth.ambient, light.diffuse - truth.diffuse,
                             light.specular - truth.specular, light.opacity - truth.opacity};
  if (light.specular.isNaN().any() && truth.specular.isFinite().all())
    return refused("its highlight is a power of a negative number that is not whole: not a number");
  if (!is_finite(error) || !std::isfinite(truth.radius)) return refused(why_not_finite);
  Json answer = light_json(light);
  answer["ambient_error"] = color_json(error.ambient);
  answer["diffuse_error"] = color_json(error.diffuse);
  answer["specular_error"] = color_json(error.specular);
  answer["opacity_error"] = error.opacity;
  return answer;
}

}  // namespace

bool is_slab_case(const JsonReader& json) { return json.is_object() && json.find("slab").has_value(); }

SlabCase read_slab_case(const JsonReader& json, std::vector<std::string>& warnings) {
  json.only({"raytruth", "slab", "transfer_function", "emission", "lighting", "schemes"});
  check_form(json, "case/1");
  TransferDocument read = read_transfer_function(json.at("transfer_function"), {}, warnings);
  SlabCase result{.slab = read_slab(json.at("slab")),
                  .transfer = std::move(read.transfer),
                  .emission = read_emission(json),
                  .lighting = read_lighting(json.at("lighting")),
                  .schemes = read_schemes(json.at("schemes"), names_of(catalogue::shadings()))};
  if (read.is_of_another_program) result.transfer_description = std::move(read.description);
  if (result.transfer.is_linear_in_opacity())
    warnings.push_back(fmt::format("warning: {}: {}", json.at("transfer_function").place(), sampled_opacity));
  // RayIntegral refuses numbers that no reference can enclose.
  json.at("transfer_function").blame_for([&] { return RayIntegral(result.transfer, result.emission); });
  return result;
}

Json evaluate(const SlabCase& asked) {
  const auto& [slab, transfer, description, emission, lighting, names] = asked;
  const CertifiedRadiance truth = slab_reference(slab, transfer, emission, lighting);
  const SlabOptics optics(transfer, slab.front, slab.back, slab.length);
  Json schemes = Json::object();
  for (const std::string& name : names)
    if (name != "reference") schemes[name] = answer_of(*find_named(catalogue::shadings(), name), asked, optics, truth);
  Json answer{{"length", slab.length}, {"reference", reference_json(truth)}, {"schemes", std::move(schemes)}};
  if (!description.is_null()) answer["transfer_function"] = description;
  return answer;
}

}  // namespace raytruth

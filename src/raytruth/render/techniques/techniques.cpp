#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/render/technique.hpp"
#include "raytruth/render/techniques/suitable_scheme.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/scheme_integral.hpp"

#include <fmt/format.h>

#include <array>

namespace raytruth {

extern const Technique cell_march_pixels;
extern const Technique mesh_pixels;
extern const Technique deformed_pixels;
extern const Technique quadratic_gray_table_pixels;
extern const Technique reference_pixels;
extern const Technique scheme_pixels;
extern const Technique second_order_table_pixels;
extern const Technique shaded_pixels;
extern const Technique shaded_reference_pixels;
extern const Technique shaded_table_pixels;
extern const Technique surface_pixels;
extern const Technique surface_scheme_pixels;
extern const Technique table_march_pixels;
extern const Technique table_pixels;

std::span<const Technique* const> techniques() {
  static constexpr std::array list{
      &mesh_pixels,
      &deformed_pixels,
      &surface_pixels,
      &surface_scheme_pixels,
      &shaded_reference_pixels,
      &reference_pixels,
      &quadratic_gray_table_pixels,
      &second_order_table_pixels,
      &shaded_table_pixels,
      &table_march_pixels,
      &table_pixels,
      &shaded_pixels,
      &cell_march_pixels,
      &scheme_pixels,
  };
  return list;
}

void refuse_unsuitable_scheme(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene;
  const IntegralScheme* const scheme = find_named(catalogue::integral_schemes(), scene.scheme);
  if (scheme == nullptr) throw InputError(fmt::format("scheme {}; one of the listed is allowed", scene.scheme));
  std::visit(
      [&]<class Field>(const Field& /*field*/) {
        Chain<Field::degree> chain;
        const double length = scene.step.value_or(1);
        chain.pieces = {{0.0, length, {}}, {length, length, {}}};
        chain.end = 2 * length;
        Samples<double> samples;
        take_samples(chain, scene.step, samples);
        const Outcome<> outcome = SchemeIntegral(scene.transfer, scene.emission)(*scheme, chain, samples);
        if (!outcome.refusal.empty()) throw InputError(fmt::format("scheme {}: {}", scheme->name, outcome.refusal));
      },
      prepared.field);
}

}  // namespace raytruth

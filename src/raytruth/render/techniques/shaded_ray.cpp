#include "raytruth/render/techniques/shaded_ray.hpp"

#include "raytruth/core/bernstein_product.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/reference/certified.hpp"
#include "raytruth/rules/rules.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/sampled_march.hpp"
#include "raytruth/schemes/scheme_list.hpp"
#include "raytruth/shading/normal_curve.hpp"
#include "raytruth/signals/cell_walk.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/volume/cell_gradient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <variant>

namespace raytruth {

namespace {

/// The lighting as a pixel sees it.
Lighting lighting_of(const SceneShading& shading, const Vector3<double>& towards_viewer) {
  Lighting lighting = shading.lighting;
  // Gooch's tones are linear in the cosine itself.
  if (shading.gooch) lighting = {.light = lighting.light, .specular = 0, .shininess = 1, .negative = Negative::none};
  const Vector3<double> half = lighting.light + towards_viewer;
  const double norm = half.matrix().norm();
  // Light from straight behind has no highlight.
  if (norm < 1e-6)
    lighting.specular = 0;
  else
    lighting.half = half / norm;
  return lighting;
}

Vector3<double> in_world(const std::array<double, 3>& direction, const std::array<double, 3>& spacing) {
  return {direction[0] * spacing[0], direction[1] * spacing[1], direction[2] * spacing[2]};
}

Bernstein<3> dot(const std::array<Bernstein<3>, 3>& vectors, const Vector3<double>& direction) {
  Bernstein<3> result;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 4; ++i)
      result.coefficients[i] += direction[static_cast<Eigen::Index>(axis)] * vectors[axis].coefficients[i];
  return result;
}

/// Where on [0, 1] the light of normals is not smooth: where a cosine is 0, and where the highlight begins, at a cosine
/// of +-threshold; squared, for the norm is a root. What else the square is 0 at does no harm.
std::vector<double> breaks_of(const std::array<Bernstein<3>, 3>& normals, const Bernstein<3>& along_light,
                              const Bernstein<3>& along_half, const Illumination& illumination, Negative negative) {
  std::vector<double> breaks;
  const auto add_roots = [&breaks](const auto& polynomial) {
    for (const double u : polynomial.sign_changes()) breaks.push_back(u);
  };
  if (negative != Negative::none) {
    add_roots(along_light);
    add_roots(along_half);
  }
  const double threshold = illumination.threshold();
  if (!illumination.is_plain_power() && threshold > 0) {
    Bernstein<6> square = along_half * along_half;
    for (const auto& normal : normals) {
      const Bernstein<6> norm = normal * normal;
      for (std::size_t i = 0; i < norm.coefficients.size(); ++i)
        square.coefficients[i] -= threshold * threshold * norm.coefficients[i];
    }
    add_roots(square);
  }
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

/// A unit vector, or zero where the vector is.
Vector3<double> normalized(const Vector3<double>& vector) {
  const double norm = vector.matrix().norm();
  return norm == 0 ? vector : Vector3<double>(vector / norm);
}

/// Normals at virtual samples from the gradients at the true ones, which are fetched when they are first needed.
class NormalsBetweenSamples {
 public:
  NormalsBetweenSamples(const LitView& view, const Samples<double>& samples, VirtualNormals kind)
      : view_(view),
        samples_(samples),
        is_cubic_(kind == VirtualNormals::catmull_rom || kind == VirtualNormals::catmull_rom_unit),
        is_unit_(kind == VirtualNormals::catmull_rom_unit || kind == VirtualNormals::linear_unit),
        full_(full_intervals(samples)),
        fetched_(samples.positions.size()) {}

  /// At a share u of the interval behind sample k: as VirtualCatmullRom makes scalars, linear where that is.
  Vector3<double> operator()(std::size_t k, double u) {
    const vec4 front = at(k);
    const vec4 back = at(k + 1);
    if (!is_cubic_ || k >= full_ || full_ < 2) return normal_of(front + u * (back - front));
    const vec4 before = k > 0 ? at(k - 1) : ghost(at(0), at(1), at(2));
    const vec4 after = k + 2 <= full_ ? at(k + 2) : ghost(at(full_), at(full_ - 1), at(full_ - 2));
    return normal_of(rules_.virtual_texel(before, front, back, after, u));
  }

 private:
  using vec4 = Rules<double>::vec4;

  static Vector3<double> normal_of(const vec4& texel) { return normalized(texel.head<3>()); }

  const vec4& at(std::size_t sample) {
    auto& texel = fetched_[sample];
    if (!texel) {
      const auto t = static_cast<double>(samples_.positions[sample]);
      texel.emplace(vec4::Zero());
      texel->head<3>() = is_unit_ ? view_.normal_at(t) : view_.gradient_at(t);
    }
    return *texel;
  }

  vec4 ghost(const vec4& first, const vec4& second, const vec4& third) {
    vec4 result;
    for (Eigen::Index i = 0; i < 4; ++i) result[i] = rules_.virtual_catmull_rom_ghost(first[i], second[i], third[i]);
    return result;
  }

  const LitView& view_;
  const Samples<double>& samples_;
  bool is_cubic_;
  bool is_unit_;
  std::size_t full_;
  std::vector<std::optional<vec4>> fetched_;
  Rules<double> rules_;
};

/// Whether a scheme looks virtual samples up.
bool has_virtual_samples(const IntegralScheme* scheme) {
  const auto* const sampled = scheme == nullptr ? nullptr : std::get_if<Sampled>(&scheme->method);
  return sampled != nullptr && sampled->rule == SampledRule::virtual_catmull_rom;
}

/// Samples that a scheme looks up can be lit; so can a signal that is integrated exactly.
bool can_be_lit(const IntegralScheme& scheme) {
  return std::holds_alternative<Sampled>(scheme.method) || std::holds_alternative<Ideal>(scheme.method) ||
         std::holds_alternative<CellCubic>(scheme.method);
}

}  // namespace

LitView::LitView(const PointGradient& gradient, Border border, const SceneShading& shading, const PixelRay& pixel)
    : gradient_(gradient),
      pixel_(pixel),
      sign_(shading.is_along_gradient ? 1 : -1),
      entry_(static_cast<double>(clip(gradient.voxels().size, border, pixel.ray.origin, pixel.ray.direction).begin)) {
  const Vector3<double> forward = in_world(pixel.ray.direction, gradient.voxels().spacing);
  lighting_ = lighting_of(shading, -forward / forward.matrix().norm());
}

std::array<double, 3> LitView::position(double t) const {
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] = pixel_.ray.origin[axis] + (entry_ + t / pixel_.length_unit) * pixel_.ray.direction[axis];
  return result;
}

Vector3<double> LitView::gradient_at(double t) const { return sign_ * gradient_(position(t)); }

Vector3<double> LitView::normal_at(double t) const { return normalized(gradient_at(t)); }

std::array<Bernstein<3>, 3> LitView::normals_along(double begin, double end) const {
  const Grid& grid = gradient_.voxels();
  const auto cell = cell_of(grid, position(begin + (end - begin) / 2));
  auto normals = CellGradient(grid, cell).along(in_cell(position(begin), cell), in_cell(position(end), cell));
  for (auto& normal : normals)
    for (double& b : normal.coefficients) b *= sign_;
  return normals;
}

SlabLight LitView::slab_light(const SceneShading& shading, double begin, double end) const {
  const ShadedSlab slab{.front_normal = normal_at(begin), .back_normal = normal_at(end)};
  const bool has_normals =
      !(slab.front_normal == 0).all() && !(slab.back_normal == 0).all() && slab.cosine() >= smallest_normal_cosine;
  if (!has_normals)
    return {{.at = [](double /*x*/, double /*slope*/) { return LitPoint{}; }},
            LightModel(lighting_, shading.gooch, SpecularDensity::white)};
  SlabShader shader = shading.method->shader(cosines_of(slab, lighting_), lighting_);
  const LightModel model(lighting_, shading.gooch, shader.specular_density);
  return {std::move(shader), model};
}

void refuse_unlit(const Scene& scene) {
  const IntegralScheme* const scheme = find_named(catalogue::integral_schemes(), scene.scheme);
  const Shading* const method = scene.shading->method;
  const bool is_reference = scene.scheme == "reference";
  if (!is_reference && (scheme == nullptr || !can_be_lit(*scheme)))
    throw InputError(fmt::format(
        "scheme {} with shading; reference, cell_cubic, and sampled and ideal schemes are allowed", scene.scheme));
  if (scene.field != FieldKind::trilinear && !is_reference && std::holds_alternative<CellCubic>(scheme->method))
    throw InputError("scheme cell_cubic: a trilinear ray, a cubic in each cell, is needed");
  const SceneShading& shading = *scene.shading;
  if (shading.virtual_normals != VirtualNormals::own && !has_virtual_samples(scheme))
    throw InputError(
        fmt::format("virtual normals {} with the scheme {}; schemes that look virtual samples up, as "
                    "sampled_virtual_catmull_rom_3, are allowed",
                    virtual_normals_names[static_cast<std::size_t>(shading.virtual_normals)], scene.scheme));
  const bool lights_samples =
      method != nullptr || (scheme != nullptr && std::holds_alternative<Sampled>(scheme->method));
  if (shading.gradient != GradientKind::voxels && !lights_samples)
    throw InputError(
        fmt::format("gradient {} with the scheme {} and the normal of every point, which needs the gradient voxels; "
                    "sampled schemes, and methods of shading, are allowed",
                    gradient_kind_names[static_cast<std::size_t>(shading.gradient)], scene.scheme));
  if (method == nullptr) return;
  if (is_reference || std::holds_alternative<Sampled>(scheme->method))
    throw InputError(
        fmt::format("shading {} with the scheme {}, whose points have normals of their own; no method, "
                    "or pointwise, is allowed",
                    method->name, scene.scheme));
  if (scene.shading->gooch && find_named(catalogue::normal_curves(), method->name) == nullptr)
    throw InputError(fmt::format("shading {} with Gooch's tones; curves between normals are allowed", method->name));
  const std::string_view why = scene.shading->gooch ? "" : method->refusal(scene.shading->lighting);
  if (!why.empty()) throw InputError(fmt::format("shading {}: {}", method->name, why));
}

template <int Degree>
ShadedRay<Degree>::ShadedRay(const Scene& scene, const PointGradient& gradient)
    : scene_(scene),
      gradient_(gradient),
      scheme_(find_named(catalogue::integral_schemes(), scene.scheme)),
      clear_(scene.transfer, scene.emission),
      look_up_(scene.transfer, scene.emission),
      exact_(scene.transfer, scene.emission),
      approximate_(scene.transfer, scene.emission) {}

/// Goes over the segments between `borders` and puts what `light_segment(begin, end, parts, sum)` makes of the parts of
/// the signal in each, those that are not clear, behind the sum.
template <int Degree>
template <int AnyDegree, class LightSegment>
LitSum ShadedRay<Degree>::add_segments(const Chain<AnyDegree>& shape, const std::vector<DoubleDouble>& borders,
                                       const Omissions& omissions, const LightSegment& light_segment) {
  LitSum sum;
  std::vector<Part<AnyDegree>> parts;
  std::size_t first = 0;
  for (std::size_t k = 0; k + 1 < borders.size() && sum.opacity() < omissions.opaque; ++k) {
    const auto begin = static_cast<double>(borders[k]);
    const auto end = static_cast<double>(borders[k + 1]);
    if (omissions.omit(begin, end)) continue;
    while (first + 1 < shape.pieces.size() && !(borders[k] < shape.end_of(first))) ++first;
    parts.clear();
    for (std::size_t i = first; i < shape.pieces.size() && shape.pieces[i].start < borders[k + 1]; ++i) {
      const auto& piece = shape.pieces[i];
      const DoubleDouble from = std::max(borders[k], piece.start);
      const DoubleDouble to = std::min(borders[k + 1], shape.end_of(i));
      if (!(from < to)) continue;
      const double u_from = from == piece.start ? 0 : std::clamp(piece.local(from), 0.0, 1.0);
      const double u_to = to == shape.end_of(i) ? 1 : std::clamp(piece.local(to), 0.0, 1.0);
      const auto scalar = piece.polynomial.restricted(u_from, u_to);
      const auto [low, high] = std::minmax_element(scalar.coefficients.begin(), scalar.coefficients.end());
      if (!clear_.contain(*low, *high)) parts.push_back({scalar, static_cast<double>(from), static_cast<double>(to)});
    }
    if (!parts.empty()) light_segment(begin, end, parts, sum);
  }
  return sum;
}

template <int Degree>
template <int AnyDegree>
void ShadedRay<Degree>::add_by_method(const LitView& view, double begin, double end,
                                      const std::vector<Part<AnyDegree>>& parts, LitIntegral<AnyDegree>& integral,
                                      LitSum& sum) {
  const auto [shader, model] = view.slab_light(*scene_.shading, begin, end);
  const std::vector<double> ends = shader.breaks();
  std::vector<double> breaks;
  const auto add = [&](double LitPoint::*specular) {
    LitSum result = sum;
    for (const auto& part : parts) {
      breaks.clear();
      const double width = part.end - part.begin;
      for (const double x : ends)
        if (const double u = (begin + x * (end - begin) - part.begin) / width; u > 0 && u < 1) breaks.push_back(u);
      std::sort(breaks.begin(), breaks.end());
      const auto light = [&, &at = shader.at, &to_light = model](double u, double slope) {
        const double x = std::clamp((part.begin + u * width - begin) / (end - begin), 0.0, 1.0);
        const LitPoint point = at(x, slope);
        return to_light(point.diffuse, point.*specular);
      };
      integral.add(part.scalar, width, breaks, light, result);
    }
    return result;
  };
  const LitSum one = add(&LitPoint::specular);
  // The larger one of the two integrals of the highlight counts.
  if (shader.has_two_highlights) {
    const LitSum other = add(&LitPoint::other_specular);
    sum = one;
    sum.color = one.color.max(other.color);
  } else {
    sum = one;
  }
}

template <int Degree>
template <int AnyDegree>
void ShadedRay<Degree>::add_pointwise(const LitView& view, const std::vector<Part<AnyDegree>>& parts,
                                      LitIntegral<AnyDegree>& integral, LitSum& sum) {
  const Lighting& lighting = view.lighting();
  const Illumination illumination(lighting);
  const LightModel model(lighting, scene_.shading->gooch, SpecularDensity::white);
  std::vector<double> breaks;
  for (const auto& part : parts) {
    const auto normals = view.normals_along(part.begin, part.end);
    const Bernstein<3> along_light = dot(normals, lighting.light);
    const Bernstein<3> along_half = dot(normals, lighting.half);
    breaks = breaks_of(normals, along_light, along_half, illumination, lighting.negative);
    const auto light = [&](double u, double /*slope*/) {
      const double norm = std::hypot(normals[0].value(u), normals[1].value(u), normals[2].value(u));
      if (norm == 0) return model.without_normal();
      const double specular = lighting.specular > 0 ? illumination.specular(along_half.value(u) / norm) : 0;
      return model(illumination.diffuse(along_light.value(u) / norm), specular);
    };
    integral.add(part.scalar, part.end - part.begin, breaks, light, sum);
  }
}

template <int Degree>
template <int AnyDegree>
PixelLight ShadedRay<Degree>::integrate(const LitView& view, const Chain<AnyDegree>& shape, const Chain<Degree>& signal,
                                        const Samples<double>& samples, const Omissions& omissions,
                                        LitIntegral<AnyDegree>& integral) {
  const bool has_method = scene_.shading->method != nullptr;
  if (has_method) {
    borders_ = samples.positions;
  } else {
    // A segment of the signal lies inside of one cell.
    borders_.clear();
    for (const auto& piece : signal.pieces) borders_.push_back(piece.start);
    borders_.push_back(signal.end);
  }
  const LitSum sum =
      add_segments(shape, borders_, omissions,
                   [&](double begin, double end, const std::vector<Part<AnyDegree>>& parts, LitSum& all) {
                     if (has_method)
                       add_by_method(view, begin, end, parts, integral, all);
                     else
                       add_pointwise(view, parts, integral, all);
                   });
  return {.light = {sum.color[0], sum.color[1], sum.color[2], sum.opacity()},
          .radius = sum.difference,
          .status = sum.is_resolved ? Status::converged : Status::not_converged};
}

template <int Degree>
PixelLight ShadedRay<Degree>::march_samples(const LitView& view, const Sampled& method, const Chain<Degree>& signal,
                                            const Samples<double>& samples, const Omissions& omissions) const {
  const Lighting& lighting = view.lighting();
  const Illumination illumination(lighting);
  const LightModel model(lighting, scene_.shading->gooch, SpecularDensity::white);
  const bool has_curves = scene_.shading->virtual_normals != VirtualNormals::own;
  NormalsBetweenSamples between(view, samples, scene_.shading->virtual_normals);
  std::size_t interval = 0;
  const auto normal_at = [&](double t) {
    if (!has_curves) return view.normal_at(t);
    const auto place = [&samples](std::size_t k) { return static_cast<double>(samples.positions[k]); };
    while (interval + 2 < samples.positions.size() && t >= place(interval + 1)) ++interval;
    return between(interval, (t - place(interval)) / (place(interval + 1) - place(interval)));
  };
  const auto lit = [&](double value, double t) {
    Eigen::Array4d optics = look_up_(value);
    const double white = scene_.emission == Emission::associated ? optics[3] : 1;
    // What sends out nothing needs no normal.
    if (white == 0 && (optics == 0).all()) return optics;
    const Vector3<double> normal = normal_at(t);
    const auto cosine = [&normal](const Vector3<double>& direction) { return (normal * direction).sum(); };
    const PointLight light = (normal == 0).all() ? model.without_normal()
                                                 : model(illumination.diffuse(cosine(lighting.light)),
                                                         illumination.specular(cosine(lighting.half)));
    optics.head<3>() = light.matter * optics.head<3>() + white * light.white;
    return optics;
  };
  const Outcome<> outcome = march(method, lit, SampledRay<double>(signal, samples), omissions);
  return {.light = {outcome.color[0], outcome.color[1], outcome.color[2], outcome.opacity}};
}

template <int Degree>
PixelLight ShadedRay<Degree>::operator()(const PixelRay& pixel, const Chain<Degree>& signal,
                                         const Samples<double>& samples, const Omissions& omissions) {
  if (signal.pieces.empty()) return {};
  const LitView view(gradient_, scene_.border, *scene_.shading, pixel);
  if (scheme_ == nullptr || std::holds_alternative<CellCubic>(scheme_->method))
    return integrate(view, signal, signal, samples, omissions, exact_);
  std::string_view refusal_of_samples;
  catalogue::visit_scheme(scheme_->signal, [&]<class S>() {
    refusal_of_samples = refusal<S>(samples);
    if (refusal_of_samples.empty() && std::holds_alternative<Ideal>(scheme_->method))
      approximate<S>(signal, samples, approximation_);
  });
  if (!refusal_of_samples.empty()) throw InputError(fmt::format("scheme {}: {}", scheme_->name, refusal_of_samples));
  if (const auto* const method = std::get_if<Sampled>(&scheme_->method))
    return march_samples(view, *method, signal, samples, omissions);
  return integrate(view, approximation_, signal, samples, omissions, approximate_);
}

template class ShadedRay<3>;
template class ShadedRay<largest_degree>;

}  // namespace raytruth

#include "raytruth/documents/case.hpp"

#include "raytruth/catalogue.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/deformation/deformed_light.hpp"
#include "raytruth/documents/case_json.hpp"
#include "raytruth/documents/deformation_json.hpp"
#include "raytruth/documents/field_document.hpp"
#include "raytruth/documents/mesh_source.hpp"
#include "raytruth/documents/read_transfer_function.hpp"
#include "raytruth/metrics/signal_error.hpp"
#include "raytruth/reference/ray_truth.hpp"
#include "raytruth/reference/surface_integral.hpp"
#include "raytruth/reference/surroundings_of.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/schemes/surface_march.hpp"
#include "raytruth/signals/marschner_lobb.hpp"
#include "raytruth/signals/ray_field.hpp"
#include "raytruth/skipping/clear_scalars.hpp"
#include "raytruth/tables/lit/isoslab_table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

// Differences, and parabolas through values at uneven distances, stay within binary64.
constexpr double largest_value = 0x1p900;

constexpr std::string_view why_no_integral = "the case states no transfer function";
constexpr std::string_view why_no_deformation = "the case states a deformation, and this scheme follows straight rays";
constexpr std::string_view why_no_surfaces =
    "the transfer function has isosurfaces, and this scheme integrates matter alone: `raytruth list surfaces` has "
    "schemes that find them";
constexpr std::string_view why_no_gaps =
    "the ray leaves the mesh and enters it again, and this scheme would sample across the gap";
constexpr std::string_view why_without_surfaces = "the transfer function has no isosurfaces";

std::array<double, 3> read_place(const JsonReader& json) {
  const Vector3<double> vector = read_vector(json);
  return {vector[0], vector[1], vector[2]};
}

void read_piecewise_polynomial(const JsonReader& json, Case& ray) {
  json.only({"kind", "breaks", "coefficients"});
  const auto breaks = json.at("breaks").numbers();
  const auto places = json.at("breaks").items(2);
  if (breaks.front() != 0) places.front().refuse_value("0");
  for (std::size_t i = 1; i < breaks.size(); ++i)
    if (!(breaks[i - 1] < breaks[i])) places[i].refuse_value(fmt::format("a number > {}", breaks[i - 1]));
  std::vector<std::vector<double>> coefficients;
  for (const JsonReader& piece : json.at("coefficients").items())
    coefficients.push_back(piece.numbers(largest_degree + 1));
  auto chain = json.at("coefficients").blame_for([&] { return piecewise_polynomial(breaks, coefficients); });
  if (ray.transfer) {
    ray.signal_error = piecewise_polynomial_error(breaks, coefficients, chain);
    ray.precise_signal = precise_piecewise_polynomial(breaks, coefficients);
  }
  ray.signal = std::move(chain);
}

/// The ray through the deformed volume: origin and direction are the world's, in voxels as the object's are.
void trace_deformed(const JsonReader& json, const JsonReader& deformation, const TrilinearField& field, const Ray& ray,
                    Case& result) {
  if (const auto length = json.find("length"))
    length->refuse("a length with a deformation", "whole rays: what is cut off is not known before they are bent,");
  constexpr std::array<double, 3> unit{1, 1, 1};
  const Deformation read = read_deformation(deformation, field.grid(), field.border(), unit);
  const DeformedVolume volume(field.grid(), field.border(), unit, read.lattice, read.least_determinant);
  result.deformed.emplace();
  volume.trace(ray, *result.deformed);
  result.signal = result.deformed->chain;
  result.border = field.border();
}

/// The origin, direction and length of a ray; the direction is checked.
Ray read_ray(const JsonReader& json) {
  Ray ray{.origin = read_place(json.at("origin")), .direction = read_place(json.at("direction"))};
  json.at("direction").blame_for([&ray] { return unit_direction(ray.direction); });
  if (const auto length = json.find("length")) ray.length = length->number(0);
  return ray;
}

void read_marschner_lobb(const JsonReader& json, Case& ray) {
  json.only({"kind", "origin", "direction", "length"});
  const MarschnerLobbRay formula{read_ray(json)};
  ray.signal = json.at("origin").blame_for([&] { return trace_marschner_lobb(formula.ray); });
  ray.formula = formula;
}

void read_analytic(const JsonReader& json, Case& ray) {
  json.only({"kind", "name"});
  const AnalyticSignal& formula = *find_named(analytic_signals(), json.at("name").word(names_of(analytic_signals())));
  ray.signal = expand(formula);
  ray.formula = formula;
}

/// The ray's signal, and how far it may be from the field where that is asked for.
template <class Field>
void trace(const JsonReader& json, const Field& field, const Ray& ray, Case& result,
           std::vector<std::string>& warnings) {
  Chain<Field::degree> chain;
  json.at("origin").blame_for([&] {
    field.trace(ray, chain);
    return 0;
  });
  if (result.transfer) {
    result.signal_error = field.error(ray, chain);
    result.precise_signal = field.trace_precisely(ray);
    result.surroundings = surroundings_of(field, ray.direction);
  }
  result.border = field.border();
  if (chain.pieces.empty() && has_no_extent(field.grid(), field.border()))
    warnings.push_back(fmt::format("{}: warning: the ray is empty: {}", json.place(), why_no_extent));
  result.signal = std::move(chain);
}

template <int Degree>
void check_values(const JsonReader& json, const Chain<Degree>& signal) {
  for (const auto& piece : signal.pieces)
    for (const double value : piece.polynomial.coefficients)
      if (!(std::abs(value) <= largest_value))
        json.refuse(fmt::format("values up to {}", value), "a signal of values up to 2^900 in magnitude");
}

/// Whether a scheme is asked for, beside the reference.
bool names_a_scheme(const Case& ray) {
  return std::any_of(ray.schemes.begin(), ray.schemes.end(),
                     [](const std::string& scheme) { return scheme != "reference"; });
}

bool is_refused(const Json& answer) { return answer.contains("status") && answer["status"] == "refused"; }

template <int Degree>
void take_samples(const Chain<Degree>& signal, const Sampling& sampling, Samples<double>& samples) {
  if (sampling.step) return sample_constant(signal, *sampling.step, samples);
  if (2 * signal.pieces.size() + 1 > largest_sample_count)
    throw InputError(fmt::format("found {} cells on a ray; at most {} samples are allowed", signal.pieces.size(),
                                 largest_sample_count));
  sample_cells(signal, samples);
}

bool is_finite(const Vector3<double>& color, double opacity) {
  return color.isFinite().all() && std::isfinite(opacity);
}

/// Where a ray through a mesh meets isosurfaces, part by part: a gap crosses none. Lengths are those of the signal.
SurfaceHits hits_of_parts(const MeshRay& ray, const PreciseChain<3>& signal, const std::vector<double>& scalars) {
  SurfaceHits result;
  DoubleDouble start;
  for (std::size_t i = 0; i < ray.parts.size(); ++i) {
    const std::size_t begin = ray.parts[i].first_piece;
    const std::size_t end = i + 1 < ray.parts.size() ? ray.parts[i + 1].first_piece : signal.pieces.size();
    PreciseChain<3> part{.pieces = {}, .length = 0.0, .of_length = signal.of_length};
    for (std::size_t k = begin; k < end; ++k) {
      part.pieces.push_back(signal.pieces[k]);
      part.length += signal.pieces[k].extent;
    }
    // Which cells a ray meets is exact, and so is where a constant one ends but for the length that it adds.
    SurfaceHits found = surface_hits(part, scalars, {.steepest = 0, .are_in_line = true});
    for (SurfaceHit& hit : found.hits) {
      hit.t += start;
      hit.error += signal.unclaimed;
      hit.piece += begin;
      result.hits.push_back(hit);
    }
    for (UnresolvedContact& contact : found.unresolved) {
      contact.from += start.high;
      contact.to += start.high;
      result.unresolved.push_back(contact);
    }
    start += part.length;
  }
  return result;
}

/// How much longer gaps make the way to a place of the signal.
DoubleDouble gaps_before(const MeshRay& ray, std::size_t piece) {
  DoubleDouble start;
  DoubleDouble gap;
  for (const MeshPart& part : ray.parts) {
    if (part.first_piece > piece) break;
    gap = part.from - start;
    start += part.to - part.from;
  }
  return gap;
}

/// Where the ray's parts are, and through how many cells each leads.
Json parts_json(const MeshRay& ray) {
  Json parts = Json::array();
  for (std::size_t i = 0; i < ray.parts.size(); ++i) {
    const std::size_t end = i + 1 < ray.parts.size() ? ray.parts[i + 1].first_piece : ray.cells.size();
    parts.push_back({{"from", static_cast<double>(ray.parts[i].from)},
                     {"to", static_cast<double>(ray.parts[i].to)},
                     {"cells", end - ray.parts[i].first_piece}});
  }
  return parts;
}

/// Where the ray meets the case's isosurfaces.
template <int Degree>
SurfaceHits hits_of(const Case& ray, const Chain<Degree>& /*signal*/) {
  std::vector<double> scalars;
  for (const Isosurface& surface : ray.isosurfaces) scalars.push_back(surface.s);
  const auto& signal = std::get<PreciseChain<Degree>>(ray.precise_signal);
  if constexpr (Degree == 3)
    if (ray.mesh_ray) return hits_of_parts(*ray.mesh_ray, signal, scalars);
  return surface_hits(signal, scalars, ray.surroundings);
}

/// The certified answer to the case; `hits`: of its isosurfaces, null if it has none.
template <int Degree>
Certified truth_of(const Case& ray, const Chain<Degree>& signal, const SurfaceHits* hits) {
  if (ray.deformed) return DeformedLight(*ray.transfer, ray.emission)(*ray.deformed);
  if (const auto* const marschner_lobb = std::get_if<MarschnerLobbRay>(&ray.formula))
    return arb_integral(*marschner_lobb, *ray.transfer, ray.emission);
  if (const auto* const analytic = std::get_if<AnalyticSignal>(&ray.formula))
    return arb_integral(*analytic, *ray.transfer, ray.emission);
  const auto& precise = std::get<PreciseChain<Degree>>(ray.precise_signal);
  if (hits != nullptr) return SurfaceIntegral(*ray.transfer, ray.emission, ray.isosurfaces)(precise, *hits);
  RayIntegral integral(*ray.transfer, ray.emission);
  return ray_truth(
      integral, signal, ray.signal_error, [&precise]() -> const auto& { return precise; });
}

Json truth_json(const Certified& truth) {
  if (!is_finite(truth.color, truth.opacity) || !std::isfinite(truth.radius)) return refused(why_not_finite);
  Json answer{{"color", color_json(truth.color)}, {"opacity", truth.opacity}, {"error_bound", truth.radius}};
  add_status(answer, truth.status);
  return answer;
}

/// What the deformed ray is made of; its length is that of the world over the deformation's determinant.
Json deformation_json(const DeformedSignal& signal) {
  return {{"pieces", signal.chain.pieces.size()},
          {"arcs", signal.arcs},
          {"length_error", signal.rate_error},
          {"certified", signal.is_certified}};
}

/// The hits of isosurfaces, each with its place in binary64 and what that may be off by.
void add_hits(SurfaceHits found, const std::optional<MeshRay>& mesh_ray, Json& answer) {
  Json hits = Json::array();
  for (SurfaceHit& hit : found.hits) {
    if (mesh_ray) hit.t += gaps_before(*mesh_ray, hit.piece);
    const auto t = static_cast<double>(hit.t);
    const double radius = std::nextafter(hit.error + std::abs(static_cast<double>(hit.t - t)), HUGE_VAL);
    hits.push_back({{"t", t}, {"radius", radius}, {"surface", hit.surface}, {"rising", hit.is_rising}});
  }
  Json unresolved = Json::array();
  for (const UnresolvedContact& contact : found.unresolved)
    unresolved.push_back({{"from", contact.from}, {"to", contact.to}, {"surface", contact.surface}});
  answer["hits"] = std::move(hits);
  answer["unresolved"] = std::move(unresolved);
}

Json difference_json(const Difference& difference) {
  return {{"color", color_json(difference.color)}, {"opacity", difference.opacity}};
}

/// What the scheme makes of colour and opacity: in binary64, and in the budget what binary32 adds.
Json integral_json(const ErrorBudget& budget, const Certified& truth) {
  const Outcome<>& outcome = budget.outcome;
  if (!outcome.refusal.empty()) return refused(outcome.refusal);
  const Difference error{outcome.color - truth.color, outcome.opacity - truth.opacity};
  if (!is_finite(error.color, error.opacity) || !std::isfinite(budget.radius)) return refused(why_not_finite);
  Json answer{
      {"color", color_json(outcome.color)},
      {"opacity", outcome.opacity},
      {"color_error", color_json(error.color)},
      {"opacity_error", error.opacity},
      {"error_bound", budget.radius},
      {"budget", {{"signal", difference_json(budget.signal)}, {"quadrature", difference_json(budget.quadrature)}}},
      {"samples", outcome.fetches},
      {"lookups", outcome.lookups},
      {"composites", outcome.composites}};
  if (budget.round32) answer["budget"]["round32"] = difference_json(*budget.round32);
  add_status(answer, outcome.status);
  return answer;
}

/// How far the scheme's approximate signal is from the signal.
template <Scheme S, int Degree>
Json signal_json(const Chain<Degree>& signal, const Samples<double>& samples) {
  if (const auto why = refusal<S>(samples); !why.empty()) return refused(why);
  Chain<3> approximation;
  approximate<S>(signal, samples, approximation);
  const double length = signal.length();
  const double error = xi(signal, approximation);
  const double error_max = xi_max(signal, approximation);
  Json answer{{"xi", error}, {"xi_per_length", nullptr}, {"xi_max", error_max}, {"xi_max_per_length", nullptr}};
  if (length > 0) {
    if (!std::isfinite(error) || !std::isfinite(error / length) || !std::isfinite(error_max / length))
      return refused(why_not_finite);
    answer["xi_per_length"] = error / length;
    answer["xi_max_per_length"] = error_max / length;
  } else {
    answer["why"] = "the ray is empty: nothing is per length";
  }
  answer["samples"] = fetches<S>(samples);
  return answer;
}

/// The schemes of a case, one after the other: what they make of the signal, and of colour and opacity.
template <int Degree>
class SchemeAnswers {
 public:
  SchemeAnswers(const Case& ray, const Chain<Degree>& signal, const Certified* truth) : signal_(signal), truth_(truth) {
    ray.json.at("sampling").blame_for([&] { take_samples(signal, *ray.sampling, samples_); });
    if (truth != nullptr) integrate_.emplace(*ray.transfer, ray.emission);
  }

  Json operator()(const std::string& name) {
    if (find_named(catalogue::surface_schemes(), name) != nullptr) return refused(why_without_surfaces);
    const IntegralScheme& scheme = *find_named(catalogue::integral_schemes(), name);
    Json answer = Json::object();
    if (truth_ != nullptr) answer = integral_json(integrate_->budget(scheme, signal_, samples_, *truth_), *truth_);
    if (is_refused(answer)) return answer;
    catalogue::visit_scheme(name, [&]<class S>() {
      Json of_signal = signal_json<S>(signal_, samples_);
      if (is_refused(of_signal))
        answer = std::move(of_signal);
      else
        answer.update(of_signal);
    });
    return answer.empty() ? refused(why_no_integral) : answer;
  }

 private:
  const Chain<Degree>& signal_;
  const Certified* truth_;  ///< null: there is no transfer function
  Samples<double> samples_;
  std::optional<SchemeIntegral> integrate_;
};

/// What a scheme makes of the isosurfaces and of the matter between them, and its error.
Json surface_json(const Outcome<>& outcome, const Certified& truth) {
  const Difference error{outcome.color - truth.color, outcome.opacity - truth.opacity};
  const double radius = outcome.radius + truth.radius;
  if (!is_finite(error.color, error.opacity) || !std::isfinite(radius)) return refused(why_not_finite);
  Json answer{
      {"color", color_json(outcome.color)}, {"opacity", outcome.opacity},      {"color_error", color_json(error.color)},
      {"opacity_error", error.opacity},     {"error_bound", radius},           {"samples", outcome.fetches},
      {"lookups", outcome.lookups},         {"composites", outcome.composites}};
  add_status(answer, outcome.status);
  return answer;
}

/// The scheme's surfaces, found between samples.
template <int Degree>
Json found_surfaces_json(const Case& ray, const SurfaceScheme& scheme, const Chain<Degree>& signal,
                         const Samples<double>& samples, const Certified& truth) {
  SurfaceMarch march(*ray.transfer, ray.emission, ray.isosurfaces);
  const SurfaceOutcome outcome = march(scheme, signal, samples, ray.surface_numbers.tolerance);
  Json answer = surface_json(outcome, truth);
  if (is_refused(answer)) return answer;
  answer["hits"] = Json::array();
  for (const SampledHit& hit : outcome.hits) answer["hits"].push_back({{"t", hit.t}, {"surface", hit.surface}});
  return answer;
}

/// The scheme's isoslabs, from a table over the signal's range.
template <int Degree>
Json isoslab_json(const Case& ray, IsoslabDensity density, const Chain<Degree>& signal, const Samples<double>& samples,
                  const Certified& truth) {
  if (signal.pieces.empty()) return surface_json({}, truth);
  const auto [low, high] = signal.range();
  const auto& points = ray.transfer->points();
  const bool is_clear = ClearScalars(*ray.transfer, ray.emission).contain(points.front().s, points.back().s);
  if (!is_clear) return refused("isoslabs stand alone: the transfer function has points too");
  if (density == IsoslabDensity::per_length && !samples.step)
    return refused("isoslabs per length need samples at a constant step, the length of the table's slabs");
  const Isoslab& isoslab = ray.surface_numbers.isoslab;
  const TableAxes axes{.size = isoslab.size,
                       .low = low,
                       .high = low < high ? high : low + 1,  // a constant signal asks for one entry only
                       .length = samples.step.value_or(1)};
  const IsoslabTable table =
      ray.json.at("transfer_function").blame_for([&] { return IsoslabTable(ray.isosurfaces, density, isoslab, axes); });
  Json answer = surface_json(isoslab_light(table, samples), truth);
  if (is_refused(answer)) return answer;
  answer["isoslab_width"] = isoslab.width * (axes.high - axes.low) / static_cast<double>(axes.size - 1);
  return answer;
}

/// What the case's schemes make of a ray that meets isosurfaces.
template <int Degree>
Json surface_answers(const Case& ray, const Chain<Degree>& signal, const Certified& truth) {
  Json answers = Json::object();
  if (!names_a_scheme(ray)) return answers;
  Samples<double> samples;
  ray.json.at("sampling").blame_for([&] { take_samples(signal, *ray.sampling, samples); });
  for (const std::string& name : ray.schemes) {
    if (name == "reference") continue;
    const SurfaceScheme* const scheme = find_named(catalogue::surface_schemes(), name);
    if (scheme == nullptr)
      answers[name] = refused(why_no_surfaces);
    else if (scheme->isoslab)
      answers[name] = isoslab_json(ray, *scheme->isoslab, signal, samples, truth);
    else
      answers[name] = found_surfaces_json(ray, *scheme, signal, samples, truth);
  }
  return answers;
}

/// The names of all schemes that a case may ask for.
std::vector<std::string_view> scheme_names() {
  std::vector<std::string_view> names = names_of(catalogue::integral_schemes());
  for (const SurfaceScheme& scheme : catalogue::surface_schemes()) names.push_back(scheme.name);
  return names;
}

}  // namespace

Case CaseReader::read(const JsonReader& json, std::vector<std::string>& warnings) {
  json.only({"raytruth", "signal", "deformation", "transfer_function", "emission", "sampling", "schemes",
             "surface_tolerance", "isoslab"});
  check_form(json, "case/1");
  const JsonReader signal = json.at("signal");
  const std::string kind = signal.at("kind").word(names_of(catalogue::signals));
  std::vector<OutsideProgram> programs;
  Case ray{json, std::nullopt, read_schemes(json.at("schemes"), scheme_names(), &programs), std::nullopt};
  ray.programs = std::move(programs);
  ray.surface_numbers = read_surface_numbers(json, ray.schemes);
  if (json.find("sampling") || names_a_scheme(ray)) ray.sampling = read_sampling(json.at("sampling"));
  const bool has_volume = kind == "trilinear" || kind == "tricubic";
  if (const auto transfer = json.find("transfer_function")) {
    std::vector<std::string> read_again;  // the signal tells them
    std::optional<TransferVolume> volume;
    if (has_volume && is_of_another_program(*transfer)) volume = transfer_volume(read_volume_of(signal, read_again));
    TransferDocument read = read_transfer_function(
        *transfer, {.volume = volume ? &*volume : nullptr, .opacity = {}, .takes_isosurfaces = true}, warnings);
    ray.transfer = std::move(read.transfer);
    ray.isosurfaces = std::move(read.isosurfaces);
    if (!ray.isosurfaces.empty() && (kind == "marschner_lobb" || kind == "analytic"))
      transfer->refuse(
          fmt::format("isosurfaces with the signal {}", kind),
          "them with piecewise_polynomial, trilinear, tricubic or tetrahedra signals, whose crossings are certified,");
    if (read.is_of_another_program) ray.transfer_description = std::move(read.description);
  }
  ray.emission = read_emission(json);
  // RayIntegral refuses numbers that it cannot calculate with.
  if (ray.transfer) json.at("transfer_function").blame_for([&] { return RayIntegral(*ray.transfer, ray.emission); });
  const auto deformation = json.find("deformation");
  if (deformation && kind != "trilinear")
    deformation->refuse(fmt::format("a deformation of the signal {}", kind), "one of a trilinear signal");
  if (deformation && !ray.isosurfaces.empty())
    deformation->refuse("a deformation of isosurfaces", "one of what a transfer function without them shows");
  if (kind == "trilinear")
    read_trilinear(signal, ray, warnings);
  else if (kind == "tricubic")
    read_tricubic(signal, ray, warnings);
  else if (kind == "tetrahedra")
    read_tetrahedra(signal, ray, warnings);
  else if (kind == "marschner_lobb")
    read_marschner_lobb(signal, ray);
  else if (kind == "analytic")
    read_analytic(signal, ray);
  else
    read_piecewise_polynomial(signal, ray);
  std::visit([&signal](const auto& chain) { check_values(signal, chain); }, ray.signal);
  return ray;
}

void CaseReader::read_trilinear(const JsonReader& json, Case& result, std::vector<std::string>& warnings) {
  json.only({"kind", "volume", "repair", "nan", "time_step", "spacing", "border", "origin", "direction", "length"});
  const Ray ray = read_ray(json);
  const Border border = read_border(json);
  const TrilinearField field(read_volume_of(json, warnings), border);
  if (const auto deformation = result.json.find("deformation"))
    trace_deformed(json, *deformation, field, ray, result);
  else
    trace(json, field, ray, result, warnings);
}

void CaseReader::read_tricubic(const JsonReader& json, Case& result, std::vector<std::string>& warnings) {
  json.only({"kind", "volume", "repair", "nan", "time_step", "spacing", "border", "origin", "direction", "length",
             "kernel", "prefilter"});
  const Ray ray = read_ray(json);
  const Border border = read_border(json);
  const bool is_bspline = json.at("kernel").word({"bspline", "catmull_rom"}) == "bspline";
  const auto prefilter = json.find("prefilter");
  const bool is_prefiltered = prefilter && prefilter->boolean();
  if (is_prefiltered && !is_bspline) prefilter->refuse_value("false: catmull_rom passes through its voxels as it is;");
  const FieldKind kind = !is_bspline      ? FieldKind::catmull_rom
                         : is_prefiltered ? FieldKind::bspline_prefiltered
                                          : FieldKind::bspline;
  trace(json, TricubicField(read_volume_of(json, warnings), kind, border), ray, result, warnings);
}

void CaseReader::read_tetrahedra(const JsonReader& json, Case& result, std::vector<std::string>& warnings) {
  const bool is_split = json.find("volume").has_value();
  if (is_split)
    json.only({"kind", "volume", "split", "parity", "repair", "nan", "time_step", "spacing", "origin", "direction",
               "length"});
  else
    json.only({"kind", "mesh", "origin", "direction", "length"});
  const Ray ray = read_ray(json);
  Json which = Json::object();
  for (const auto& [name, value] : json.json().items())
    if (name != "origin" && name != "direction" && name != "length") which[name] = value;
  if (!mesh_.field || which != last_mesh_) {
    mesh_ = is_split ? read_split_volume(json, volumes_) : read_mesh_source(json.at("mesh"), volumes_);
    last_mesh_ = std::move(which);
    warnings.insert(warnings.end(), mesh_.warnings.begin(), mesh_.warnings.end());
  }
  result.mesh_ray = json.at("origin").blame_for([&] { return mesh_.field->trace(ray); });
  auto [chain, error] = result.mesh_ray->chain();
  if (result.transfer) {
    result.signal_error = std::move(error);
    result.precise_signal = result.mesh_ray->signal;
  }
  result.signal = std::move(chain);
}

const Grid& CaseReader::read_volume_of(const JsonReader& signal, std::vector<std::string>& warnings) {
  const JsonReader place = signal.at("volume");
  const FieldDocument field = read_volume_member(signal, false);
  std::string which;  // an inline grid is read again, which costs no more than telling whether it is another one
  if (std::holds_alternative<GeneratedField>(field)) which = place.json().dump();
  if (const auto* const file = std::get_if<VolumeFile>(&field))
    which = place.blame_for([&] { return find_volume_file(*file, volumes_); }).string() + reading_of(*file);
  if (const auto spacing = signal.find("spacing"))
    warnings.push_back(spacing->place() + ": warning: it changes nothing: the rays of a case are in voxels");
  if (!which.empty() && which == last_volume_) return grid_;
  SourcedVolume read = make_volume(field, volumes_);
  warnings.insert(warnings.end(), read.warnings.begin(), read.warnings.end());
  grid_ = std::move(read.grid);
  last_volume_ = std::move(which);
  return grid_;
}

Json evaluate(const Case& ray) {
  return std::visit(
      [&ray](const auto& signal) -> Json {
        std::optional<SurfaceHits> hits;
        if (!ray.isosurfaces.empty()) hits = hits_of(ray, signal);
        std::optional<Certified> truth;
        if (ray.transfer) truth = truth_of(ray, signal, hits ? &*hits : nullptr);
        Json schemes = Json::object();
        const bool has_gaps = ray.mesh_ray && ray.mesh_ray->parts.size() > 1;
        if (has_gaps || ray.deformed) {
          for (const std::string& scheme : ray.schemes)
            if (scheme != "reference") schemes[scheme] = refused(has_gaps ? why_no_gaps : why_no_deformation);
        } else if (hits) {
          schemes = surface_answers(ray, signal, *truth);
        } else if (names_a_scheme(ray)) {
          SchemeAnswers answer_of(ray, signal, truth ? &*truth : nullptr);
          for (const std::string& scheme : ray.schemes)
            if (scheme != "reference") schemes[scheme] = answer_of(scheme);
        }
        Json answer{{"length", signal.length()}};
        if (ray.border) answer["border"] = name_of(*ray.border);
        if (ray.mesh_ray) answer["parts"] = parts_json(*ray.mesh_ray);
        if (ray.deformed) answer["deformation"] = deformation_json(*ray.deformed);
        answer["reference"] = truth ? truth_json(*truth) : refused(why_no_integral);
        if (hits) add_hits(std::move(*hits), ray.mesh_ray, answer["reference"]);
        answer["schemes"] = std::move(schemes);
        if (!ray.transfer_description.is_null()) answer["transfer_function"] = ray.transfer_description;
        return answer;
      },
      ray.signal);
}

}  // namespace raytruth

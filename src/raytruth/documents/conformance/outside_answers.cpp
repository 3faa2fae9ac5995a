#include "raytruth/documents/conformance/outside_answers.hpp"

#include "raytruth/documents/case_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <variant>

namespace raytruth {

namespace {

using Json = nlohmann::ordered_json;

constexpr double usual_intervals = 64;  // of a ray whose samples are at no constant step
constexpr double most_intervals = 1e6;

/// The powers of t, from the piece's start on: binomial(n, k) times the k-th forward difference of the Bernstein
/// coefficients, over length^k.
template <int Degree>
std::vector<double> powers_of(const Piece<Degree>& piece) {
  auto differences = piece.polynomial.coefficients;
  std::vector<double> powers;
  double factor = 1;
  for (std::size_t k = 0; k <= Degree; ++k) {
    powers.push_back(factor * differences[0]);
    for (std::size_t i = 0; i + k < Degree; ++i) differences[i] = differences[i + 1] - differences[i];
    factor = factor * static_cast<double>(Degree - k) / static_cast<double>(k + 1) / piece.length;
  }
  return powers;
}

/// A case's ray as a vector.
ConformanceVector vector_of(const Case& ray) {
  if (!std::holds_alternative<std::monostate>(ray.formula))
    throw OutsideRefusal("programs are asked of polynomials, and this signal is another formula");
  ConformanceVector vector{.id = "ray",
                           .level = "case",
                           .is_slab = false,
                           .emission = ray.emission,
                           .breaks = {},
                           .coefficients = {},
                           .transfer = *ray.transfer,
                           .lists = {}};
  const JsonReader signal = ray.json.at("signal");
  if (const auto breaks = signal.find("breaks")) {
    vector.breaks = breaks->numbers();
    for (const JsonReader& piece : signal.at("coefficients").items()) vector.coefficients.push_back(piece.numbers());
    return vector;
  }
  std::visit(
      [&vector](const auto& chain) {
        for (const auto& piece : chain.pieces) {
          vector.breaks.push_back(static_cast<double>(piece.start));
          vector.coefficients.push_back(powers_of(piece));
        }
        vector.breaks.push_back(chain.length());
      },
      ray.signal);
  if (vector.coefficients.empty()) throw OutsideRefusal("the ray is empty");
  return vector;
}

std::int64_t intervals_of(const Case& ray, const ConformanceVector& vector) {
  if (!ray.sampling || !ray.sampling->step) return static_cast<std::int64_t>(usual_intervals);
  const double count = std::ceil(vector.breaks.back() / *ray.sampling->step);
  return static_cast<std::int64_t>(std::clamp(count, 1.0, most_intervals));
}

Json answer_of(const OutsideProgram& program, const Case& ray, const Json& reference) {
  const ConformanceVector vector = vector_of(ray);
  const std::int64_t intervals = intervals_of(ray, vector);
  const OutsideAnswers found = outside_answers(program, {vector}, intervals);
  if (found.answers.empty()) throw OutsideRefusal("it answers nothing");
  const Answer& answer = found.answers.begin()->second;
  if (!answer.color.isFinite().all() || !std::isfinite(answer.opacity))
    throw OutsideRefusal("its answer is not finite");
  Json json{{"color", color_json(answer.color)}, {"opacity", answer.opacity}};
  if (reference.contains("color")) {
    const auto color = reference.at("color").get<std::vector<double>>();
    json["color_error"] = color_json(answer.color - Vector3<double>(color[0], color[1], color[2]));
    json["opacity_error"] = answer.opacity - reference.at("opacity").get<double>();
  }
  json["intervals"] = intervals;
  if (found.version) json["version"] = *found.version;
  return json;
}

}  // namespace

OutsideAnswers outside_answers(const OutsideProgram& program, const std::vector<ConformanceVector>& vectors,
                               std::int64_t intervals) {
  Json questions = Json::array();
  std::set<std::string> ids;
  for (const ConformanceVector& vector : vectors) {
    questions.push_back(question_json(vector));
    questions.back()["samples"] = samples_of(vector, intervals);
    ids.insert(vector.id);
  }
  const OutsideAnswer answer =
      ask(program, Json{{"raytruth", vector_form_names.back()}, {"vectors", std::move(questions)}}.dump());
  std::vector<std::string> warnings;
  OutsideAnswers result{.answers = {}, .version = answer.version};
  try {
    result.answers = answers_in(answer.bytes, "its answer", warnings);
  } catch (const InputError& error) {
    throw OutsideRefusal(error.what());
  }
  for (const auto& [id, found] : result.answers)
    if (!ids.contains(id))
      throw OutsideRefusal(fmt::format("its answer: found the id '{}'; those asked are allowed", id));
  return result;
}

void add_outside_answers(const Case& ray, bool runs_programs, Json& answer) {
  for (const OutsideProgram& program : ray.programs) {
    Json& its_answer = answer["schemes"][program.name];
    try {
      if (!runs_programs) throw OutsideRefusal(std::string(why_not_run));
      if (!ray.transfer) throw OutsideRefusal("the case states no transfer function");
      if (!ray.isosurfaces.empty()) throw OutsideRefusal("vectors, which it reads, have no isosurfaces");
      its_answer = answer_of(program, ray, answer.at("reference"));
    } catch (const OutsideRefusal& refusal) {
      its_answer = refused(refusal.what());
    }
  }
}

}  // namespace raytruth

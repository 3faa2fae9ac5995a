#include "python/integrals.hpp"

#include "python/threads.hpp"
#include "python/transfer_function.hpp"
#include "python/volume.hpp"
#include "raytruth/core/error.hpp"
#include "raytruth/core/named.hpp"
#include "raytruth/reference/ray_truth.hpp"
#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/samples.hpp"
#include "raytruth/signals/piecewise_polynomial.hpp"
#include "raytruth/signals/ray_field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace raytruth::python {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

namespace {

/// A scalar along a ray, and how far its chain of polynomials is from it.
struct Signal {
  std::variant<Chain<3>, Chain<largest_degree>> chain;
  SignalError error;
  std::variant<PreciseChain<3>, PreciseChain<largest_degree>> precise;

  [[nodiscard]] double length() const {
    return std::visit([](const auto& signal) { return signal.length(); }, chain);
  }
};

/// How a field between voxels is asked for.
struct FieldChoice {
  FieldKind kind;
  Border border;
};

/// Where the word stands in a list of names. Throws InputError where it does not.
template <std::size_t count>
std::size_t place_of(const std::string& word, const std::array<std::string_view, count>& names, std::string_view what) {
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end())
    throw InputError(fmt::format("{}: found {}; {} is allowed", what, word, fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

FieldChoice field_of(const std::string& interpolation, const std::string& border) {
  return {static_cast<FieldKind>(place_of(interpolation, field_kind_names, "interpolation")),
          static_cast<Border>(place_of(border, border_names, "border"))};
}

/// What is asked of a signal: the truth, or a scheme with samples at a step, or at cells' borders and midpoints.
struct Question {
  const IntegralScheme* scheme = nullptr;  ///< null: the certified integral
  std::optional<double> step;
  Emission emission = Emission::associated;
};

Question question_of(const std::string& scheme, std::optional<double> step, const std::string& emission) {
  Question question{.scheme = nullptr, .step = step, .emission = emission_of(emission)};
  if (step && !(*step > 0 && std::isfinite(*step)))
    throw InputError(fmt::format("step: found {}; a finite number > 0, or None for cells, is allowed", *step));
  if (scheme == "reference") {
    if (step) throw InputError("step: found one with the reference, which takes no samples; none is allowed");
    return question;
  }
  question.scheme = find_named(catalogue::integral_schemes(), scheme);
  if (question.scheme == nullptr)
    throw InputError(fmt::format("scheme: found {}; reference, or a name of raytruth.schemes(), is allowed", scheme));
  return question;
}

/// What came out for a ray.
struct Integral {
  Vector3<double> color = Vector3<double>::Constant(0);
  double opacity = 0;
  std::optional<double> radius;   ///< of the certified integral
  std::optional<bool> converged;  ///< likewise
  std::int64_t fetches = 0;       ///< of a scheme, as the two below
  std::int64_t lookups = 0;
  std::int64_t composites = 0;
};

Integral of_truth(const Certified& truth) {
  return {.color = truth.color,
          .opacity = truth.opacity,
          .radius = truth.radius,
          .converged = truth.status == Status::converged};
}

template <int Degree>
Integral by_scheme(const TransferFunction& transfer, const Question& question, const Chain<Degree>& signal,
                   Samples<double>& samples) {
  take_samples(signal, question.step, samples);
  const Outcome<> outcome = transfer.schemes(question.emission)(*question.scheme, signal, samples);
  if (!outcome.refusal.empty()) throw InputError(fmt::format("scheme {}: {}", question.scheme->name, outcome.refusal));
  return {.color = outcome.color,
          .opacity = outcome.opacity,
          .radius = {},
          .converged = {},
          .fetches = outcome.fetches,
          .lookups = outcome.lookups,
          .composites = outcome.composites};
}

Integral integral(const Signal& signal, const TransferFunction& transfer, const Question& question) {
  return std::visit(
      [&]<int Degree>(const Chain<Degree>& chain) {
        if (question.scheme == nullptr)
          return of_truth(ray_truth(
              transfer.reference(question.emission), chain,
              signal.error, [&]() -> const auto& { return std::get<PreciseChain<Degree>>(signal.precise); }));
        Samples<double> samples;
        return by_scheme(transfer, question, chain, samples);
      },
      signal.chain);
}

Signal polynomial(const std::vector<double>& breaks, const std::vector<std::vector<double>>& coefficients) {
  auto chain = piecewise_polynomial(breaks, coefficients);
  SignalError error = piecewise_polynomial_error(breaks, coefficients, chain);
  return {std::move(chain), std::move(error), precise_piecewise_polynomial(breaks, coefficients)};
}

/// The rays of a call: as many as the longest list, a list of one being that of all.
class RayList {
 public:
  RayList(const Numbers& origins, const Numbers& directions, const std::optional<Numbers>& lengths)
      : origins_(places(origins, "origins")), directions_(places(directions, "directions")) {
    if (lengths) {
      if (lengths->ndim() > 1)
        throw InputError("lengths: found more than one axis; a number, or one of each ray, is allowed");
      lengths_ = *lengths;
    }
    for (const py::ssize_t count : {origins_.shape(0), directions_.shape(0), lengths_ ? lengths_->size() : 1})
      if (count_ == 1) count_ = count;
    check("origins", origins_.shape(0));
    check("directions", directions_.shape(0));
    if (lengths_) check("lengths", lengths_->size());
  }

  [[nodiscard]] py::ssize_t count() const { return count_; }

  /// Throws InputError for a length that is negative or NaN.
  [[nodiscard]] Ray operator[](py::ssize_t i) const {
    Ray ray{.origin = place(origins_, i), .direction = place(directions_, i)};
    if (lengths_) ray.length = lengths_->data()[lengths_->size() == 1 ? 0 : i];
    if (!(ray.length >= 0)) throw InputError(fmt::format("length {}; a number >= 0 is allowed", ray.length));
    return ray;
  }

 private:
  static Numbers places(const Numbers& given, std::string_view name) {
    if (given.ndim() == 1 && given.shape(0) == 3) return Numbers(given.attr("reshape")(1, 3));
    if (given.ndim() == 2 && given.shape(1) == 3) return given;
    throw InputError(
        fmt::format("{}: found another shape than (n, 3); x, y, z for each ray, or for all, are allowed", name));
  }
  static std::array<double, 3> place(const Numbers& list, py::ssize_t i) {
    const double* const numbers = list.data() + 3 * (list.shape(0) == 1 ? 0 : i);
    return {numbers[0], numbers[1], numbers[2]};
  }
  void check(std::string_view name, py::ssize_t count) const {
    if (count != count_ && count != 1)
      throw InputError(fmt::format("{}: found {}; {}, or one for all, are allowed", name, count, count_));
  }

  Numbers origins_;
  Numbers directions_;
  std::optional<Numbers> lengths_;
  py::ssize_t count_ = 1;
};

/// What came out for many rays, as arrays.
struct Rays {
  explicit Rays(py::ssize_t count)
      : color({count, py::ssize_t{3}}),
        opacity(count),
        length(count),
        radius(count),
        converged(count),
        fetches(count),
        lookups(count),
        composites(count) {}

  py::array_t<double> color;
  py::array_t<double> opacity;
  py::array_t<double> length;
  py::array_t<double> radius;
  py::array_t<bool> converged;
  py::array_t<std::int64_t> fetches;
  py::array_t<std::int64_t> lookups;
  py::array_t<std::int64_t> composites;
};

/// Where the numbers of the arrays go, for threads that must not touch Python's objects.
struct RayPlaces {
  explicit RayPlaces(Rays& rays)
      : color(rays.color.mutable_data()),
        opacity(rays.opacity.mutable_data()),
        length(rays.length.mutable_data()),
        radius(rays.radius.mutable_data()),
        converged(rays.converged.mutable_data()),
        fetches(rays.fetches.mutable_data()),
        lookups(rays.lookups.mutable_data()),
        composites(rays.composites.mutable_data()) {}

  void put(py::ssize_t i, const Integral& found, double ray_length) const {
    std::copy_n(found.color.data(), 3, color + 3 * i);
    opacity[i] = found.opacity;
    length[i] = ray_length;
    radius[i] = found.radius.value_or(std::numeric_limits<double>::quiet_NaN());
    converged[i] = found.converged.value_or(false);
    fetches[i] = found.fetches;
    lookups[i] = found.lookups;
    composites[i] = found.composites;
  }

  double* color;
  double* opacity;
  double* length;
  double* radius;
  bool* converged;
  std::int64_t* fetches;
  std::int64_t* lookups;
  std::int64_t* composites;
};

/// The first of the rays that was refused, whichever thread met one first.
class FirstRefusal {
 public:
  void add(py::ssize_t i, const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (ray_ >= 0 && ray_ < i) return;
    ray_ = i;
    why_ = why;
  }
  void tell() const {
    if (ray_ >= 0) throw InputError(fmt::format("ray {}: found {}", ray_, why_));
  }

 private:
  std::mutex mutex_;
  py::ssize_t ray_ = -1;
  std::string why_;
};

template <class Field>
void integrate_rays(const Field& field, const TransferFunction& transfer, const Question& question, const RayList& list,
                    const RayPlaces& places) {
  constexpr py::ssize_t rays_between_signals = 8192;  // Ctrl-C is heard after so many
  constexpr py::ssize_t grain = 16;
  FirstRefusal refusal;
  for (py::ssize_t begin = 0; begin < list.count(); begin += rays_between_signals) {
    const auto end = std::min(list.count(), begin + rays_between_signals);
    {
      const py::gil_scoped_release without_lock;
      tbb::parallel_for(tbb::blocked_range<py::ssize_t>(begin, end, grain), [&](const auto& range) {
        Chain<Field::degree> chain;
        Samples<double> samples;
        for (py::ssize_t i = range.begin(); i < range.end(); ++i) try {
            const Ray ray = list[i];
            field.trace(ray, chain);
            const Integral found =
                question.scheme == nullptr
                    ? of_truth(ray_truth(transfer.reference(question.emission), chain, field.error(ray, chain),
                                         [&] { return field.trace_precisely(ray); }))
                    : by_scheme(transfer, question, chain, samples);
            places.put(i, found, chain.length());
          } catch (const InputError& error) {
            refusal.add(i, error.what());
          }
      });
    }
    refusal.tell();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

Rays rays(const Volume& volume, py::handle transfer_function, const Numbers& origins, const Numbers& directions,
          const std::optional<Numbers>& lengths, const std::string& scheme, std::optional<double> step,
          const std::string& interpolation, const std::string& border, const std::string& emission, int threads) {
  const Threads limit(threads);
  const Question question = question_of(scheme, step, emission);
  const TransferFunction transfer = transfer_function_of(transfer_function);
  const FieldChoice choice = field_of(interpolation, border);
  const RayList list(origins, directions, lengths);
  Rays found(list.count());
  const RayField field = [&] {
    const py::gil_scoped_release without_lock;
    return ray_field(*volume.grid(), choice.kind, choice.border);
  }();
  const RayPlaces places(found);
  std::visit([&](const auto& traced) { integrate_rays(traced, transfer, question, list, places); }, field);
  return found;
}

/// The signal along one ray.
Signal signal_along(const Volume& volume, const std::array<double, 3>& origin, const std::array<double, 3>& direction,
                    std::optional<double> length, const std::string& interpolation, const std::string& border) {
  const FieldChoice choice = field_of(interpolation, border);
  Ray ray{.origin = origin, .direction = direction};
  if (length) ray.length = *length;
  if (!(ray.length >= 0)) throw InputError(fmt::format("length: found {}; a number >= 0 is allowed", ray.length));
  return std::visit(
      [&]<class Field>(const Field& field) {
        Chain<Field::degree> chain;
        field.trace(ray, chain);
        SignalError error = field.error(ray, chain);
        return Signal{std::move(chain), std::move(error), field.trace_precisely(ray)};
      },
      ray_field(*volume.grid(), choice.kind, choice.border));
}

Numbers values_at(const Signal& signal, const Numbers& t) {
  Numbers values(std::vector<py::ssize_t>(t.shape(), t.shape() + t.ndim()));
  std::visit(
      [&](const auto& chain) {
        if (chain.pieces.empty()) throw InputError("t: found a signal of length 0; one of some length is allowed");
        for (py::ssize_t i = 0; i < t.size(); ++i) {
          const double at = t.data()[i];
          if (!(at >= 0 && at <= chain.length()))
            throw InputError(fmt::format("t: found {}; numbers from 0 to {} are allowed", at, chain.length()));
          const auto& part = chain.pieces[chain.index_at(at)];
          values.mutable_data()[i] = part.polynomial.value(part.local(at));
        }
      },
      signal.chain);
  return values;
}

/// The certified integral of a scalar that is linear from `front` to `back`.
Integral slab(py::handle transfer_function, double front, double back, double length, const std::string& emission) {
  if (!(length > 0 && std::isfinite(length)))
    throw InputError(fmt::format("length: found {}; a finite number > 0 is allowed", length));
  if (!std::isfinite(front) || !std::isfinite(back))
    throw InputError(fmt::format("scalars: found {} and {}; finite numbers are allowed", front, back));
  const TransferFunction transfer = transfer_function_of(transfer_function);
  Chain<3> chain;
  const double third = (back - front) / 3;
  chain.pieces.push_back({0.0, length, {{front, front + third, back - third, back}}});
  chain.end = length;
  // What rounding moves the two points between, which would be exact for a line.
  SignalError error{.of_pieces = {0x1p-51 * (std::abs(front) + std::abs(back))}, .exact_ends = {true}};
  if (front == back) error = {};
  return of_truth(transfer.reference(emission_of(emission))(chain, error));
}

std::string text_of(const Integral& found) {
  std::string text = fmt::format("<raytruth.Integral: color ({}, {}, {}), opacity {}", found.color[0], found.color[1],
                                 found.color[2], found.opacity);
  if (found.radius) text += fmt::format(", radius {}", *found.radius);
  return text + ">";
}

}  // namespace

void add_integrals(py::module_& module) {
  py::class_<Signal>(module, "Signal", "A scalar along a ray, from t = 0 to its length: polynomials up to degree 9.")
      .def(py::init(&polynomial), py::arg("breaks"), py::arg("coefficients"),
           "Piece i is sum_k coefficients[i][k] (t - breaks[i])^k on [breaks[i], breaks[i + 1]].")
      .def_property_readonly("length", &Signal::length, "Where t ends.")
      .def("at", &values_at, py::arg("t"), "The scalar at each t.");

  py::class_<Integral>(module, "Integral", "Colour and opacity of a ray.")
      .def_property_readonly("color",
                             [](const Integral& found) {
                               return std::array{found.color[0], found.color[1], found.color[2]};
                             })
      .def_readonly("opacity", &Integral::opacity)
      .def_readonly("radius", &Integral::radius)
      .def_readonly("converged", &Integral::converged)
      .def_readonly("fetches", &Integral::fetches)
      .def_readonly("lookups", &Integral::lookups)
      .def_readonly("composites", &Integral::composites)
      .def("__repr__", &text_of);

  py::class_<Rays>(module, "Rays", "Colours and opacities of many rays, as arrays.")
      .def_readonly("color", &Rays::color)
      .def_readonly("opacity", &Rays::opacity)
      .def_readonly("length", &Rays::length)
      .def_readonly("radius", &Rays::radius)
      .def_readonly("converged", &Rays::converged)
      .def_readonly("fetches", &Rays::fetches)
      .def_readonly("lookups", &Rays::lookups)
      .def_readonly("composites", &Rays::composites)
      .def("__len__", [](const Rays& found) { return found.opacity.size(); });

  module.def(
      "integral",
      [](const Signal& signal, py::handle transfer_function, const std::string& scheme, std::optional<double> step,
         const std::string& emission) {
        const Question question = question_of(scheme, step, emission);
        const TransferFunction transfer = transfer_function_of(transfer_function);
        const py::gil_scoped_release without_lock;
        return integral(signal, transfer, question);
      },
      py::arg("signal"), py::arg("transfer_function"), py::kw_only(), py::arg("scheme") = "reference",
      py::arg("step") = py::none(), py::arg("emission") = "associated",
      "The volume rendering integral of a signal, certified or by a scheme.");
  module.def("rays", &rays, py::arg("volume"), py::arg("transfer_function"), py::arg("origins"), py::arg("directions"),
             py::kw_only(), py::arg("lengths") = py::none(), py::arg("scheme") = "reference",
             py::arg("step") = py::none(), py::arg("interpolation") = "trilinear", py::arg("border") = "half_voxel",
             py::arg("emission") = "associated", py::arg("threads") = 0,
             "The integrals of many rays through a volume, in voxel coordinates.");
  module.def("signal_along", &signal_along, py::arg("volume"), py::arg("origin"), py::arg("direction"), py::kw_only(),
             py::arg("length") = py::none(), py::arg("interpolation") = "trilinear", py::arg("border") = "half_voxel",
             "The scalar along a ray through a volume, in voxel coordinates.");
  module.def("slab", &slab, py::arg("transfer_function"), py::arg("front"), py::arg("back"), py::arg("length") = 1.0,
             py::kw_only(), py::arg("emission") = "associated",
             "The certified integral of a slab in which the scalar is linear.");
}

}  // namespace raytruth::python

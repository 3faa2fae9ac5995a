#pragma once

#include "raytruth/reference/ray_integral.hpp"
#include "raytruth/schemes/scheme_integral.hpp"
#include "raytruth/transfer/emission.hpp"
#include "raytruth/transfer/piecewise_linear.hpp"

#include <pybind11/pybind11.h>
#include <tbb/enumerable_thread_specific.h>
#include <nlohmann/json.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace raytruth::python {

/// A transfer function that Python holds, with what integrates under it: of every thread its own, made when it is first
/// needed and kept, so that the next ray allocates nothing.
class TransferFunction {
 public:
  /// Throws InputError for numbers that RayIntegral refuses.
  TransferFunction(PiecewiseLinear transfer, nlohmann::ordered_json description);

  [[nodiscard]] const PiecewiseLinear& transfer() const { return integrals_->transfer; }
  [[nodiscard]] const nlohmann::ordered_json& description() const { return description_; }

  [[nodiscard]] RayIntegral& reference(Emission emission) const;
  [[nodiscard]] SchemeIntegral& schemes(Emission emission) const;

 private:
  template <class Integral>
  using PerThread = tbb::enumerable_thread_specific<Integral>;

  struct Integrals {
    explicit Integrals(const PiecewiseLinear& function);

    PiecewiseLinear transfer;
    std::array<PerThread<RayIntegral>, 2> reference;  ///< of every Emission
    std::array<PerThread<SchemeIntegral>, 2> schemes;
  };

  std::shared_ptr<Integrals> integrals_;
  nlohmann::ordered_json description_;
};

/// "associated" or "plain". Throws InputError.
Emission emission_of(const std::string& name);

/// The transfer function of a TransferFunction, or of what one is made of. Throws InputError.
TransferFunction transfer_function_of(pybind11::handle object);

void add_transfer_function(pybind11::module_& module);

}  // namespace raytruth::python

#pragma once

#include "experiments/runner.hpp"
#include "program/progress_bar.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace raytruth {

/// A bar of what is done.
class BarObserver final : public RunObserver {
 public:
  void begin(std::size_t units) override;
  void show(std::string_view unit) override;
  void advance(bool is_worked) override;
  void warn(std::string_view line) override;

 private:
  std::optional<ProgressBar> bar_;
};

/// Tells what the publications state beside what was measured, whether the bounds hold, and what was made; false where
/// a bound does not. `file` is where the result is; empty: on standard output.
bool report(const Experiment& experiment, const std::string& profile, const nlohmann::ordered_json& result,
            const std::filesystem::path& file);

}  // namespace raytruth

#pragma once

#include "experiments/row.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace raytruth {

/// The finished parts of a run that may be interrupted, in a hidden file beside the result: a line that says which run
/// it is, then one for every part. Removed when the result is there.
class Journal {
 public:
  /// Does nothing.
  Journal() = default;

  /// Begins a journal for `result` that belongs to `run` (experiment and build), or goes on with the one that an
  /// interrupted run left behind, if `resume` and it belongs to the same. Throws OutputError where it cannot be
  /// written.
  Journal(const std::filesystem::path& result, const nlohmann::ordered_json& run, bool resume);

  /// The part of this name that was finished before; null where there is none.
  [[nodiscard]] const nlohmann::ordered_json* find(const std::string& name) const;
  [[nodiscard]] bool is_empty() const;

  void add(const std::string& name, const nlohmann::ordered_json& part);

  /// The run is done.
  void remove();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::filesystem::path file_;
  std::map<std::string, std::shared_ptr<const nlohmann::ordered_json>> parts_;
  std::unique_ptr<std::FILE, Close> stream_;
};

}  // namespace raytruth

#include "experiments/output.hpp"
#include "experiments/result.hpp"
#include "program/commands.hpp"
#include "raytruth/documents/conformance/vectors.hpp"

#include <nlohmann/json.hpp>

namespace raytruth {

int write_vectors(const VectorsOptions& options) {
  const std::string text = result_text(vectors_json(static_cast<std::uint64_t>(options.seed)));
  if (options.file)
    write_whole(*options.file, text);
  else
    print(text);
  return 0;
}

}  // namespace raytruth

#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace raytruth {

/// The kinds of which there are lists: "schemes", "experiments", "volumes" and so on.
const std::vector<std::string>& listed_kinds();

/// What there is of a kind, by name, each with a `summary` and what else is known of it. `folders` are those in which
/// volumes are looked for.
nlohmann::ordered_json list_of(const std::string& kind, const std::vector<std::filesystem::path>& folders);

}  // namespace raytruth

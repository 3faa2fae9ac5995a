#pragma once

#include "raytruth/tables/table_builder.hpp"

#include <vector>

namespace raytruth::catalogue {

/// From transfer functions to tables of pre-integrated slabs, in the order in which tables and plots show them.
const std::vector<TableBuilder>& table_builders();

}  // namespace raytruth::catalogue

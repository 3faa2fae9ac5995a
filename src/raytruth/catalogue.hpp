#pragma once

#include "raytruth/schemes/integral_schemes.hpp"
#include "raytruth/schemes/sampling.hpp"
#include "raytruth/schemes/scheme_list.hpp"
#include "raytruth/schemes/surface_method.hpp"
#include "raytruth/shading/highlight.hpp"
#include "raytruth/shading/normal_curve.hpp"
#include "raytruth/shading/slab_shading.hpp"
#include "raytruth/signals/fields/generated_fields.hpp"
#include "raytruth/signals/signal_kinds.hpp"
#include "raytruth/tables/partial_pre_integration.hpp"
#include "raytruth/tables/quadratic_gray_table.hpp"
#include "raytruth/tables/second_order.hpp"
#include "raytruth/tables/table_builders.hpp"
#include "raytruth/transfer/study_transfers.hpp"
#include "raytruth/volume/gradient.hpp"

/// The table of contents: the list of every kind of ingredient, each kept by the folder that holds the ingredients, in
/// the order in which tables and plots show them. src/README.md says which files a new ingredient needs.
namespace raytruth::catalogue {}

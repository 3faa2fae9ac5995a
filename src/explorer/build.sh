#!/usr/bin/env bash
# Compiles the explorer's engine for browsers: build.sh FOLDER [JOBS] leaves FOLDER/engine.js and FOLDER/engine.wasm.
# It needs Debian's package emscripten (3.1.6), and of others only headers: those that the library is built with.
set -euo pipefail

folder=$(mkdir -p "$1" && cd "$1" && pwd)
jobs=${2:-$(nproc)}
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
command -v em++ >/dev/null || { echo "build.sh: em++ is missing: the package emscripten has it" >&2; exit 3; }
# Its node modules stand where only Debian's own node looks.
export NODE_PATH=${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs

functions=$(grep -o 'explorer_[a-z_]*(' "$top/src/explorer/engine.hpp" | tr -d '(' | sed 's/^/_/' | paste -sd,)

# The machine's other headers must stay out of sight: they are of another C library.
mkdir -p "$folder/include" "$folder/objects"
for headers in boost fmt Random123 eigen3/Eigen; do
  ln -sfn "/usr/include/$headers" "$folder/include/$(basename "$headers")"
done

library=(
  kernels/gauss_legendre kernels/depth_table kernels/kernels kernels/version
  reference/knot_cut reference/linear_interval reference/piece_integral reference/ray_integral reference/units
  schemes/cell_adaptive schemes/integral_schemes schemes/quadratic_gray schemes/quadratic_gray_printed schemes/scheme_integral
  schemes/radius_axis schemes/slab_integrals
  signals/analytic signals/cell_walk signals/marschner_lobb signals/piecewise_polynomial signals/tracing_error signals/trilinear
  transfer/piecewise_linear
)
sources=("$top/src/explorer/engine.cpp" "$top/src/explorer/stand_ins/exact_cut.cpp")
for source in "${library[@]}"; do
  sources+=("$top/src/raytruth/$source.cpp")
done

# Products and sums are never contracted, as everywhere.
{
  cat <<NINJA
top = $top
flags = -O2 -msimd128 -fexceptions
rule compile
  command = em++ -std=c++20 \$flags -ffp-contract=off -DFMT_HEADER_ONLY -DNDEBUG -include \$top/src/explorer/stand_ins/bit_cast.hpp -I \$top/src/explorer/stand_ins -I \$top/src -isystem include -MD -MF \$out.d -c \$in -o \$out
  description = compiling \$in
  depfile = \$out.d
  deps = gcc
rule link
  command = em++ \$flags -sMODULARIZE=1 -sEXPORT_NAME=make_explorer -sENVIRONMENT=web,node -sALLOW_MEMORY_GROWTH=1 -sFILESYSTEM=0 -sINCOMING_MODULE_JS_API=wasmBinary -sEXPORTED_FUNCTIONS=_malloc,_free,$functions -sEXPORTED_RUNTIME_METHODS=UTF8ToString,stringToUTF8,lengthBytesUTF8 \$in -o \$out
NINJA
  objects=()
  for source in "${sources[@]}"; do
    object=objects/$(basename "${source%.cpp}").o
    objects+=("$object")
    echo "build $object: compile $source"
  done
  echo "build engine.js: link ${objects[*]}"
} >"$folder/build.ninja"
ninja -C "$folder" -j "$jobs" engine.js >&2

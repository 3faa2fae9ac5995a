# What experiments/run and tests/run share: the packages they need, and building. They source it, with `top` set to the
# folder of the repository.
# shellcheck shell=bash disable=SC2034,SC2154

# The one list of packages, by their names in Debian 12.
packages_to_build=(g++ cmake ninja-build ccache git libboost-dev libcli11-dev libegl-dev libeigen3-dev
  libflint-arb-dev libfmt-dev libnifti-dev libosmesa6-dev libpng-dev libpugixml-dev librandom123-dev libssl-dev
  libtbb-dev libteem-dev nlohmann-json3-dev zlib1g-dev)
packages_to_experiment=(python3-matplotlib mricron-data)
packages_to_test=(libbenchmark-dev libgl1-mesa-dri libgsl-dev libgtest-dev glslang-tools python3-jsonschema python3-skimage)
# The Python module: where they are missing it is left out, with a message.
packages_of_python=(libpython3-dev pybind11-dev python3-numpy)
# The target `explorer`, which makes plots/explorer.html anew. Nothing here installs them: they take 1 GB.
packages_to_explore=(emscripten ninja-build nodejs)
packages_to_tidy=(clang-tidy-16)
# Engines that start shards, by experiments/launch. Nothing here installs them: tests of those that are absent are skipped.
packages_to_launch=(munge openmpi-bin parallel slurm-wlm)

# packages_of_peers NAME: what another renderer needs; only experiments/peers/run --install installs them.
packages_of_peers() {
  case $1 in
    vtk) echo python3-vtk9 xvfb xauth ;;
    miter) echo teem-apps python3-numpy ;;
    vtkjs) echo chromium nodejs python3-numpy ;;
    povray) echo povray ;;
  esac
}

say() { printf '%s\n' "$*" >&2; }

# fail STATUS MESSAGE
fail() {
  say "$2"
  exit "$1"
}

# install_packages PACKAGE...: those that are missing, and only those; asks nothing
install_packages() {
  if ! { command -v apt-get && command -v dpkg-query; } >/dev/null; then
    say "This is not Debian, so nothing is installed. Expected, by their names in Debian 12: $*"
    local tool
    for tool in cmake ninja g++; do
      command -v "$tool" >/dev/null || fail 3 "$tool is missing"
    done
    return
  fi

  local installed package missing=()
  # A line per package that dpkg knows; its exit status only says that it does not know them all.
  installed=$(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null) || true
  for package in "$@"; do
    grep --quiet --line-regexp --fixed-strings "installed $package" <<<"$installed" || missing+=("$package")
  done
  ((${#missing[@]} > 0)) || return 0

  local get=(env DEBIAN_FRONTEND=noninteractive apt-get -y -o DPkg::Lock::Timeout=300)
  if ((EUID != 0)); then
    get=(sudo --non-interactive "${get[@]}")
    sudo --non-interactive true 2>/dev/null ||
      fail 3 "packages are missing and sudo would ask; as root: apt-get install ${missing[*]}"
  fi
  say "Installing ${missing[*]}"
  { "${get[@]}" update && "${get[@]}" install --no-install-recommends "${missing[@]}"; } >&2 ||
    fail 3 "could not install ${missing[*]}"
}

# build PRESET JOBS [CMAKE ARGUMENT...]: configures and builds everything into build/PRESET
build() {
  local preset=$1 jobs=$2
  shift 2
  export CCACHE_SLOPPINESS=pch_defines,time_macros # or ccache passes over what is compiled with a precompiled header
  cmake -S "$top" --preset "$preset" "$@" >&2
  local ninja_options=()
  if [[ $preset == tidy ]]; then
    ninja_options=(-- -k 0) # all findings at once
  fi
  cmake --build "$top/build/$preset" --parallel "$jobs" "${ninja_options[@]}" >&2
}

# check_jobs TEXT: the N of -j N
check_jobs() {
  [[ $1 =~ ^[1-9][0-9]{0,3}$ ]] || fail 2 "-j: found '$1', allowed is a number from 1 to 9999"
}

#!/usr/bin/env bash
# Runs the tests of kernels, limits and faults on the other software adapters: OpenGL (llvmpipe over EGL) and
# SwiftShader, which has 10 storage buffers and 256 invocations per workgroup; and the tests of scenes, on the first
# adapter, with the kernels for GPUs. Prints the number of tests of each run.
set -euo pipefail
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
source "$root/harness/environment.sh"

harness/setup.sh --adapters
target=${CARGO_TARGET_DIR:-target}
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# Each line: a test program, and modules or names of its tests.
filters=(
    "gpu lost_device:: memory:: timer::"
    "lattice divergence_guard::s kernels:: limits:: refusals::"
    "psm combine_solids:: faces:: null_model:: reduce:: tile_search:: twin_step:: voxelise:: wall_law::"
    "sph mueller:: refusals:: step::"
    "rock broadphase::"
    "coupling faults::"
    "check more_cells_than_the_device_holds"
    "run interrupted::"
    "records cases::kernels"
)

# run_tests PROGRAM NAME...: runs the tests of the program whose names contain one of the names. Uses --workspace, so that
# nothing is recompiled with fewer features.
run_tests() {
    local program=$1
    shift
    if cargo nextest --version >/dev/null 2>&1; then
        cargo nextest run --workspace --test "$program" -- "$@"
    else
        cargo test --workspace --test "$program" -- "$@"
    fi
}

# run_filters WHERE FILTER...: runs the tests of the filters in the current environment.
run_filters() {
    local where=$1 filter ran total=0 start=$SECONDS
    shift
    for filter in "$@"; do
        # shellcheck disable=SC2086 # a filter is several words
        run_tests $filter >"$log" 2>&1 || { cat "$log" >&2; return 1; }
        ran=$(sed -nE 's/^ +Summary .* ([0-9]+) tests? run:.*/\1/p; s/^test result: ok\. ([0-9]+) passed.*/\1/p' "$log")
        if [ "${ran:-0}" -eq 0 ]; then
            echo "no test on $where is called: $filter" >&2
            return 1
        fi
        total=$((total + ran))
    done
    echo "$where: $total tests of kernels, limits and faults passed in $((SECONDS - start)) s"
}

# on ADAPTER DRIVER: runs all filters on the adapter of this name, with only this Vulkan driver.
on() {
    RIPRAP_ADAPTER=$1 VK_DRIVER_FILES=$2 run_filters "$1" "${filters[@]}"
}

RIPRAP_KERNELS=gpu run_filters "kernels of GPUs" "coupling" "simulation" "run coupled:: deformable:: lattice:: sph::"
on "(gl," /dev/null
on swiftshader "$(realpath "$target")/swiftshader/vk_swiftshader_icd.json"

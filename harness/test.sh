#!/usr/bin/env bash
# Runs all tests, the examples of the documentation, and the example programs that embed the library. On Linux the
# tests of kernels, limits and faults also run on all software adapters. Arguments go to the test runner; with arguments
# only the first adapter is tested.
set -euo pipefail
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
source "$root/harness/environment.sh"

# Tests run in parallel: with many threads each, they would wait for each other.
export RAYON_NUM_THREADS="${RAYON_NUM_THREADS:-2}"

harness/setup.sh --tests
harness/python.sh
if cargo nextest --version >/dev/null 2>&1; then
    cargo nextest run --workspace "$@"
else
    cargo test --workspace "$@"
fi
cargo test --quiet --workspace --doc
# Both test runners have built the examples.
for example in embed own_kernel dry_blocks own_broadphase own_bodies own_water; do
    "${CARGO_TARGET_DIR:-target}/debug/examples/$example"
done
if [ $# -eq 0 ] && [ "$(uname -s)" = Linux ]; then harness/test_adapters.sh; fi

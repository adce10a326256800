#!/usr/bin/env bash
# Runs every test: units, kernels, flows, files, the documentation's examples, and those that embed the library;
# on Linux those of kernels, limits and faults on all software adapters, too. Arguments go to the test runner, for
# the first adapter alone.
set -euo pipefail
root=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
source "$root/harness/environment.sh"

# Tests run side by side: many threads of each would wait for each other.
export RAYON_NUM_THREADS="${RAYON_NUM_THREADS:-2}"

harness/setup.sh --tests
harness/python.sh
if cargo nextest --version >/dev/null 2>&1; then
    cargo nextest run --workspace "$@"
else
    cargo test --workspace "$@"
fi
cargo test --quiet --workspace --doc
# Both runners have built them.
for example in embed own_kernel dry_blocks own_broadphase own_bodies own_water; do
    "${CARGO_TARGET_DIR:-target}/debug/examples/$example"
done
if [ $# -eq 0 ] && [ "$(uname -s)" = Linux ]; then harness/test_adapters.sh; fi
